//! Rows that belong to several signals in turn, as those of two sensors in one table.

use super::findings::{about, is_position};
use crate::units::{self, Dimension};
use haptics::recording::{Channel, Recording, Span, Warning};

/// Kind of the doubt.
pub const ALTERNATION: &str = "alternation";
/// Ratio of the mean step to the next row over that to the next row of the same signal.
/// Choice: 2 is that of a motion near half the sampling rate; readings of two sensors in turn have 10 and more.
const ZIGZAG: f64 = 5.0;
/// Most signals in turn. More would be taken for a vibration of a few rows.
const MOST: usize = 4;
/// Rows that are looked at, in the middle of the recording.
const ROWS: usize = 10_000;

/// Doubts about positions and forces that go on smoothly in every n-th row only.
pub fn warnings(recording: &Recording) -> Vec<Warning> {
    let sensed =
        |channel: &&Channel| units::is_program_name(&channel.name) && (is_position(channel) || is_force(channel));
    let doubt = |channel: &Channel| {
        let count = signals_in_turn(&channel.values)?;
        let text = format!(
            "{} alternates between {count} signals from row to row, as with several sensors in one table; read one of them, with \
             \"select\" in the sidecar",
            channel.name
        );
        let all = Span { first: 0, end: channel.values.len() };
        Some(about(ALTERNATION, channel, vec![all], text))
    };
    recording.channels.iter().filter(sensed).filter_map(doubt).collect()
}

fn is_force(channel: &Channel) -> bool {
    units::find(&channel.unit).is_some_and(|unit| matches!(unit.dimension, Dimension::Force | Dimension::Torque))
}

/// Number of signals whose values stand in turn; none where one goes on.
fn signals_in_turn(values: &[f64]) -> Option<usize> {
    let first = values.len().saturating_sub(ROWS) / 2;
    let rows = &values[first..values.len().min(first + ROWS)];
    let mean = |lag: usize| {
        let steps = rows.len().checked_sub(lag).filter(|steps| *steps > 0)?;
        Some(rows.iter().zip(&rows[lag..]).map(|(a, b)| (b - a).abs()).sum::<f64>() / steps as f64)
    };
    let step = mean(1).filter(|_| rows.len() > 10 * MOST)?;
    (2..=MOST).find(|lag| mean(*lag).is_some_and(|same| step > ZIGZAG * same))
}

#[cfg(test)]
mod tests {
    use super::signals_in_turn;

    #[test]
    fn two_sensors_in_turn_are_told_from_one_that_vibrates() {
        let wave = |k: usize| (0.02 * k as f64).sin();
        let noise = |k: usize| 0.05 * ((k as f64 * 12.9898).sin() * 43_758.545).fract();
        let in_turn =
            |count: usize| -> Vec<f64> { (0..900).map(|k| wave(k / count) + (k % count) as f64 + noise(k)).collect() };
        assert_eq!([2, 3, 4].map(|count| signals_in_turn(&in_turn(count))), [Some(2), Some(3), Some(4)]);
        let vibration: Vec<f64> = (0..900).map(|k| wave(k) + (2.5 * k as f64).sin()).collect();
        let coarse: Vec<f64> = (0..900).map(|k| (20.0 * (wave(k) + noise(k))).round()).collect();
        assert!([in_turn(1), vibration, coarse].iter().all(|values| signals_in_turn(values).is_none()));
    }
}
