//! Derivatives of sampled signals.

use super::correlate::correlate;
use nalgebra::{DMatrix, DVector};
use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

/// Steps that differ by this share of one are the same.
const SAME_STEP: f64 = 1e-3;
/// A polynomial this small on the samples is nought there.
const SINGULAR: f64 = 1e-12;

/// Value and first two derivatives of a signal, one a sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Derivatives {
    /// Smoothed value.
    pub value: Vec<f64>,
    /// Per second.
    pub first: Vec<f64>,
    /// Per second squared.
    pub second: Vec<f64>,
}

/// Local polynomial fit (Savitzky and Golay 1964) of `order` over 2·`half_width` + 1 samples, also for uneven `time_s`;
/// one-sided at the ends.
///
/// `time_s`, `values`: n samples each, time strictly increasing. Degenerate: a record shorter than the window uses all
/// its samples; fewer samples than the polynomial needs give a lower order.
pub fn savitzky_golay(time_s: &[f64], values: &[f64], half_width: usize, order: usize) -> Derivatives {
    let n = values.len().min(time_s.len());
    let mut out = Derivatives { value: vec![0.0; n], first: vec![0.0; n], second: vec![0.0; n] };
    let window = (2 * half_width + 1).min(n);
    let Some(period) = even_period(&time_s[..n]) else {
        uneven(&mut out, (&time_s[..n], &values[..n]), window, order);
        return out;
    };
    // Even sampling: the weights depend only on the place within the window, and inside they are always the same.
    let whole = if window == 2 * half_width + 1 { n - half_width } else { half_width };
    let inside = half_width..whole;
    for i in (0..n).filter(|i| !inside.contains(i)) {
        let first = i.saturating_sub(half_width).min(n - window);
        let rows = even_weights(window, i - first, order);
        put(&mut out, i, &rows, &values[first..first + window], period);
    }
    if !inside.is_empty() {
        let rows = even_weights(window, half_width, order);
        let scales = [1.0, 1.0 / period, 1.0 / (period * period)];
        let series = [&mut out.value, &mut out.first, &mut out.second];
        for ((out, row), scale) in series.into_iter().zip(rows.iter()).zip(scales) {
            for (to, sum) in out[inside.clone()].iter_mut().zip(correlate(&values[..n], row)) {
                *to = sum * scale;
            }
        }
    }
    out
}

/// The same sample by sample: weights are made again only if the steps around a sample differ from those around the one
/// before.
fn uneven(out: &mut Derivatives, (time_s, values): (&[f64], &[f64]), window: usize, order: usize) {
    let n = time_s.len();
    let mut known: Option<(usize, usize, [Vec<f64>; 3])> = None;
    for i in 0..n {
        let first = i.saturating_sub(window / 2).min(n - window);
        let times = &time_s[first..first + window];
        let alike = |(of, begun, _): &(usize, usize, _)| {
            let step_s = (times[window - 1] - times[0]) / window as f64;
            let was = &time_s[*begun..begun + window];
            let moved = |(now, was): (&f64, &f64)| ((now - time_s[i]) - (was - time_s[*of])).abs();
            i - first == of - begun && times.iter().zip(was).all(|pair| moved(pair) <= SAME_STEP * step_s)
        };
        let (_, _, rows) = match known.take().filter(alike) {
            Some(kept) => known.insert(kept),
            None => known.insert((i, first, local_weights(times, time_s[i], order))),
        };
        put(out, i, rows, &values[first..first + window], 1.0);
    }
}

fn put(out: &mut Derivatives, i: usize, rows: &[Vec<f64>; 3], values: &[f64], period: f64) {
    let dot = |row: &[f64]| row.iter().zip(values).map(|(w, v)| w * v).sum::<f64>();
    out.value[i] = dot(&rows[0]);
    out.first[i] = dot(&rows[1]) / period;
    out.second[i] = dot(&rows[2]) / (period * period);
}

/// Weights of value, slope and curvature, one a sample of the window.
type Weights = Rc<[Vec<f64>; 3]>;

/// [`local_weights`] at the sample of index `place` of `window` even ones, a period of 1 apart. Weights of short windows
/// are kept: a recording of many short segments needs the same ones at both ends of each, and making them takes longer
/// than all the rest.
fn even_weights(window: usize, place: usize, order: usize) -> Weights {
    /// All places of all shorter windows are a few hundred kilobytes for each order.
    const KEPT: usize = 32;
    thread_local! {
        static KNOWN: RefCell<HashMap<[usize; 3], Weights>> = RefCell::new(HashMap::new());
    }
    let make = || {
        let grid: Vec<f64> = (0..window).map(|k| k as f64).collect();
        Rc::new(local_weights(&grid, place as f64, order))
    };
    if window > KEPT {
        return make();
    }
    KNOWN.with_borrow_mut(|known| known.entry([window, place, order.min(window)]).or_insert_with(make).clone())
}

