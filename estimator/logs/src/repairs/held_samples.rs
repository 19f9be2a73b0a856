//! Channels that repeat their last value until the next one comes: a logger that is faster than its source.

use crate::checks::{alternating, extremes};
use crate::units;
use haptics::recording::{Channel, Recording, Span, Warning};

/// Fewer changes show no rhythm.
const LEAST_CHANGES: usize = 50;
/// Share of the changes that follow the one before at the usual distance.
const REGULAR: f64 = 0.8;
/// Usual change in quanta from which it is no counting of an encoder.
const QUANTA: f64 = 3.0;
/// Distance between changes, rows, from which one row more or less is as regular.
const LOOSE_FROM: usize = 4;

/// Leaves the rows out in which the slowest channel of the program repeats its value.
pub fn take_out(recording: &mut Recording) -> Option<Warning> {
    let known = recording.channels.iter().filter(|c| units::is_program_name(&c.name));
    let (name, every, kept) = known.filter_map(held).max_by_key(|(_, every, _)| *every)?;
    // Sensors in turn may share a channel, which has a new value once for all of them.
    if !alternating(recording).is_empty() {
        return None;
    }
    let count = recording.len();
    let rate_hz = recording.time_s.as_ref().map(|time| (count - 1) as f64 / (time[count - 1] - time[0]));
    let rate = rate_hz.map_or(String::new(), |rate| format!(", at {:.4} Hz,", rate / every as f64));
    let text = format!(
        "{name} has a new value in every {every}th row only{rate} and repeats it in between: the {} rows of {count} without a new one are left out",
        count - kept.len()
    );
    recording.keep(&kept);
    let spans = vec![Span { first: 0, end: kept.len() }];
    Some(Warning { kind: "held-samples".to_owned(), column: Some(name), spans, text, ..Warning::default() })
}

/// Name of a channel that holds its values, the usual number of rows between new ones, and the rows of new ones.
fn held(channel: &Channel) -> Option<(String, usize, Vec<usize>)> {
    let values = &channel.values;
    // Most channels change with nearly every row.
    let count = values.len() - extremes(values).2;
    if count < LEAST_CHANGES + 1 || 2 * count > values.len() + 4 {
        return None;
    }
    let changes: Vec<usize> = (1..values.len()).filter(|&i| values[i] != values[i - 1]).collect();
    let mut gaps: Vec<usize> = changes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = gaps.len() / 2;
    let every = *gaps.select_nth_unstable(middle).1;
    let loose = usize::from(every >= LOOSE_FROM);
    let regular = gaps.iter().filter(|gap| gap.abs_diff(every) <= loose).count();
    let mut sizes: Vec<f64> = changes.iter().map(|&i| (values[i] - values[i - 1]).abs()).collect();
    let quantum = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let middle = sizes.len() / 2;
    let usual = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    if every < 2 || (regular as f64) < REGULAR * gaps.len() as f64 || usual < QUANTA * quantum {
        return None;
    }
    // A new value may be the old one by chance: its rows are counted on.
    let mut kept = Vec::new();
    for pair in changes.windows(2) {
        kept.extend((pair[0]..pair[1]).step_by(every).filter(|row| pair[1] - row > every / 2 || *row == pair[0]));
    }
    kept.extend(changes.last());
    Some((channel.name.clone(), every, kept))
}
