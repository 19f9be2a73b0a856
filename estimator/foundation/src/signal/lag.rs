//! Time lag between two recordings of the same thing: the lag of their greatest correlation.

/// Bins of the first look; every lag is tried there.
const FIRST_BINS: f64 = 2048.0;
/// Refinement of every further look; only lags about the best one are tried there.
const FINER: f64 = 8.0;
/// Least share of the shorter signal that two must have in common: less is alike by chance.
/// Choice: no data.
const LEAST_COMMON: f64 = 0.25;
/// Most bins of the last look: 16 million samples are compared by means over 16.
const MOST_BINS: f64 = 1_048_576.0;
/// Fewest bins in common.
const LEAST_BINS: usize = 8;

/// Position of one signal on another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag {
    /// Offset to be added to the second signal's times, s.
    pub offset_s: f64,
    /// Correlation of the two there, −1 … 1.
    pub likeness: f64,
}

/// A signal: times, s, increasing, and as many values.
pub type Series<'a> = (&'a [f64], &'a [f64]);

/// The lag of greatest correlation, weighed with how much the two then have in common. Means are taken out, scales do not matter.
///
/// Looked for on means over bins, from coarse to the slower sampling rate, and between bins by a parabola. `None` without time, or when
/// one of the two never changes.
pub fn lag(fixed: Series<'_>, moved: Series<'_>) -> Option<Lag> {
    let longest_s = duration(fixed.0).max(duration(moved.0));
    let finest_s = mean_period(fixed.0)?.max(mean_period(moved.0)?).max(longest_s / MOST_BINS);
    let mut step_s = (longest_s / FIRST_BINS).max(finest_s);
    let (mut a, mut b) = (Bins::new(fixed, step_s), Bins::new(moved, step_s));
    let reach = |n: usize| i64::try_from(n).unwrap_or(i64::MAX / 4);
    let mut best = best_lag(&a, &b, -reach(b.len()), reach(a.len()))?;
    while step_s > 1.001 * finest_s {
        let finer_s = (step_s / FINER).max(finest_s);
        let ratio = step_s / finer_s;
        (a, b) = (Bins::new(fixed, finer_s), Bins::new(moved, finer_s));
        let center = (best as f64 * ratio).round() as i64;
        let around = ratio.ceil() as i64 + 1;
        best = best_lag(&a, &b, center - around, center + around)?;
        step_s = finer_s;
    }
    let at = |lag: i64| correlation(&a, &b, lag).map(|(r, _)| r);
    let likeness = at(best)?;
    let between = match (at(best - 1), at(best + 1)) {
        (Some(before), Some(after)) if before + after < 2.0 * likeness => {
            0.5 * (before - after) / (before - 2.0 * likeness + after)
        }
        _ => 0.0,
    };
    let offset_s = (best as f64 + between.clamp(-0.5, 0.5)) * step_s + fixed.0[0] - moved.0[0];
    Some(Lag { offset_s, likeness })
}

fn duration(times: &[f64]) -> f64 {
    times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first)
}

fn mean_period(times: &[f64]) -> Option<f64> {
    let period = duration(times) / times.len().saturating_sub(1).max(1) as f64;
    (period.is_finite() && period > 0.0).then_some(period)
}

/// Means over even intervals of time, less their own mean, with running sums of them and of their squares.
struct Bins {
    means: Vec<f64>,
    sums: Vec<f64>,
    squares: Vec<f64>,
}

impl Bins {
    fn new((times, values): Series<'_>, step_s: f64) -> Self {
        let count = (duration(times) / step_s).ceil().max(1.0) as usize;
        let mut means = vec![(0.0, 0_usize); count];
        for (t, v) in times.iter().zip(values).filter(|(_, v)| v.is_finite()) {
            let (sum, n) = &mut means[(((t - times[0]) / step_s) as usize).min(count - 1)];
            (*sum, *n) = (*sum + v, *n + 1);
        }
        // A bin without samples is as the one before it.
        let mut held = means.iter().find(|(_, n)| *n > 0).map_or(0.0, |(sum, n)| sum / *n as f64);
        let mut means: Vec<f64> = means
            .into_iter()
            .map(|(sum, n)| {
                held = if n > 0 { sum / n as f64 } else { held };
                held
            })
            .collect();
        let mean = means.iter().sum::<f64>() / count as f64;
        for value in &mut means {
            *value -= mean;
        }
        let running = |of: fn(f64) -> f64| -> Vec<f64> {
            let sums = means.iter().scan(0.0, |sum, v| {
                *sum += of(*v);
                Some(*sum)
            });
            std::iter::once(0.0).chain(sums).collect()
        };
        Self { sums: running(|v| v), squares: running(|v| v * v), means }
    }

