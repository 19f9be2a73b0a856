//! Sensitivity of the simulated force to every parameter, and the parameters that are correlated.

use crate::ui::background::jobs::JobKind;
use crate::ui::calibrate::what_if;
use crate::ui::document::prepared::Prepared;
use estimator::pipeline::Analysis;
use haptics::recording::Recording;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Computing how the force depends on the parameters.
pub const SENSITIVITY: JobKind = JobKind::new("sensitivity");

/// Parameters are changed by this share of their value …
pub const CHANGE: f64 = 0.1;

/// Effect of a change of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect {
    /// `object.name`.
    pub name: String,
    /// Change of the simulated force when the parameter grows by [`CHANGE`], N or Nm RMS.
    pub force_rms: f64,
    /// The same when it grows by one standard error.
    pub by_its_error: Option<f64>,
}

/// The answer for one fit.
#[derive(Clone, Debug)]
pub struct Sensitivity {
    /// The fit it belongs to.
    of: Arc<Analysis>,
    /// The largest effect first.
    pub effects: Vec<Effect>,
    /// Names and correlations of all parameters that were estimated together, group by group.
    pub groups: Vec<Correlations>,
}

/// Correlations of parameters that were estimated together.
#[derive(Clone, Debug, PartialEq)]
pub struct Correlations {
    /// `object.name` of each.
    pub names: Vec<String>,
    /// −1 … 1, one row a parameter.
    pub values: Vec<Vec<f64>>,
}

impl Sensitivity {
    /// True when it belongs to this fit.
    pub fn is_of(&self, analysis: &Arc<Analysis>) -> bool {
        Arc::ptr_eq(&self.of, analysis)
    }
}

/// Effects of all identified parameters, and the correlations of the fit; `None` when cancelled.
pub fn sensitivity(
    analysis: &Arc<Analysis>,
    recordings: &[Arc<Prepared>],
    given: &[Recording],
    tell: impl Fn(f64),
    cancelled: &AtomicBool,
) -> Option<Sensitivity> {
    let fitted = predicted(analysis, recordings, given, None);
    let all: Vec<_> = analysis.fit.parameters.iter().filter(|p| p.identified && p.name != "mass_kg").collect();
    let mut effects = Vec::new();
    for (done, parameter) in all.iter().enumerate() {
        if cancelled.load(Ordering::Relaxed) {
            return None;
        }
        tell(done as f64 / all.len() as f64);
        let Some(value) = parameter.value.filter(|v| *v != 0.0) else { continue };
        let name = parameter.full_name();
        let moved = predicted(analysis, recordings, given, Some((&name, value * (1.0 + CHANGE))));
        let force_rms = apart(&fitted, &moved);
        // Small changes act in proportion.
        let by_its_error = parameter.std_error.map(|e| force_rms * e / (CHANGE * value.abs()));
        effects.push(Effect { name, force_rms, by_its_error });
    }
    effects.sort_by(|a, b| b.force_rms.total_cmp(&a.force_rms));
    Some(Sensitivity { of: Arc::clone(analysis), effects, groups: correlations(analysis) })
}

/// Predicted force of every channel and recording with one value changed.
pub(crate) fn predicted(
    analysis: &Analysis,
    recordings: &[Arc<Prepared>],
    given: &[Recording],
    change: Option<(&str, f64)>,
) -> Vec<Vec<f64>> {
    let values = change.map(|(name, value)| (name.to_owned(), value)).into_iter().collect();
    let world = what_if::world(analysis, given, &values);
    let of = |p: &Arc<Prepared>| estimator::simulate::simulate(&world, &p.recording).ok();
    recordings.iter().filter_map(of).flat_map(|s| s.predicted).map(|channel| channel.values).collect()
}

/// RMS of the difference, samples that are not finite left out.
pub(crate) fn apart(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let pairs = a.iter().zip(b).flat_map(|(a, b)| a.iter().zip(b));
    let (sum, count) = pairs
        .map(|(a, b)| (a - b).powi(2))
        .filter(|square| square.is_finite())
        .fold((0.0, 0_usize), |(sum, count), square| (sum + square, count + 1));
    (sum / count.max(1) as f64).sqrt()
}

pub(crate) fn correlations(analysis: &Analysis) -> Vec<Correlations> {
    let several = analysis.fit.correlated.iter().filter(|g| g.parameters.len() > 1);
    several
        .filter_map(|group| {
            let error = |i: usize| group.covariance[i][i].sqrt();
            // Parameters that are known exactly, or not at all, correlate with nothing.
            let kept: Vec<usize> =
                (0..group.parameters.len()).filter(|i| error(*i) > 0.0 && error(*i).is_finite()).collect();
            let row = |i: usize| kept.iter().map(|j| group.covariance[i][*j] / (error(i) * error(*j))).collect();
            let names = kept.iter().map(|i| group.parameters[*i].clone()).collect();
            (kept.len() > 1).then(|| Correlations { names, values: kept.iter().map(|i| row(*i)).collect() })
        })
        .collect()
}
