//! Transforms of a sampled signal for plots: derivatives, a zero-phase low-pass, the integral, the signal without its
//! mean.
//!
//! Everything here is linear in the values, so the residual of a model may be transformed instead of both sides.
//! Not-a-number values stay so and spoil nothing but their neighbours: every segment between them is treated as a
//! signal of its own.

use super::derive::{central_differences, even_period, interpolate, interpolate_cubic};
use super::filter::low_pass;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Transform of a signal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Transform {
    /// The signal itself.
    #[default]
    None,
    /// Its rate of change.
    Derivative,
    /// The rate of change of that.
    SecondDerivative,
    /// The part below a cut-off, Hz (turns per sample without a clock).
    LowPass(f64),
    /// The area under it since the beginning.
    Integral,
    /// The signal less its mean.
    MinusMean,
}

impl Transform {
    /// The transformed signal, a value a sample. `times`: s, increasing, or sample numbers of a log without a clock: then a
    /// derivative is per sample.
    pub fn apply(self, times: &[f64], values: &[f64]) -> Vec<f64> {
        let n = values.len().min(times.len());
        let (times, values) = (&times[..n], &values[..n]);
        match self {
            Self::None => values.to_vec(),
            Self::MinusMean => {
                let mean = mean(values);
                values.iter().map(|v| v - mean).collect()
            }
            Self::Integral => integral(times, values),
            Self::Derivative => by_stretches(times, values, central_differences),
            Self::SecondDerivative => by_stretches(times, values, second_differences),
            Self::LowPass(cutoff_hz) => by_stretches(times, values, |t, v| smoothed(t, v, cutoff_hz)),
        }
    }

    /// Order of differentiation with respect to time; −1 for an integral.
    pub fn order(self) -> i32 {
        match self {
            Self::Derivative => 1,
            Self::SecondDerivative => 2,
            Self::Integral => -1,
            Self::None | Self::LowPass(_) | Self::MinusMean => 0,
        }
    }
}

/// Mean of the values that are numbers; 0 when there is none.
pub fn mean(values: &[f64]) -> f64 {
    let (sum, count) =
        values.iter().filter(|v| v.is_finite()).fold((0.0, 0_usize), |(sum, count), v| (sum + v, count + 1));
    if count == 0 { 0.0 } else { sum / count as f64 }
}

/// Treats every segment of finite values apart.
fn by_stretches(times: &[f64], values: &[f64], of: impl Fn(&[f64], &[f64]) -> Vec<f64>) -> Vec<f64> {
    let mut out = vec![f64::NAN; values.len()];
    for stretch in stretches(values) {
        out[stretch.clone()].copy_from_slice(&of(&times[stretch.clone()], &values[stretch]));
    }
    out
}

/// Segments of finite values.
fn stretches(values: &[f64]) -> Vec<Range<usize>> {
    let mut at = 0;
    let parts = values.chunk_by(|a, b| a.is_finite() == b.is_finite());
    let found = parts.map(|part| {
        at += part.len();
        (at - part.len()..at, part[0].is_finite())
    });
    found.filter(|(_, numbers)| *numbers).map(|(range, _)| range).collect()
}

/// The second derivative of the parabola through each three samples, also at uneven times; held at the ends.
fn second_differences(times: &[f64], values: &[f64]) -> Vec<f64> {
    let n = values.len();
    if n < 3 {
        return vec![0.0; n];
    }
    let slope = |i: usize| (values[i + 1] - values[i]) / (times[i + 1] - times[i]);
    let bend = |i: usize| 2.0 * (slope(i) - slope(i - 1)) / (times[i + 1] - times[i - 1]);
    (0..n).map(|i| bend(i.clamp(1, n - 2))).collect()
}

/// Zero-phase low-pass; uneven samples are filtered on an even grid of their mean rate.
fn smoothed(times: &[f64], values: &[f64], cutoff_hz: f64) -> Vec<f64> {
    let n = values.len();
    if n < 3 {
        return values.to_vec();
    }
    if let Some(period_s) = even_period(times) {
        return low_pass(values, 1.0 / period_s, cutoff_hz);
    }
    let period_s = (times[n - 1] - times[0]) / (n - 1) as f64;
    let grid: Vec<f64> = (0..n).map(|i| times[0] + i as f64 * period_s).collect();
    let even = low_pass(&interpolate(times, values, &grid), 1.0 / period_s, cutoff_hz);
    interpolate_cubic(&grid, &even, times)
}

