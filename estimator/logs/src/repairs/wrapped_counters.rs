//! Counters of a few bits that run over, and go on from their other end.

use crate::checks::{extremes, is_position, place};
use crate::units;
use haptics::recording::{Channel, Recording, Span, Warning};

/// Bits of counters and converters. Signals of fewer bits fill their range by chance.
const BITS: [i32; 5] = [12, 14, 16, 24, 32];
/// Least bits of a force's: dry friction of 2 N that reverses fills 12 bits of 1 mN, and a converter of few bits stops at its ends.
const BITS_OF_FORCE: i32 = 16;
/// Lengths of scales that start anew, in decades.
const ROUND: [f64; 4] = [1.0, 2.0, 5.0, 10.0];
/// Least share of a counter's range that its values fill if it ran over.
const FILLED: f64 = 0.9;
/// Usual step in one sample of a force, and of a scale of round length, as a share of the range. Dry friction that reverses makes
/// larger ones.
const STEP: f64 = 0.1;
/// Least share of overruns beside which the step is a usual one.
const USUAL: f64 = 0.5;
/// Least part of the range at its ends, and the largest share of samples there: a force that switches between its limits is no
/// counter.
const AT_END: f64 = 0.01;
const MOST_AT_ENDS: f64 = 0.3;
/// Differences that show the unit of a counter.
const DIFFERENCES: usize = 2_000;
/// A remainder this small beside the largest difference is rounding.
const ROUNDING: f64 = 1e-7;

/// Lets the values of counters go on where they ran over.
pub fn unwrap(recording: &mut Recording) -> Vec<Warning> {
    let mut found = Vec::new();
    for k in 0..recording.channels.len() {
        let Some((range, overruns)) = overruns(&recording.channels[k], recording.time_s.as_ref()) else { continue };
        let channel = &recording.channels[k];
        let text = format!(
            "{} runs over the end of its counter {} time(s), first at {}: its values go on from there",
            channel.name,
            overruns.len(),
            place(recording, overruns[0])
        );
        let spans = overruns.iter().map(|&i| Span { first: i, end: i + 1 }).collect();
        let (kind, column) = ("wrapped-counter".to_owned(), Some(channel.name.clone()));
        found.push(Warning { kind, column, spans, text, ..Warning::default() });
        go_on(&mut recording.channels[k], range, &overruns);
    }
    found
}

/// Adds the ranges of the counter that went by.
fn go_on(channel: &mut Channel, range: f64, overruns: &[usize]) {
    super::add_cycles(&mut channel.values, range, overruns);
    // A counter of forces holds those about zero: the first of them may have been below it.
    if matches!(channel.unit.as_str(), "N" | "Nm") && !channel.values.is_empty() {
        let mut sorted = channel.values.clone();
        let middle = sorted.len() / 2;
        let median = *sorted.select_nth_unstable_by(middle, f64::total_cmp).1;
        let shift = range * (median / range).round();
        channel.values.iter_mut().for_each(|value| *value -= shift);
    }
}

/// True if the clock runs on at all of these rows. Without a clock, and behind a gap, a position may be another one.
fn runs_on(time_s: Option<&Vec<f64>>, rows: &[usize]) -> bool {
    let Some(time_s) = time_s else { return false };
    let mut steps: Vec<f64> = time_s.windows(2).map(|w| w[1] - w[0]).collect();
    let middle = steps.len() / 2;
    let usual = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
    rows.iter().all(|row| time_s[*row] - time_s[row - 1] <= 2.0 * usual)
}

/// Range of a counter that ran over, and the samples at which it did. A scale of round length does so only where the clock runs on.
fn overruns(channel: &Channel, time_s: Option<&Vec<f64>>) -> Option<(f64, Vec<usize>)> {
    let values = channel.values.as_slice();
    let is_force = matches!(channel.unit.as_str(), "N" | "Nm");
    if values.len() < 3 || !(is_position(channel) || is_force && units::is_program_name(&channel.name)) {
        return None;
    }
    let (low, high, _) = extremes(values);
    let span = high - low;
    let is_leap = |i: &usize| (values[*i] - values[*i - 1]).abs() > 0.5 * span;
    let leaps: Vec<usize> = (1..values.len()).filter(is_leap).collect();
    if leaps.is_empty() {
        return None;
    }
    let unit = unit(values);
    let fits = |range: &f64| span < *range && span >= FILLED * range;
    let least = if is_force { BITS_OF_FORCE } else { 0 };
    let of_bits = |unit: f64| BITS.iter().filter(|bits| **bits >= least).map(move |bits| unit * 2_f64.powi(*bits));
    let binary = unit.and_then(|unit| of_bits(unit).find(fits));
    let round = || round_range(span).filter(|range| !is_force && fits(range) && runs_on(time_s, &leaps));
    let range = binary.or_else(round)?;
    let unit = unit.unwrap_or(0.0);
    // A force counts from an end of its range, or from the middle; the origin of a position may have been moved.
    let begins_at = |start: f64| low >= start - 0.5 * unit && high < start + range + 0.5 * unit;
    if is_force && ![0.0, -0.5 * range, -range].into_iter().any(begins_at) {
        return None;
    }
    let ends = values.iter().filter(|v| (*v - low).min(high - *v) <= AT_END * range).count();
    // Beside the range, the step is like those of its neighbours.
    let goes_on = |&&i: &&usize| {
        let step = |i: usize| values.get(i).map_or(0.0, |value| (value - values[i - 1]).abs());
        let usual = if i > 1 { step(i - 1) } else { 0.0 }.max(step(i + 1));
        let most = if is_force { STEP * range } else { 2.0 * usual + 2.0 * unit };
        // A leap beside another one is no overrun.
        let largest = if binary.is_some() { 0.5 * span } else { STEP * range };
        (step(i) - range).abs() <= most && (is_force || usual <= largest)
    };
    let share = if is_force { USUAL } else { 1.0 };
    let is_smooth = leaps.iter().filter(|leap| goes_on(leap)).count() as f64 >= share * leaps.len() as f64;
    let is_counter = is_smooth && ends as f64 <= MOST_AT_ENDS * values.len() as f64;
    is_counter.then_some((range, leaps))
}

/// The smallest round number above a span: the length of a scale that starts anew.
fn round_range(span: f64) -> Option<f64> {
    let decade = 10_f64.powf(span.log10().floor());
    ROUND.into_iter().map(|round| round * decade).find(|range| *range * (1.0 - ROUNDING) > span)
}

/// Greatest common divisor of the differences of successive values; none if they have none but rounding.
fn unit(values: &[f64]) -> Option<f64> {
    let steps = values.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|step| *step > 0.0);
    let steps: Vec<f64> = steps.take(DIFFERENCES).collect();
    let least = ROUNDING * steps.iter().copied().fold(0.0, f64::max);
    let common = |a: f64, b: f64| {
        let (mut a, mut b) = (a, b);
        while b > least {
            (a, b) = (b, a % b);
            // The remainder of a multiple may come out as nearly the divisor.
            b = if a - b <= least { 0.0 } else { b };
        }
        a
    };
    steps.into_iter().reduce(common).filter(|unit| *unit > least)
}
