//! Correction of a time delay: the forces are shifted back and the diagnosis is repeated.

use crate::diagnose::contract::{Baseline, Cause, Gain, Verdict, parameter};
use crate::diagnose::data::interpolation::mean_step_s;
use crate::diagnose::data::limits::{CERTAIN, MOST_ROUNDS};
use crate::diagnose::findings::{Figures, Findings};
use crate::diagnose::free_run::windows::PUT_BACK;
use crate::diagnose::hypotheses::time_delay::ID;
use crate::diagnose::recording::time_delay::put_back;
use crate::diagnose::selection::rules::AS_GOOD;
use foundation::estimate::EstimateError;
use haptics::law::Kind;
use haptics::recording::Recording;

/// Delay up to which a linear regressor is accurate, s.
pub(crate) const LINEAR_S: f64 = 3e-3;

/// The diagnosis `ask`, repeated with the force shifted back while a large delay is found, and then completed.
pub fn corrected(
    recordings: &[Recording],
    ask: &dyn Fn(&[Recording]) -> Result<Findings, EstimateError>,
) -> Result<Findings, EstimateError> {
    let first = ask(recordings)?;
    let named_s = delay_s(&first);
    let guess_s = first.delay.guess_s.filter(|tau| tau.abs() > LINEAR_S);
    let Some(mut late_s) = guess_s.or(named_s.filter(|tau| tau.abs() > LINEAR_S)) else { return Ok(first) };
    // Whole samples only: an interpolated force is a mean, with less noise than the others.
    let period_s = recordings.iter().filter_map(period_s).fold(0.0, f64::max);
    let whole = |late_s: f64| if period_s > 0.0 { (late_s / period_s).round() * period_s } else { late_s };
    let mut found = None;
    for _ in 0..MOST_ROUNDS {
        let back_s = whole(late_s);
        if back_s == 0.0 {
            return Ok(first);
        }
        let back: Vec<Recording> = recordings.iter().map(|r| put_back(r, back_s)).collect();
        // If the repetition fails, the first answer remains.
        let Ok(now) = ask(&back) else { return Ok(first) };
        late_s = back_s + now.delay.rest_s.map_or(0.0, |[more, _]| more);
        found = Some(now);
        if whole(late_s) == back_s {
            break;
        }
    }
    // A delay that was not named must improve the residual clearly.
    let most = told(&first).end.heldout_rms_n * if named_s.is_some() { AS_GOOD } else { BETTER };
    let sure = |found: &Findings| found.delay.rest_s.is_none_or(|[_, error]| late_s.abs() > CERTAIN * error);
    let found = found.filter(|found| told(found).end.heldout_rms_n < most && (named_s.is_some() || sure(found)));
    Ok(match found {
        Some(found) => with_delay(found, &first, late_s, whole(late_s)),
        None => first,
    })
}

/// The figures by which a delay is judged.
pub(crate) fn told(found: &Findings) -> Figures {
    found.delay.figures.clone().unwrap_or_else(|| Figures {
        baseline: found.baseline.clone(),
        end: found.end.clone(),
        noise_floor: found.noise_floor_n,
    })
}

/// Usual time between two samples, s.
pub(crate) fn period_s(recording: &Recording) -> Option<f64> {
    recording.time_s.as_ref().filter(|t| t.len() > 2).map(|time_s| mean_step_s(time_s))
}

/// The same ratio if the delay was not named.
pub(crate) const BETTER: f64 = 0.95;

/// The answer for the recording with its forces shifted back by `back_s`, with its delay.
pub(crate) fn with_delay(mut found: Findings, first: &Findings, late_s: f64, back_s: f64) -> Findings {
    let place = first.causes.iter().position(|c| c.id == ID);
    let mut cause = place.map_or_else(|| unnamed_before(first, late_s), |place| first.causes[place].clone());
    let place = place.unwrap_or(0);
    let error = found.delay.rest_s.map(|[_, error]| error);
    if let Some(tau) = cause.parameters.first_mut() {
        tau.value = late_s;
        tau.std_error = error.unwrap_or(tau.std_error);
    }
    let Figures { end, noise_floor, .. } = told(&found);
    let (before, after, floor) = (cause.gain.heldout_rms_before, end.heldout_rms_n, noise_floor);
    let power = (before * before - floor * floor).max(1e-3 * before * before);
    let share = ((before * before - after * after) / power).clamp(-1.0, 1.0);
    cause.gain.heldout_rms_after = after;
    cause.gain.share_of_explainable = share;
    cause.gain.interval = [cause.gain.interval[0].min(share), cause.gain.interval[1].max(share)];
    if cause.gain.rollout.is_none() {
        cause.gain.no_rollout = Some(PUT_BACK.to_owned());
    }
    cause.posterior = 1.0;
    found.causes.retain(|c| c.id != ID);
    found.alternatives.retain(|a| a.instead_of != ID && a.id != ID);
    found.not_excited.retain(|n| n.id != ID);
    found.passed_over.retain(|p| p.id != ID);
    let place = place.min(found.causes.len());
    found.causes.insert(place, cause);
    if matches!(found.verdict, Verdict::None | Verdict::Unexplained) {
        found.verdict = Verdict::Causes;
    }
    let model = first.baseline.model.clone();
    found.baseline = Baseline { model, ..told(first).baseline };
    (found.end, found.noise_floor_n) = (end, noise_floor);
    found.delay.corrected_s = back_s;
    found
}

/// A delay that the first answer did not name, as a cause.
pub(crate) fn unnamed_before(first: &Findings, late_s: f64) -> Cause {
    let before = told(first);
    Cause {
        id: ID.to_owned(),
        kind: Kind::Instrument,
        parameters: vec![parameter("tau", late_s, 0.0, "s")],
        p_value: 0.0,
        posterior: 1.0,
        gain: Gain { heldout_rms_before: before.end.heldout_rms_n, unit: before.baseline.unit, ..Gain::default() },
        evidence: format!(
            "the force fits the motion of {:.0} ms before: everything was asked again with the force put back to then",
            1e3 * late_s
        ),
    }
}

/// The delay that an answer names, s.
fn delay_s(found: &Findings) -> Option<f64> {
    found.causes.iter().find(|c| c.id == ID)?.parameters.first().map(|p| p.value)
}
