//! Width of held blocks: the distance of the tips, and the compression of the pads under the grip.

use super::signals::{Blocks, MAIN, mean_and_spread, object};
use crate::identify::pads::{CLOSED_GRIP_SHARE, LEAST_GRIP_VARIATION, UNKNOWN_COMPRESSION};
use crate::identify::pads::{Grip, PadFit, width_over_force};
use crate::regression::linear::{LinearFit, least_squares};
use crate::segment::Segmentation;
use crate::segment::threshold::{Levels, percentile};
use foundation::estimate::{EstimateError, Parameter};
use foundation::signal::task::{half_width, task_signals};
use haptics::law::contact::Cushion;
use haptics::recording::Recording;

/// Share of force noise in the variation of the grip above which that variation tells nothing of the pads.
/// Choice: no case of the ablation reads it.
const MOSTLY_NOISE: f64 = 0.5;
/// Variance of white noise after a parabolic window of `2 h + 1` samples, times their number.
/// Derived: 6/5, the mean square of the window's weights.
const WINDOW_NOISE: f64 = 1.2;

impl Blocks<'_> {
    /// Width: distance of the tips while held, extrapolated to no grip force. `pad`: stiffness of a pad out of all
    /// holds, for a grip that is too even to show the give of the pads by itself.
    pub(super) fn width(&self, number: usize, pad: &Parameter) -> Result<Parameter, EstimateError> {
        let samples = self.gripped(number);
        if let Some(why) = self.unshown("width_m").or_else(|| unseen(&samples)) {
            return Ok(Parameter::unidentified(&object(number), "width_m", 0, &why));
        }
        let rows = self.rows(&samples);
        let width: Vec<f64> = rows.iter().map(|i| self.width[*i]).collect();
        let grip: Vec<f64> = rows.iter().map(|i| self.grip[*i]).collect();
        let (mean_grip, spread_grip) = mean_and_spread(&grip);
        let name = object(number);
        let resolution = std::f64::consts::SQRT_2 * self.resolution_m;
        if spread_grip > LEAST_GRIP_VARIATION * mean_grip
            && let Some(pads) = self.pads(number)?
        {
            let stiffness = 1.0 / pads.give_m_per_n;
            let harder = if pads.bent > 0.5 { " when hardly pressed, and harden" } else { "" };
            let how = format!(
                "distance of the tips while held, extrapolated to zero grip force (pads give {stiffness:.0} N/m each{harder})"
            );
            let error = pads.width_error_m.hypot(resolution);
            let resampled = pads.resampled.map(|(width, _)| width.hypot(resolution));
            let found = Parameter::identified(&name, "width_m", pads.width_m, error, samples.len(), &how);
            return Ok(found.with_bootstrap(resampled));
        }
        if let Some((stiffness, error)) = pad.value.zip(pad.std_error) {
            let freed: Vec<f64> = width.iter().zip(&grip).map(|(w, f)| w + 2.0 * f / stiffness).collect();
            let fit = intercept(&freed, &[])?;
            let by_pad = 2.0 * mean_grip * error / stiffness.powi(2);
            let error = fit.std_errors[0].hypot(by_pad).hypot(resolution);
            let how = format!(
                "mean distance of the tips while held, and what the pads give under that even grip by their stiffness out of all \
                 holds ({stiffness:.0} N/m each)"
            );
            return Ok(Parameter::identified(&name, "width_m", fit.values[0], error, samples.len(), &how));
        }
        let fit = intercept(&width, &[])?;
        let error = fit.std_errors[0].hypot(UNKNOWN_COMPRESSION * fit.values[0]);
        let how = "mean distance of the tips while held; the grip was too even to tell the pads' give, so 7 % is added \
                   to the error";
        Ok(Parameter::identified(&name, "width_m", fit.values[0], error, samples.len(), how))
    }

    /// The grip on one block from picking it up to letting it go.
    ///
    /// Noise of the forces makes a slope against them look flatter, and the pads harder, by its share of the variance
    /// of the grip. The share is taken out, and half of it joins the error, because noise that is not white is not
    /// known that well.
    pub(super) fn pads(&self, number: usize) -> Result<Option<PadFit>, EstimateError> {
        let rows = self.rows(&self.gripped(number));
        if rows.is_empty() {
            return Ok(None);
        }
        let column = |series: &[f64]| rows.iter().map(|i| series[*i]).collect::<Vec<f64>>();
        let (width, force, rate) = (column(&self.width), column(&self.grip), column(&self.width_rate));
        let (mean_n, spread_n) = mean_and_spread(&force);
        let window = (2 * half_width(&self.signals.time_s) + 1) as f64;
        let noise_n = self.levels.force_noise_n * (0.5 * WINDOW_NOISE / window).sqrt();
        let share = (noise_n / spread_n.max(f64::MIN_POSITIVE)).powi(2);
        if share > MOSTLY_NOISE {
            return Ok(None);
        }
        let found = width_over_force(&Grip { width: &width, force: &force, rate: &rate })?;
        let even = spread_n <= LEAST_GRIP_VARIATION * mean_n;
        Ok(found.map(|pads| rid_of_noise(if even { unbent(pads) } else { pads }, share, mean_n)))
    }
}

