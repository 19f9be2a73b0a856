//! Sub-sample offset between force and motion, which is no delay.

use crate::diagnose::data::direction::CLOCKS_S;
use crate::diagnose::data::regression_data::Track;
use crate::diagnose::hypotheses::time_delay;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::estimates::parameters;

/// Delay of a command that is held until the next sample, in samples: half a sample with some margin.
/// Derived: a command that is held acts half a sample late on average; 0.2 samples are margin.
const HELD_COMMAND: f64 = 0.7;
/// Difference of the clocks and filters of two instruments, s: a smaller delay of the force is none.
pub(crate) const CLOCKS_DIFFER_S: f64 = 3e-4;

/// Offset between force and motion if sampling alone can explain it, s. A commanded force is recorded when it is given
/// and acts in the sample after. For a late force, only the difference of the clocks is allowed.
pub fn skew(study: &ChannelFit, k: usize, track: &Track) -> Option<f64> {
    if study.candidates[study.chosen[k].candidate].id != time_delay::ID {
        return None;
    }
    let delay = parameters(study, k);
    let found = delay.first()?;
    // A hand's force is measured; a motor's is usually the command.
    let held_s = if track.planar { 0.0 } else { HELD_COMMAND * track.raw_period_s };
    let ahead_s = track.raw_period_s.min(CLOCKS_S).max(held_s);
    let most_s = if found.value < 0.0 { ahead_s } else { CLOCKS_DIFFER_S };
    (found.value.abs() - 2.0 * found.std_error <= most_s).then_some(found.value)
}

/// The same for any chosen causes.
pub fn skewed_s(study: &ChannelFit, track: &Track) -> Option<f64> {
    (0..study.chosen.len()).find_map(|k| skew(study, k, track))
}

/// Beginning of the sentence.
pub const APART: &str = "force and motion are ";

/// The offset in words.
pub fn apart(skew_s: f64) -> String {
    let ms = 1e3 * skew_s;
    format!(
        "{APART}{ms:.2} ms apart, no more than sampling and clocks make of it: it is taken out and not called a delay"
    )
}

/// Delay estimated beside the causes found, and its standard error, s.
pub fn rest_s(study: &ChannelFit, picks: &[usize]) -> Option<[f64; 2]> {
    let is_delay = |c: &usize| study.candidates[*c].id == time_delay::ID;
    let delay = (0..study.candidates.len()).find(is_delay)?;
    let others: Vec<usize> = picks.iter().copied().filter(|c| !is_delay(c)).collect();
    let solved = study.system.solve(&[others.as_slice(), &[delay]].concat())?;
    let last = solved.values.len() - 1;
    let variance = solved.variance(study.system.rows);
    Some([solved.values[last], (variance * solved.inverse[(last, last)]).sqrt()])
}