/// Sum of trapezia from the first sample on; nothing is added across values that are not numbers.
fn integral(times: &[f64], values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    (0..values.len())
        .map(|i| {
            if i > 0 {
                let area = 0.5 * (values[i] + values[i - 1]) * (times[i] - times[i - 1]);
                sum += if area.is_finite() { area } else { 0.0 };
            }
            if values[i].is_finite() { sum } else { f64::NAN }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Uneven, with steps of 0.6 to 1.4 ms.
    fn uneven(n: usize) -> Vec<f64> {
        (0..n).map(|i| i as f64 * 1e-3 + 4e-4 * (i as f64).sin()).collect()
    }

    fn largest(a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn derivatives_of_a_parabola_are_exact_at_uneven_times() {
        let times = uneven(400);
        let values: Vec<f64> = times.iter().map(|t| 3.0 - 2.0 * t + 5.0 * t * t).collect();
        let first = Transform::Derivative.apply(&times, &values);
        let expected: Vec<f64> = times.iter().map(|t| -2.0 + 10.0 * t).collect();
        assert!(largest(&first[1..399], &expected[1..399]) < 1e-9);
        assert!(largest(&Transform::SecondDerivative.apply(&times, &values), &[10.0; 400]) < 1e-6);
    }

    #[test]
    fn without_a_clock_a_derivative_is_per_sample() {
        let samples: Vec<f64> = (0..50).map(f64::from).collect();
        let squares: Vec<f64> = samples.iter().map(|i| i * i).collect();
        let first = Transform::Derivative.apply(&samples, &squares);
        assert!((1..49).all(|i| first[i] == 2.0 * i as f64), "exact in whole numbers");
        assert!(Transform::SecondDerivative.apply(&samples, &squares).iter().all(|v| *v == 2.0));
        assert_eq!(Transform::Integral.apply(&samples, &[1.0; 50]), samples);
    }

    #[test]
    fn an_integral_undoes_a_derivative_up_to_its_start() {
        let times = uneven(5_000);
        let wave: Vec<f64> = times.iter().map(|t| (3.0 * t).sin()).collect();
        let back = Transform::Integral.apply(&times, &Transform::Derivative.apply(&times, &wave));
        assert!(largest(&back, &wave) < 1e-5);
    }

    #[test]
    fn a_low_pass_keeps_the_slow_halves_at_the_cut_off_and_shifts_nothing_at_uneven_times() {
        let times = uneven(6_000);
        for (frequency, kept) in [(1.0, 1.0), (10.0, 0.5), (60.0, 0.0)] {
            let wave: Vec<f64> = times.iter().map(|t| (TAU * frequency * t).sin()).collect();
            let expected: Vec<f64> = wave.iter().map(|v| kept * v).collect();
            let out = Transform::LowPass(10.0).apply(&times, &wave);
            let off = largest(&out[1_000..5_000], &expected[1_000..5_000]);
            assert!(off < 0.02, "{frequency} Hz: {off}");
        }
    }

    #[test]
    fn what_is_no_number_spoils_nothing_but_itself() {
        let times: Vec<f64> = (0..3_000).map(|i| f64::from(i) * 1e-3).collect();
        let mut values: Vec<f64> = times.iter().map(|t| 2.0 * t).collect();
        values[1_000] = f64::NAN;
        for transform in [
            Transform::Derivative,
            Transform::SecondDerivative,
            Transform::LowPass(20.0),
            Transform::Integral,
            Transform::MinusMean,
        ] {
            let out = transform.apply(&times, &values);
            let lost: Vec<usize> = (0..3_000).filter(|&i| !out[i].is_finite()).collect();
            assert_eq!(lost, [1_000], "{transform:?}");
        }
        let slope = Transform::Derivative.apply(&times, &values);
        assert!((slope[999] - 2.0).abs() < 1e-9 && (slope[1_001] - 2.0).abs() < 1e-9);
        assert!(mean(&Transform::MinusMean.apply(&times, &values)).abs() < 1e-12);
        assert!(Transform::Derivative.apply(&times, &[]).is_empty());
        assert_eq!(Transform::SecondDerivative.apply(&times, &[1.0, 2.0]), [0.0, 0.0]);
    }

    #[test]
    fn every_transform_is_linear() {
        let times = uneven(2_000);
        let a: Vec<f64> = times.iter().map(|t| (9.0 * t).sin()).collect();
        let b: Vec<f64> = times.iter().map(|t| (40.0 * t).cos() + t).collect();
        let difference: Vec<f64> = a.iter().zip(&b).map(|(a, b)| a - b).collect();
        for transform in [
            Transform::None,
            Transform::Derivative,
            Transform::SecondDerivative,
            Transform::LowPass(30.0),
            Transform::Integral,
            Transform::MinusMean,
        ] {
            let (of_a, of_b) = (transform.apply(&times, &a), transform.apply(&times, &b));
            let apart: Vec<f64> = of_a.iter().zip(&of_b).map(|(a, b)| a - b).collect();
            let scale = apart.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
            assert!(largest(&apart, &transform.apply(&times, &difference)) < 1e-9 * scale, "{transform:?}");
        }
    }
}
