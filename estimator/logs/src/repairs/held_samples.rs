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
const LOOSE_FROM: f64 = 4.0;
/// Least ratio of the rates. Choice: at 1.25, one row in five repeats, as parts of a real toss do, too.
const LEAST_RATIO: f64 = 1.4;
/// Least ratio of a channel that is interpolated. Choice: bends of noise in neighbouring rows count as one, and come 2 to 2.5 rows apart.
const LEAST_INTERPOLATED: f64 = 2.75;
/// Number of changes in a row that take their time together: repeats by chance spread far more.
const TOGETHER: usize = 8;
/// Rows by which they may be early or late. Derived: two clocks without noise make one.
const OFF_BEAT: f64 = 1.5;
/// A bend of a line in bends of the quietest quarter of the rows. Derived: above it are 3 of 1000 rows of white noise.
const BENT: f64 = 10.0;
/// A bend in the least bend. Derived: the rounding of three values to a quantum makes bends of two quanta.
const ROUNDED: f64 = 2.02;

/// Difference of two ratios up to which the channels have one source. Choice: clocks of two sources differ by less only by chance.
const SAME_RHYTHM: f64 = 1e-3;
/// Number of new values on either side over which the beat of the clocks is averaged. Choice: two clocks drift little in so many.
const SMOOTHED: usize = 32;

/// Ratio of neighbouring steps from which a row is missing. Derived: one row makes it two.
const MISSING: f64 = 1.5;

/// The rows in which a channel has a new value.
struct Rhythm {
    name: String,
    /// Mean number of rows between new values.
    every: f64,
    rows: Vec<usize>,
    interpolated: bool,
}

/// Leaves the rows out in which the slowest channel of the program repeats or interpolates its value.
pub fn take_out(recording: &mut Recording) -> Option<Warning> {
    let time = recording.time_s.as_deref();
    let known = recording.channels.iter().filter(|c| units::is_program_name(&c.name));
    let found: Vec<Rhythm> =
        known.filter_map(|channel| held(channel).or_else(|| interpolated(channel, time))).collect();
    let Rhythm { name, every, rows, interpolated } = found.iter().max_by(|a, b| a.every.total_cmp(&b.every))?;
    // Sensors in turn may share a channel, which has a new value once for all of them.
    if !alternating(recording).is_empty() {
        return None;
    }
    let count = recording.len();
    let rate_hz = recording.time_s.as_ref().map(|time| (count - 1) as f64 / (time[count - 1] - time[0]));
    let rate = rate_hz.map_or(String::new(), |rate| format!(", at {:.4} Hz,", rate / every));
    let shown = (100.0 * every).round() / 100.0;
    let between = if *interpolated { "is interpolated" } else { "repeats it" };
    let text = format!(
        "{name} has only one new value in {shown} rows{rate} and {between} in between: the {} rows of {count} without a new one are left out",
        count - rows.len()
    );
    let (name, lags) = (name.clone(), lags(rows, *every));
    let has_rhythm = |other: &Rhythm| !other.interpolated && (other.every / every - 1.0).abs() < SAME_RHYTHM;
    let late: Vec<&String> = found.iter().filter(|other| has_rhythm(other)).map(|other| &other.name).collect();
    let (rows, every) = (rows.clone(), *every);
    recording.keep(&rows);
    for channel in recording.channels.iter_mut().filter(|channel| late.contains(&&channel.name)) {
        advance(&mut channel.values, &lags, every);
    }
    let spans = vec![Span { first: 0, end: rows.len() }];
    Some(Warning { kind: "held-samples".to_owned(), column: Some(name), spans, text, ..Warning::default() })
}

/// Rows by which new values come after their source took them: an even clock shows its times, as the mean over many rows.
///
/// A value comes with the next row, so that it is late by 0 to 1 row. If the lag is the same for all, it cannot be seen, and is 0.
fn lags(rows: &[usize], every: f64) -> Vec<f64> {
    let early: Vec<f64> = rows.iter().enumerate().map(|(k, row)| *row as f64 - every * k as f64).collect();
    let late: Vec<f64> = (0..early.len())
        .map(|k| {
            // As many on either side: a ratio that drifts has no influence.
            let half = SMOOTHED.min(k).min(early.len() - 1 - k);
            let near = &early[k - half..=k + half];
            early[k] - near.iter().sum::<f64>() / near.len() as f64
        })
        .collect();
    let variance = late.iter().map(|lag| lag * lag).sum::<f64>() / late.len().max(1) as f64;
    // The mean of an even distribution from 0 on.
    let mean = (3.0 * variance).sqrt().min(0.5);
    late.into_iter().map(|lag| (lag + mean).clamp(0.0, 1.0)).collect()
}

/// Moves values that are late by some rows to the rows, along the lines to the next ones.
fn advance(values: &mut [f64], lags: &[f64], every: f64) {
    for k in 0..values.len().saturating_sub(1) {
        values[k] += (values[k + 1] - values[k]) * lags[k] / every;
    }
}

/// New values of a channel that holds them.
fn held(channel: &Channel) -> Option<Rhythm> {
    let values = &channel.values;
    // Most channels change with nearly every row.
    let count = values.len() - extremes(values).2;
    if count < LEAST_CHANGES + 1 || LEAST_RATIO * count as f64 > (values.len() + 4) as f64 {
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
    let (every, rows) = rhythm(&changes).filter(|(every, _)| *every > LEAST_INTERPOLATED)?;
    Some(Rhythm { name: channel.name.clone(), every, rows, interpolated: true })
}

/// Mean distance of rows with new values, if they are regular, and these rows. Two clocks may have any ratio: 2.7 makes distances of 2
/// and 3 rows.
fn rhythm(changes: &[usize]) -> Option<(f64, Vec<usize>)> {
    let mut gaps: Vec<usize> = changes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let middle = gaps.len() / 2;
    let usual = *gaps.select_nth_unstable(middle).1;
    let near: Vec<usize> = gaps.iter().copied().filter(|gap| gap.abs_diff(usual) <= 1).collect();
    let every = near.iter().sum::<usize>() as f64 / near.len() as f64;
    let loose = if every < LOOSE_FROM { 1.0 } else { 2.0 };
    let is_regular = |gap: usize| (gap as f64 - every).abs() < loose;
    let is_in_time = |w: &[usize]| ((w[TOGETHER] - w[0]) as f64 - TOGETHER as f64 * every).abs() < OFF_BEAT;
    let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    if every < LEAST_RATIO || share(gaps.iter().filter(|gap| is_regular(**gap)).count(), gaps.len()) < REGULAR {
        return None;
    }
    // A new value may be the old one by chance: its rows are counted on.
    let mut kept = Vec::new();
    for pair in changes.windows(2) {
        let rows = (0..).map(|k| pair[0] + (every * f64::from(k)).round() as usize).take_while(|row| *row < pair[1]);
        let is_whole = is_regular(pair[1] - pair[0]);
        kept.extend(rows.filter(|row| *row == pair[0] || !is_whole && (pair[1] - row) as f64 > 0.5 * every));
    }
    kept.extend(changes.last());
    let in_time = kept.windows(TOGETHER + 1).filter(|w| is_in_time(w)).count();
    (every >= LOOSE_FROM || share(in_time, kept.len().saturating_sub(TOGETHER)) >= REGULAR).then_some((every, kept))
}
