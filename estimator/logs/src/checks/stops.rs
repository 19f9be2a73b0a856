//! Positions that stand at an end: an end stop holds the mechanism, or the sensor measures no farther.

use super::findings::{about, place};
use super::profile::{Profile, holds};
use haptics::recording::{Channel, Recording, Span, Warning};

/// Least number of rows at the extreme value. Choice: two equal rows are a turning point by chance.
const STOP_ROWS: usize = 3;
/// Least number of such stops. Choice: one or two are places at which a hand paused.
const STOPS: usize = 3;
/// Rows before a stop from which its speed is taken, at most.
const APPROACH_ROWS: usize = 8;
/// Least speed before a stop, as a share of the mean speed of the moving rows. Derived: before a turning point of a sine at which a
/// quantum holds as many rows, it is below a half.
const APPROACH_SPEED: f64 = 0.8;

/// Stays of the mechanism's position at exactly its extreme value that it reaches at speed, if most of them are such.
pub fn stops(recording: &Recording, channel: &Channel, profile: &Profile) -> Option<Warning> {
    let values = &channel.values;
    if !matches!(channel.name.as_str(), "q_m" | "q_rad") || profile.is_constant() {
        return None;
    }
    let stays: Vec<Span> = holds(values, STOP_ROWS)
        .into_iter()
        .filter(|stay| [profile.low, profile.high].contains(&values[stay.first]))
        .collect();
    let way: f64 = values.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    let step = way / (values.len() - 1 - profile.unchanged).max(1) as f64;
    let is_fast = |stay: &&Span| {
        let rows = (stay.end - stay.first).min(APPROACH_ROWS).min(stay.first);
        (values[stay.first] - values[stay.first - rows]).abs() > APPROACH_SPEED * step * rows as f64
    };
    let fast = stays.iter().filter(is_fast).count();
    if fast < STOPS || 2 * fast < stays.len() || super::held::is_coarse(profile) {
        return None;
    }
    let rows: usize = stays.iter().map(|stay| stay.end - stay.first).sum();
    let text = format!(
        "{} stands at exactly its extreme value {} time(s), from {} on, and mostly reaches it at speed: an end stop holds the mechanism, or the sensor \
         measures no farther; these {rows} rows are left out",
        channel.name,
        stays.len(),
        place(recording, stays[0].first)
    );
    Some(about("stuck-channel", channel, stays, text))
}