/// Estimate of linear pads from an even grip. It cannot tell that they bend: noise of the forces, which flattens the
/// middle of its narrow range and not the ends, looks like foam that hardens. The deviations of bent pads join the
/// errors.
fn unbent(pads: PadFit) -> PadFit {
    let (width_m, give_m_per_n) = pads.line;
    let (by_width, by_give) = (pads.width_m - width_m, pads.give_m_per_n - give_m_per_n);
    PadFit {
        width_m,
        width_error_m: pads.width_error_m.hypot(by_width),
        give_m_per_n,
        give_error: pads.give_error.hypot(by_give),
        resampled: pads.resampled.map(|(width, give)| (width.hypot(by_width), give.hypot(by_give))),
        bent: 0.0,
        ..pads
    }
}

/// A fit whose give came out too small by `share`, under a mean grip.
fn rid_of_noise(pads: PadFit, share: f64, mean_n: f64) -> PadFit {
    let give = pads.give_m_per_n / (1.0 - share);
    let (more, doubt) = (give - pads.give_m_per_n, 0.5 * share * give);
    let widened = |(width, give): (f64, f64)| (width.hypot(2.0 * mean_n * doubt), give.hypot(doubt));
    let (width_error_m, give_error) = widened((pads.width_error_m, pads.give_error));
    PadFit {
        width_m: pads.width_m + 2.0 * mean_n * more,
        width_error_m,
        give_m_per_n: give,
        give_error,
        resampled: pads.resampled.map(widened),
        ..pads
    }
}

/// Distance of the tips, m, and mean normal force of both fingers, N, at the samples of a hold.
pub(crate) type Hold = Vec<(f64, f64)>;

/// Grip on each of the first `count` blocks, as measured, in the states that show its width.
pub(crate) fn holds(recording: &Recording, segmentation: &Segmentation, count: usize) -> Option<Vec<Hold>> {
    let signals = task_signals(recording).ok()?;
    let levels = Levels::of(&signals);
    let task = segmentation.definition.as_ref()?;
    let normal =
        |finger: usize, i: usize| signals.tips[finger].force.as_ref().map_or(0.0, |f| f[i].x) - levels.bias_n[finger].x;
    let hold = |number: usize| {
        let samples = task.showing("width_m", MAIN, number).into_iter().flat_map(|s| segmentation.samples_of(&s));
        let all: Hold = samples.map(|i| (signals.grip_width_m[i], 0.5 * (normal(0, i) - normal(1, i)))).collect();
        let usual_n = percentile(&mut all.iter().map(|(_, f)| *f).collect::<Vec<f64>>(), 0.5);
        all.into_iter().filter(|(_, f)| *f > CLOSED_GRIP_SHARE * usual_n).collect()
    };
    Some((1..=count).map(hold).collect())
}