/// Weights for value, slope and curvature at `at` of the least-squares polynomial through samples at `time`, built of
/// polynomials that are orthogonal on these samples (Forsythe 1957). With coincident times the order is as high as the
/// others allow.
fn local_weights(time: &[f64], at: f64, order: usize) -> [Vec<f64>; 3] {
    let n = time.len();
    // Scaled so that the powers stay near 1.
    let reach = time.iter().map(|t| (t - at).abs()).fold(0.0, f64::max);
    let reach = if reach > 0.0 { reach } else { 1.0 };
    let x: Vec<f64> = time.iter().map(|t| (t - at) / reach).collect();
    let mut weights = [0; 3].map(|_| vec![0.0; n]);
    // The polynomial of one order on the samples, and the one before; value, slope and curvature of both at `at`.
    let (mut now, mut before) = (vec![1.0; n], vec![0.0; n]);
    let (mut here, mut behind) = ([1.0, 0.0, 0.0], [0.0; 3]);
    let mut square_before = f64::INFINITY;
    for _ in 0..=order.min(n.saturating_sub(1)) {
        let square: f64 = now.iter().map(|p| p * p).sum();
        if square <= SINGULAR * SINGULAR * n as f64 {
            break;
        }
        for (weights, here) in weights.iter_mut().zip(here) {
            weights.iter_mut().zip(&now).for_each(|(weight, p)| *weight += here / square * p);
        }
        let middle = x.iter().zip(&now).map(|(x, p)| x * p * p).sum::<f64>() / square;
        let back = square / square_before;
        for ((x, now), before) in x.iter().zip(&mut now).zip(&mut before) {
            let next = (x - middle) * *now - back * *before;
            *before = std::mem::replace(now, next);
        }
        let of = |k: usize, more: f64| more - middle * here[k] - back * behind[k];
        let next = [of(0, 0.0), of(1, here[0]), of(2, 2.0 * here[1])];
        behind = std::mem::replace(&mut here, next);
        square_before = square;
    }
    for (weights, scale) in weights.iter_mut().zip([1.0, 1.0 / reach, 1.0 / (reach * reach)]) {
        for weight in weights {
            *weight *= scale;
        }
    }
    weights
}

/// The sampling period when the steps agree within 0.1 % of it, else `None`.
pub fn even_period(time_s: &[f64]) -> Option<f64> {
    let n = time_s.len();
    if n < 2 {
        return None;
    }
    let period = (time_s[n - 1] - time_s[0]) / (n - 1) as f64;
    let even = time_s.windows(2).all(|w| (w[1] - w[0] - period).abs() <= SAME_STEP * period);
    even.then_some(period)
}

/// First derivative by the three-point formula for uneven steps, second order inside, one-sided at the ends.
pub fn central_differences(time_s: &[f64], values: &[f64]) -> Vec<f64> {
    let n = values.len().min(time_s.len());
    if n < 2 {
        return vec![0.0; n];
    }
    let slope = |i: usize| (values[i + 1] - values[i]) / (time_s[i + 1] - time_s[i]);
    (0..n)
        .map(|i| {
            if i == 0 {
                return slope(0);
            }
            if i == n - 1 {
                return slope(n - 2);
            }
            let (before, after) = (time_s[i] - time_s[i - 1], time_s[i + 1] - time_s[i]);
            (slope(i - 1) * after + slope(i) * before) / (before + after)
        })
        .collect()
}

/// Central weights of eighth order for offsets 1 … 4 (Fornberg 1988, table 1): first derivative.
const FIRST: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
/// The same for the second derivative; the weight at offset 0 is −205/72.
const SECOND: [f64; 4] = [8.0 / 5.0, -1.0 / 5.0, 8.0 / 315.0, -1.0 / 560.0];

