//! Channels of one clock onto another: zero phase, never beyond the first and the last sample.

use crate::raw::{Cells, MISSING, is_missing};
use foundation::signal::filter;
use foundation::signal::interpolation::{before, cubic};
use haptics::recording::Labels;

/// A channel that is this much faster than the clock is low-passed first.
const FASTER: f64 = 1.2;
/// Cut-off of that low-pass (−6 dB), as a share of the clock's rate: the part that would fold is down to a tenth.
const CUTOFF_SHARE: f64 = 0.4;
/// Step in periods from which there is a gap across which values are made up.
const GAP_PERIODS: f64 = 10.0;

/// Median time between samples, s.
pub fn period(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
    if steps.is_empty() {
        return 0.0;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn goes_down(from: &[f64], to: &[f64]) -> bool {
    period(to) > FASTER * period(from)
}

/// True if there are clearly fewer samples than the times that they are put on.
pub fn is_slower(from: &[f64], to: &[f64]) -> bool {
    goes_down(to, from)
}

/// Description of the resampling, for people.
pub fn describe(name: &str, from: &[f64], to: &[f64]) -> String {
    let (old, new) = (1.0 / period(from), 1.0 / period(to));
    let filter = if goes_down(from, to) {
        format!("after a zero-phase low-pass at {} ", hertz(CUTOFF_SHARE * new))
    } else {
        String::new()
    };
    format!("{name} ({}) is put on it ({}) {filter}by cubic interpolation between samples", hertz(old), hertz(new))
}

/// A rate with four digits.
fn hertz(rate: f64) -> String {
    let decimals = (3.0 - rate.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{rate:.decimals$} Hz")
}

/// A sentence when values are interpolated across a gap.
pub fn gaps(name: &str, from: &[f64], to: &[f64]) -> Option<String> {
    let (first, last) = (*to.first()?, *to.last()?);
    let limit = GAP_PERIODS * period(from);
    let gaps: Vec<&[f64]> = from.windows(2).filter(|w| w[1] - w[0] > limit && w[1] > first && w[0] < last).collect();
    let longest = gaps.iter().max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    Some(format!(
        "{name} has {} gap(s), the longest from {:.4} to {:.4} s: its values there are interpolated",
        gaps.len(),
        longest[0],
        longest[1]
    ))
}

/// For each time of `to`: true if it lies within the span of `from`, and in no gap of it. Both increase.
pub fn covered(from: &[f64], to: &[f64]) -> Vec<bool> {
    let limit = GAP_PERIODS * period(from);
    let (first, last) = (from.first().copied().unwrap_or(f64::NAN), from.last().copied().unwrap_or(f64::NAN));
    let is_covered = |&t: &f64| {
        if !(first..=last).contains(&t) {
            return false;
        }
        let i = before(from, t);
        from[i] == t || from.get(i + 1).is_none_or(|next| next - from[i] <= limit)
    };
    to.iter().map(is_covered).collect()
}

/// Puts a channel with samples at `from` onto the times `to`, which lie within `from`.
///
/// Numbers: low-passed forward and backward if they are faster than the clock, then [`cubic`]. Text: the last one
/// before.
pub fn onto(to: &[f64], from: &[f64], cells: &Cells) -> Cells {
    if to == from {
        return cells.clone();
    }
    match cells {
        Cells::Text(texts) => {
            let mut held = Labels::default();
            for &t in to {
                held.push(&texts[before(from, t)]);
            }
            Cells::Text(held)
        }
        Cells::Numbers(values) if goes_down(from, to) && values.iter().all(|v| v.is_finite()) => {
            let smooth = low_passed(from, values, CUTOFF_SHARE / period(to));
            Cells::Numbers(to.iter().map(|&t| value_at(from, &smooth, t)).collect())
        }
        Cells::Numbers(values) => Cells::Numbers(to.iter().map(|&t| value_at(from, values, t)).collect()),
    }
}

/// Values without the frequencies above `cutoff_hz`, between gaps: a filter that runs across one rings at its ends.
fn low_passed(time: &[f64], values: &[f64], cutoff_hz: f64) -> Vec<f64> {
    let usual = period(time);
    let mut smooth = Vec::with_capacity(values.len());
    for part in time.chunk_by(|a, b| b - a <= GAP_PERIODS * usual) {
        let first = smooth.len();
        smooth.extend(filter::low_pass(&values[first..first + part.len()], 1.0 / usual, cutoff_hz));
    }
    smooth
}

/// Value at `t`, or missing beside a missing sample.
fn value_at(time: &[f64], values: &[f64], t: f64) -> f64 {
    let i = before(time, t);
    let is_between = time[i] != t && i + 1 < time.len();
    if is_between && (is_missing(values[i]) || is_missing(values[i + 1])) { MISSING } else { cubic(time, values, t) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn times(n: usize, rate: f64, start: f64) -> Vec<f64> {
        (0..n).map(|i| start + i as f64 / rate).collect()
    }

    fn numbers(cells: Cells) -> Vec<f64> {
        let Cells::Numbers(values) = cells else { panic!("numbers") };
        values
    }

    #[test]
    fn a_slow_signal_keeps_its_place_in_both_directions() {
        for (from_rate, to_rate) in [(2000.0, 1500.0), (1000.0, 1500.0), (2000.0, 200.0), (100.0, 1000.0)] {
            let from = times((from_rate * 4.0) as usize, from_rate, 0.0);
            let to = times((to_rate * 2.0) as usize, to_rate, 1.000_3);
            let wave = |t: f64| (TAU * 3.0 * t).sin() + 0.5 * t;
            let made = numbers(onto(&to, &from, &Cells::Numbers(from.iter().map(|&t| wave(t)).collect())));
            let worst = to.iter().zip(&made).map(|(&t, v)| (v - wave(t)).abs()).fold(0.0, f64::max);
            assert!(worst < 2e-3, "{from_rate} to {to_rate} Hz: {worst}");
        }
    }

    #[test]
    fn what_would_fold_is_taken_out() {
        let from = times(8000, 2000.0, 0.0);
        let to = times(380, 200.0, 1.0);
        // 190 Hz would appear as 10 Hz.
        let made = numbers(onto(&to, &from, &Cells::Numbers(from.iter().map(|t| (TAU * 190.0 * t).sin()).collect())));
        assert!(made.iter().all(|v| v.abs() < 0.02), "{:?}", made.iter().fold(0.0_f64, |m, v| m.max(v.abs())));
    }

    #[test]
    fn uneven_steps_and_missing_values_are_respected() {
        let from = [0.0, 0.1, 0.15, 0.4, 0.5];
        let square: Vec<f64> = from.iter().map(|t| t * t).collect();
        let made = numbers(onto(&[0.12, 0.15, 0.2, 0.25, 0.3], &from, &Cells::Numbers(square)));
        assert!(
            (made[0] - 0.0144).abs() < 1e-12 && made[1] == 0.15 * 0.15 && (made[4] - 0.09).abs() < 1e-12,
            "{made:?}"
        );
        let made = numbers(onto(&[0.05, 0.2], &from, &Cells::Numbers(vec![1.0, MISSING, 3.0, 4.0, 5.0])));
        assert!(is_missing(made[0]) && made[1].is_finite());
        let mut texts = Labels::default();
        for text in ["a", "b", "c", "d", "e"] {
            texts.push(text);
        }
        let held = onto(&[0.05, 0.15, 0.39], &from, &Cells::Text(texts));
        assert_eq!([held.text(0), held.text(1), held.text(2)], ["a", "c", "c"]);
    }
}