    fn len(&self) -> usize {
        self.means.len()
    }
}

/// Correlation of `a` with `b` put `lag` bins later, and the share of the shorter one that they have in common.
fn correlation(a: &Bins, b: &Bins, lag: i64) -> Option<(f64, f64)> {
    let first = usize::try_from(lag.max(0)).ok()?;
    let skipped = usize::try_from((-lag).max(0)).ok()?;
    let n = a.len().checked_sub(first)?.min(b.len().checked_sub(skipped)?);
    let shorter = a.len().min(b.len());
    if n < LEAST_BINS.min(shorter) || (n as f64) < LEAST_COMMON * shorter as f64 {
        return None;
    }
    let (x, y) = (&a.means[first..first + n], &b.means[skipped..skipped + n]);
    let product: f64 = x.iter().zip(y).map(|(x, y)| x * y).sum();
    let part = |of: &[f64], from: usize| of[from + n] - of[from];
    let (sum_x, sum_y) = (part(&a.sums, first), part(&b.sums, skipped));
    let count = n as f64;
    let variance =
        (part(&a.squares, first) - sum_x * sum_x / count) * (part(&b.squares, skipped) - sum_y * sum_y / count);
    (variance > 0.0).then(|| ((product - sum_x * sum_y / count) / variance.sqrt(), count / shorter as f64))
}

/// The lag between two that is most alike for how much is in common.
fn best_lag(a: &Bins, b: &Bins, from: i64, to: i64) -> Option<i64> {
    let scored = (from..=to).filter_map(|lag| {
        let (likeness, common) = correlation(a, b, lag)?;
        Some((lag, likeness * common.sqrt()))
    });
    scored.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(lag, _)| lag)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pushes and a ripple that never repeats within the record.
    fn force(t: f64) -> f64 {
        (-(t - 3.0).powi(2) / 0.05).exp() + 0.6 * (-(t - 6.2).powi(2) / 0.2).exp() + 0.1 * (1.3 * t * t).sin()
    }

    #[test]
    fn a_shift_is_found_to_a_fraction_of_a_sample_whatever_rate_scale_and_start() {
        let a: Vec<f64> = (0..10_000).map(|i| f64::from(i) * 1e-3).collect();
        for (shift, rate_hz, start_s) in [(0.4321, 500.0, 0.0), (-1.2, 1_000.0, 5.0), (2.25, 230.0, -3.0)] {
            let b: Vec<f64> = (0..(9.0 * rate_hz) as usize).map(|i| start_s + i as f64 / rate_hz).collect();
            let of_a: Vec<f64> = a.iter().map(|t| force(*t)).collect();
            let of_b: Vec<f64> = b.iter().map(|t| 7.0 - 3.0 * -force(t + shift)).collect();
            let found = lag((&a, &of_a), (&b, &of_b)).expect("alike");
            assert!((found.offset_s - shift).abs() < 0.6 / rate_hz, "{shift} at {rate_hz} Hz: {found:?}");
            assert!(found.likeness > 0.99, "{found:?}");
        }
    }

    #[test]
    fn a_piece_of_a_recording_is_found_in_it() {
        let a: Vec<f64> = (0..10_000).map(|i| f64::from(i) * 1e-3).collect();
        let of_a: Vec<f64> = a.iter().map(|t| force(*t)).collect();
        let found = lag((&a, &of_a), (&a[..2_000], &of_a[5_500..7_500])).expect("alike");
        assert!((found.offset_s - 5.5).abs() < 2e-3 && found.likeness > 0.99, "{found:?}");
    }

    #[test]
    fn what_never_changes_or_has_no_time_lies_nowhere() {
        let time: Vec<f64> = (0..100).map(f64::from).collect();
        let flat = vec![2.0; 100];
        assert_eq!(lag((&time, &time), (&time, &flat)), None);
        assert_eq!(lag((&[], &[]), (&time, &time)), None);
        assert_eq!(lag((&[1.0], &[1.0]), (&time, &time)), None);
    }
}