/// First and second derivative of an evenly sampled, band-limited signal by nine-point stencils: within 1 % up to a fifth of
/// the sampling rate. The outer four samples on each side come from a local polynomial.
pub fn stencil(values: &[f64], period_s: f64) -> (Vec<f64>, Vec<f64>) {
    let n = values.len();
    let grid: Vec<f64> = (0..n.min(16)).map(|i| i as f64 * period_s).collect();
    if n < 9 {
        let local = savitzky_golay(&grid, values, 4, 4);
        return (local.first, local.second);
    }
    let (mut first, mut second) = (vec![0.0; n], vec![0.0; n]);
    for i in 4..n - 4 {
        let mut sums = [0.0, -205.0 / 72.0 * values[i]];
        for (k, (a, b)) in FIRST.iter().zip(SECOND).enumerate() {
            let (before, after) = (values[i - k - 1], values[i + k + 1]);
            sums[0] += a * (after - before);
            sums[1] += b * (after + before);
        }
        first[i] = sums[0] / period_s;
        second[i] = sums[1] / (period_s * period_s);
    }
    let edge = |part: &[f64]| savitzky_golay(&grid[..9], part, 4, 5);
    let (head, tail) = (edge(&values[..9]), edge(&values[n - 9..]));
    for k in 0..4 {
        (first[k], second[k]) = (head.first[k], head.second[k]);
        (first[n - 4 + k], second[n - 4 + k]) = (tail.first[5 + k], tail.second[5 + k]);
    }
    (first, second)
}

/// The signal at the times `wanted`, by linear interpolation; held at the ends. Both times increasing.
pub fn interpolate(time_s: &[f64], values: &[f64], wanted: &[f64]) -> Vec<f64> {
    let mut at = 0;
    let last = values.len().saturating_sub(1);
    wanted
        .iter()
        .map(|&t| {
            while at + 1 < last && time_s[at + 1] < t {
                at += 1;
            }
            if last == 0 || t <= time_s[0] {
                return values.first().copied().unwrap_or(0.0);
            }
            let share = ((t - time_s[at]) / (time_s[at + 1] - time_s[at])).clamp(0.0, 1.0);
            values[at] + share * (values[at + 1] - values[at])
        })
        .collect()
}

/// The signal at the times `wanted` by cubics through the samples, with the slopes of the three-point formula; held at the
/// ends. Linear in `values`, and local: a jump is smeared over its neighbours only. Both times increasing.
pub fn interpolate_cubic(time_s: &[f64], values: &[f64], wanted: &[f64]) -> Vec<f64> {
    let n = values.len().min(time_s.len());
    if n < 3 {
        return interpolate(&time_s[..n], &values[..n], wanted);
    }
    let slopes = central_differences(time_s, values);
    let mut at = 0;
    wanted
        .iter()
        .map(|&t| {
            while at + 2 < n && time_s[at + 1] < t {
                at += 1;
            }
            let step = time_s[at + 1] - time_s[at];
            let x = ((t - time_s[at]) / step).clamp(0.0, 1.0);
            let rise = values[at + 1] - values[at];
            let (before, after) = (slopes[at] * step - rise, slopes[at + 1] * step - rise);
            values[at] + x * rise + x * (1.0 - x) * ((1.0 - x) * before - x * after)
        })
        .collect()
}

