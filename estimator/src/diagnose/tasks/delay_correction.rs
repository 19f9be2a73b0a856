//! Correction of a time delay: the forces are shifted back and the diagnosis is repeated.

use crate::diagnose::answer::put_back::PutBack;
use crate::diagnose::data::interpolation::mean_step_s;
use crate::diagnose::data::limits::{CERTAIN, MOST_ROUNDS};
use crate::diagnose::findings::Findings;
use crate::diagnose::hypotheses::time_delay::ID;
use crate::diagnose::recording::time_delay::put_back;
use crate::diagnose::selection::rules::AS_GOOD;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;

/// Delay up to which a linear regressor is accurate, s.
/// Choice: halved, 0 of 4 answers change; doubled, 1 of 4 answers change.
const LINEAR_S: f64 = 3e-3;
/// The same ratio if the delay was not named.
/// Choice: no case of the ablation reads it.
const BETTER: f64 = 0.95;

/// The diagnosis `ask`, repeated with the force shifted back while a large delay is found.
pub fn corrected(
    recordings: &[Recording],
    ask: impl Fn(&[Recording], Option<&PutBack<'_>>) -> Result<Findings, EstimateError>,
) -> Result<Findings, EstimateError> {
    let first = ask(recordings, None)?;
    let named_s = delay_s(&first);
    let guess_s = first.delay.guess_s.filter(|tau| tau.abs() > LINEAR_S);
    let Some(mut late_s) = guess_s.or(named_s.filter(|tau| tau.abs() > LINEAR_S)) else { return Ok(first) };
    let period_s = recordings.iter().filter_map(period_s).fold(0.0, f64::max);
    let mut found = None;
    for _ in 0..MOST_ROUNDS {
        let back_s = PutBack::whole(late_s, period_s);
        if back_s == 0.0 {
            return Ok(first);
        }
        let back: Vec<Recording> = recordings.iter().map(|r| put_back(r, back_s)).collect();
        let shift = PutBack { first: &first, back_s, period_s };
        // If the repetition fails, the first answer remains.
        let Ok(now) = ask(&back, Some(&shift)) else { return Ok(first) };
        late_s = shift.late_s(&now.delay);
        found = Some(now);
        if PutBack::whole(late_s, period_s) == back_s {
            break;
        }
    }
    // A delay that was not named must improve the residual clearly.
    let most = first.figures_of_delay().end.heldout_rms_n * if named_s.is_some() { AS_GOOD } else { BETTER };
    let sure = |found: &Findings| found.delay.rest_s.is_none_or(|[_, error]| late_s.abs() > CERTAIN * error);
    let is_better = |found: &Findings| found.figures_of_delay().end.heldout_rms_n < most;
    Ok(found.filter(|found| is_better(found) && (named_s.is_some() || sure(found))).unwrap_or(first))
}

/// Usual time between two samples, s.
fn period_s(recording: &Recording) -> Option<f64> {
    recording.time_s.as_ref().filter(|t| t.len() > 2).map(|time_s| mean_step_s(time_s))
}

/// The delay that an answer names, s.
fn delay_s(found: &Findings) -> Option<f64> {
    found.causes.iter().find(|c| c.id == ID)?.parameters.first().map(|p| p.value)
}
