//! Channels that repeat their last value until the next one comes, or stand on the line to it: a logger that is faster than its source.

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
/// A bend of a line in bends of the quietest quarter of the rows. Derived: above it are 3 of 1000 rows of white noise.
const BENT: f64 = 10.0;
/// A bend in the least bend. Derived: the rounding of three values to a quantum makes bends of two quanta.
const ROUNDED: f64 = 2.02;

/// Ratio of neighbouring steps from which a row is missing. Derived: one row makes it two.
const MISSING: f64 = 1.5;

/// The rows in which a channel has a new value.
struct Rhythm {
    name: String,
    /// Usual number of rows between new values.
    every: usize,
    rows: Vec<usize>,
    interpolated: bool,
}

/// Leaves the rows out in which the slowest channel of the program repeats or interpolates its value.
pub fn take_out(recording: &mut Recording) -> Option<Warning> {
    let time = recording.time_s.as_deref();
    let known = recording.channels.iter().filter(|c| units::is_program_name(&c.name));
    let Rhythm { name, every, rows, interpolated } = known
        .filter_map(|channel| held(channel).or_else(|| interpolated(channel, time)))
        .max_by_key(|new| new.every)?;
    // Sensors in turn may share a channel, which has a new value once for all of them.
    if !alternating(recording).is_empty() {
        return None;
    }
    let count = recording.len();
    let rate_hz = recording.time_s.as_ref().map(|time| (count - 1) as f64 / (time[count - 1] - time[0]));
    let rate = rate_hz.map_or(String::new(), |rate| format!(", at {:.4} Hz,", rate / every as f64));
    let between = if interpolated { "is interpolated" } else { "repeats it" };
    let text = format!(
        "{name} has only one new value in {every} rows{rate} and {between} in between: the {} rows of {count} without a new one are left out",
        count - rows.len()
    );
    recording.keep(&rows);
    let spans = vec![Span { first: 0, end: rows.len() }];
    Some(Warning { kind: "held-samples".to_owned(), column: Some(name), spans, text, ..Warning::default() })
}

/// New values of a channel that holds them.
fn held(channel: &Channel) -> Option<Rhythm> {
    let values = &channel.values;
    // Most channels change with nearly every row.
    let count = values.len() - extremes(values).2;
    if count < LEAST_CHANGES + 1 || 2 * count > values.len() + 4 {
        return None;
    }
    let changes: Vec<usize> = (1..values.len()).filter(|&i| values[i] != values[i - 1]).collect();
    let mut sizes: Vec<f64> = changes.iter().map(|&i| (values[i] - values[i - 1]).abs()).collect();
    let quantum = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let middle = sizes.len() / 2;
    let usual = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
    if usual < QUANTA * quantum {
        return None;
    }
    let (every, rows) = rhythm(&changes)?;
    Some(Rhythm { name: channel.name.clone(), every, rows, interpolated: false })
}

/// New values of a channel whose rows between them stand on straight lines.
fn interpolated(channel: &Channel, time_s: Option<&[f64]>) -> Option<Rhythm> {
    let values = &channel.values;
    if values.len() < 2 * LEAST_CHANGES {
        return None;
    }
    let mut bends: Vec<f64> = values.windows(3).map(|v| v[0] - 2.0 * v[1] + v[2]).collect();
    let quarter = bends.len() / 4;
    // A line across a row that is missing has no bend.
    let mut missing = 0;
    for (bend, t) in bends.iter_mut().zip(time_s.unwrap_or_default().windows(3)) {
        let (before, after) = (t[1] - t[0], t[2] - t[1]);
        if before.max(after) > MISSING * before.min(after) {
            (*bend, missing) = (0.0, missing + 1);
        }
    }
    // Rounded times make the quietest quarter of the rows.
    if missing > quarter {
        return None;
    }
    let mut sizes: Vec<f64> = bends.iter().map(|bend| bend.abs()).collect();
    let quiet = *sizes.select_nth_unstable_by(quarter, f64::total_cmp).1;
    let (least, most, _) = extremes(values);
    let rounding = 8.0 * f64::EPSILON * least.abs().max(most.abs());
    let quantum = sizes.iter().copied().filter(|size| *size > rounding).fold(f64::INFINITY, f64::min);
    let limit = (BENT * quiet).max(ROUNDED * quantum);
    let bent: Vec<usize> = (0..bends.len()).filter(|&i| bends[i].abs() > limit).collect();
    if 2 * bent.len() > bends.len() {
        return None;
    }
    // A new value between two rows bends the line in both to the same side. A leap bends it there and back.
    let (mut knots, mut leaps): (Vec<usize>, usize) = (Vec::new(), 0);
    for row in bent {
        match knots.last_mut() {
            Some(last) if row == *last + 1 => {
                leaps += usize::from(bends[row] * bends[*last] < 0.0);
                if bends[row].abs() > bends[*last].abs() {
                    *last = row;
                }
            }
            _ => knots.push(row),
        }
    }
    // The drive itself may move at constant speed between its turns.
    let turns = knots.iter().filter(|&&i| (values[i + 1] - values[i]) * (values[i + 2] - values[i + 1]) < 0.0).count();
    if knots.len() < LEAST_CHANGES || 2 * turns.max(leaps) > knots.len() {
        return None;
    }
    let changes: Vec<usize> = knots.iter().map(|row| row + 1).collect();
    let (every, rows) = rhythm(&changes).filter(|(every, _)| *every > 2)?;
    Some(Rhythm { name: channel.name.clone(), every, rows, interpolated: true })
}

/// Usual distance of rows with new values, if they are regular, and these rows.
fn rhythm(changes: &[usize]) -> Option<(usize, Vec<usize>)> {
    let mut gaps: Vec<usize> = changes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = gaps.len() / 2;
    let every = *gaps.select_nth_unstable(middle).1;
    let loose = usize::from(every >= LOOSE_FROM);
    let regular = gaps.iter().filter(|gap| gap.abs_diff(every) <= loose).count();
    if every < 2 || (regular as f64) < REGULAR * gaps.len() as f64 {
        return None;
    }
    // A new value may be the old one by chance: its rows are counted on.
    let mut kept = Vec::new();
    for pair in changes.windows(2) {
        kept.extend((pair[0]..pair[1]).step_by(every).filter(|row| pair[1] - row > every / 2 || *row == pair[0]));
    }
    kept.extend(changes.last());
    Some((every, kept))
}
