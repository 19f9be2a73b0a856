//! Positions that stand at an end: an end stop holds the mechanism, or the sensor measures no farther.

use super::findings::{about, place};
use super::held::{is_coarse, piles_up, spans_at};
use super::profile::{Profile, extremes};
use haptics::recording::{Channel, Recording, Span, Warning};

/// Least number of stays at an end. Choice: one or two are places at which a hand paused.
const STOPS: usize = 3;
/// Part of the range before an end over which the motion is compared with that over the part before it.
/// Choice: of 0.03, 0.05 and 0.1, this finds the most stops and the fewest pauses of simulated hands.
const APPROACH: f64 = 0.1;
/// Least ratio of the times in both parts that shows a motion which slows down by itself.
/// Derived: at constant speed it is 1, before the turning point of a sine 2.4, before a pause of least jerk 3.8.
const SLOWS_DOWN: f64 = 1.7;

/// Stays of the mechanism's position at exactly its extreme value that it reaches without slowing down, if most of them are such.
pub fn stops(recording: &Recording, channel: &Channel) -> Option<Warning> {
    let values = &channel.values;
    if !matches!(channel.name.as_str(), "q_m" | "q_rad") {
        return None;
    }
    let (low, high, _) = extremes(values);
    let sides = [(1.0, high), (-1.0, low)].into_iter().filter(|(side, _)| low < high && piles_up(&[(values, *side)]));
    let mut stays: Vec<Span> = sides.flat_map(|(_, end)| spans_at(values, end)).collect();
    stays.sort_by_key(|stay| stay.first);
    let stopped = stays.iter().filter(|stay| is_stopped(&values[..=stay.first], APPROACH * (high - low))).count();
    if stopped < STOPS || 2 * stopped < stays.len() || is_coarse(&Profile::of(values)) {
        return None;
    }
    let rows: usize = stays.iter().map(|stay| stay.end - stay.first).sum();
    let text = format!(
        "{} stands at exactly its extreme value {} time(s), from {} on, and does not slow down before it: an end stop holds the mechanism, or \
         the sensor measures no farther; these {rows} rows are left out",
        channel.name,
        stays.len(),
        place(recording, stays[0].first)
    );
    Some(about("stuck-channel", channel, stays, text))
}

/// True if the way before the last value takes no longer than an equal way before that.
fn is_stopped(values: &[f64], way: f64) -> bool {
    let Some((end, before)) = values.split_last() else { return false };
    let last_beyond = |way: f64| before.iter().rposition(|value| (value - end).abs() >= way);
    let (Some(near), Some(far)) = (last_beyond(way), last_beyond(2.0 * way)) else { return false };
    ((before.len() - near) as f64) < SLOWS_DOWN * (near - far) as f64
}