/// Width at which pads with the give of `pad` press on average as hard as measured: a world with any other one would
/// predict another grip, or none at all. `None` for a hold without a measured grip.
pub(crate) fn width_under(pad: &Cushion, hold: &[(f64, f64)]) -> Option<f64> {
    /// Number of halvings of the bracket.
    /// Derived: more than the 53 binary digits of a double.
    const HALVINGS: usize = 60;
    let measured_n: f64 = hold.iter().map(|(_, f)| f).sum();
    let pressed_n =
        |width_m: f64| -> f64 { hold.iter().map(|(d, _)| pad.force_n((0.5 * (width_m - d)).max(0.0))).sum() };
    let (least, most, hardest_n) = hold
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY, 0.0_f64), |(a, b, n), (d, f)| (a.min(*d), b.max(*d), n.max(*f)));
    if hold.is_empty() || measured_n <= 0.0 {
        return None;
    }
    let (mut low, mut high) = (least, most + 2.0 * pad.depth_m(hardest_n));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if pressed_n(middle) < measured_n { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

fn unseen(samples: &[usize]) -> Option<String> {
    samples.is_empty().then(|| "no sample of a state that shows it belongs to this block".to_owned())
}

/// Least squares of `rhs` on a constant and `columns` (each centred on nothing: the constant is the value where all are zero).
fn intercept(rhs: &[f64], columns: &[Vec<f64>]) -> Result<LinearFit, EstimateError> {
    let mut all = vec![vec![1.0; rhs.len()]];
    all.extend_from_slice(columns);
    least_squares(&all, rhs, None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::world::Pad;

    #[test]
    fn a_world_s_width_makes_its_pads_press_as_hard_as_measured() {
        // Block of 16 mm between soft pads, one of them measured as it is and one near its end.
        let pad = Pad { stiffness_n_m: 2500.0, ..Pad::default() }.elastic();
        let hold: Hold = (0..200)
            .map(|i| 2.4 + 0.3 * (0.2 * f64::from(i)).sin())
            .map(|force: f64| (0.016 - 2.0 * pad.depth_m(force), force))
            .collect();
        let width = width_under(&pad, &hold).expect("held");
        assert!((width - 0.016).abs() < 1e-9, "{width}");
        // Harder pads need a narrower block for the same grip, and press as hard on average.
        let harder = Cushion::linear(9000.0);
        let width = width_under(&harder, &hold).expect("held");
        let mean = |f: &dyn Fn(&(f64, f64)) -> f64| hold.iter().map(f).sum::<f64>() / 200.0;
        let predicted = mean(&|(d, _)| harder.force_n((0.5 * (width - d)).max(0.0)));
        assert!(width < 0.0155 && (predicted - mean(&|(_, f)| *f)).abs() < 1e-9, "{width} {predicted}");
        assert!(width_under(&harder, &[]).is_none());
    }

    #[test]
    fn what_noise_flattens_is_put_back_with_its_doubt() {
        let pads = PadFit {
            width_m: 0.016,
            width_error_m: 1e-6,
            give_m_per_n: 0.8e-4,
            give_error: 1e-6,
            resampled: None,
            bent: 0.9,
            rows: 100,
            line: (0.0159, 0.7e-4),
        };
        let found = rid_of_noise(pads, 0.2, 2.0);
        assert!((found.give_m_per_n - 1e-4).abs() < 1e-12 && (found.width_m - 0.01608).abs() < 1e-9, "{found:?}");
        assert!(found.give_error > 0.9e-5 && found.width_error_m > 3.9e-5, "{found:?}");
        // The bends that an even grip shows are an error.
        let even = unbent(pads);
        assert!((even.width_m, even.give_m_per_n, even.bent) == (0.0159, 0.7e-4, 0.0), "{even:?}");
        assert!(even.width_error_m > 1e-4 && even.give_error > 1e-5, "{even:?}");
    }
}