/// The coefficients c0 + c1 x + … of the least-squares polynomial.
pub fn polynomial(x: &[f64], y: &[f64], order: usize) -> Vec<f64> {
    let n = x.len().min(y.len());
    let order = order.min(n.saturating_sub(1));
    let powers = DMatrix::from_fn(n, order + 1, |i, j| (0..j).fold(1.0, |product, _| product * x[i]));
    let target = DVector::from_fn(n, |i, _| y[i]);
    powers.svd(true, true).solve(&target, 1e-12).map_or_else(|_| vec![0.0; order + 1], |c| c.iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cubic(t: f64) -> [f64; 3] {
        [1.0 + 2.0 * t - t * t + 0.5 * t.powi(3), 2.0 - 2.0 * t + 1.5 * t * t, -2.0 + 3.0 * t]
    }

    fn worst(got: &[f64], time: &[f64], which: usize) -> f64 {
        got.iter().zip(time).map(|(g, &t)| (g - cubic(t)[which]).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_cubic_is_differentiated_exactly_also_unevenly_and_at_the_ends() {
        let even: Vec<f64> = (0..60).map(|i| f64::from(i) * 0.01).collect();
        let uneven: Vec<f64> = (0..60).map(|i| f64::from(i) * 0.01 + 0.003 * (f64::from(i) * 1.7).sin()).collect();
        for time in [even, uneven] {
            let values: Vec<f64> = time.iter().map(|&t| cubic(t)[0]).collect();
            let d = savitzky_golay(&time, &values, 5, 3);
            assert!(worst(&d.value, &time, 0) < 1e-12);
            assert!(worst(&d.first, &time, 1) < 1e-9 && worst(&d.second, &time, 2) < 1e-7);
        }
    }

    #[test]
    fn a_gap_in_even_samples_changes_nothing_beside_it_and_costs_no_exactness() {
        let time: Vec<f64> = (0..90).map(|i| f64::from(i) * 0.01 + if i >= 40 { 0.137 } else { 0.0 }).collect();
        let values: Vec<f64> = time.iter().map(|&t| cubic(t)[0]).collect();
        let d = savitzky_golay(&time, &values, 5, 3);
        assert!(worst(&d.value, &time, 0) < 1e-12);
        assert!(worst(&d.first, &time, 1) < 1e-9 && worst(&d.second, &time, 2) < 1e-7);
        let rough: Vec<f64> = (0..90).map(|i| (f64::from(i) * 12.9898).sin()).collect();
        let whole = savitzky_golay(&time, &rough, 5, 3);
        let part = savitzky_golay(&time[..40], &rough[..40], 5, 3);
        for i in 0..35 {
            assert!((whole.second[i] - part.second[i]).abs() < 1e-6 * part.second[i].abs().max(1.0), "{i}");
        }
    }

    #[test]
    fn times_that_are_the_same_give_a_lower_order_and_no_nonsense() {
        let d = savitzky_golay(&[0.0, 1.0, 1.0, 1.0, 3.0], &[1.0, 2.0, 2.0, 2.0, 4.0], 2, 3);
        assert!(d.value.iter().chain(&d.first).all(|v| v.is_finite()));
        assert!((d.value[0] - 1.0).abs() < 1e-9);
    }

    #[test]
    fn stencils_hold_to_a_fifth_of_the_rate() {
        for share in [0.02, 0.1, 0.2] {
            let omega = std::f64::consts::TAU * share;
            let values: Vec<f64> = (0..200).map(|i| (omega * f64::from(i)).sin()).collect();
            let (first, second) = stencil(&values, 1.0);
            for i in 8..192 {
                let (s, c) = (omega * i as f64).sin_cos();
                assert!((first[i] - omega * c).abs() < 0.012 * omega, "{share}");
                assert!((second[i] + omega * omega * s).abs() < 0.012 * omega * omega, "{share}");
            }
        }
    }

    #[test]
    fn central_differences_are_exact_for_a_parabola_on_uneven_steps() {
        let time = [0.0, 0.1, 0.25, 0.3, 0.6];
        let values: Vec<f64> = time.iter().map(|t| 3.0 * t * t).collect();
        let slopes = central_differences(&time, &values);
        for i in 1..4 {
            assert!((slopes[i] - 6.0 * time[i]).abs() < 1e-12);
        }
        assert_eq!(central_differences(&[1.0], &[2.0]), [0.0]);
    }

    #[test]
    fn short_records_do_not_panic() {
        for n in 0..6 {
            let time: Vec<f64> = (0..n).map(f64::from).collect();
            assert_eq!(savitzky_golay(&time, &time, 7, 3).first.len(), time.len());
            assert_eq!(stencil(&time, 1.0).0.len(), time.len());
        }
    }

    #[test]
    fn cubic_interpolation_is_exact_for_a_parabola_and_held_at_the_ends() {
        let time = [0.0, 0.1, 0.25, 0.3, 0.6, 0.7];
        let values: Vec<f64> = time.iter().map(|t| 3.0 * t * t - t).collect();
        let wanted = [-1.0, 0.1, 0.17, 0.27, 0.3, 0.55, 2.0];
        let got = interpolate_cubic(&time, &values, &wanted);
        for (t, v) in wanted.iter().zip(&got).skip(1).take(5) {
            assert!((v - (3.0 * t * t - t)).abs() < 1e-12, "{t}: {v}");
        }
        assert!(got[0] == values[0] && (got[6] - values[5]).abs() < 1e-12);
        assert_eq!(interpolate_cubic(&[0.0, 1.0], &[0.0, 2.0], &[0.5]), [1.0]);
    }

    #[test]
    fn interpolation_hits_the_samples_and_the_middle() {
        let got = interpolate(&[0.0, 1.0, 3.0], &[0.0, 2.0, 6.0], &[-1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 9.0]);
        assert_eq!(got, [0.0, 0.0, 1.0, 2.0, 4.0, 6.0, 6.0]);
        assert_eq!(polynomial(&[0.0, 1.0, 2.0], &[1.0, 3.0, 5.0], 1).len(), 2);
    }
}
