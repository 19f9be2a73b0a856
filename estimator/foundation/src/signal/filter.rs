//! Zero-phase low-pass filtering and decimation. One filter for every channel: different ones create fake delay and inertia.

use std::f64::consts::PI;

/// A second-order section: `b0 b1 b2 a1 a2`, a0 = 1.
#[derive(Clone, Copy, Debug)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

/// Fourth-order Butterworth low-pass as two sections through the bilinear transform (Oppenheim & Schafer, §7.2), with the
/// cut-off pre-warped.
fn butterworth(cutoff_hz: f64, rate_hz: f64) -> [Section; 2] {
    let k = (PI * cutoff_hz / rate_hz).tan();
    // Pole angles of the fourth-order Butterworth polynomial.
    [PI / 8.0, 3.0 * PI / 8.0].map(|angle| {
        let damping = 2.0 * angle.cos();
        let norm = 1.0 / (1.0 + damping * k + k * k);
        Section {
            b: [k * k * norm, 2.0 * k * k * norm, k * k * norm],
            a: [2.0 * (k * k - 1.0) * norm, (1.0 - damping * k + k * k) * norm],
        }
    })
}

impl Section {
    /// Filters in place, starting in the steady state of a constant input `values[0]` (transposed direct form II).
    fn run(&self, values: &mut [f64]) {
        let Some(&first) = values.first() else { return };
        let [b0, b1, b2] = self.b;
        let [a1, a2] = self.a;
        // Unity gain at zero frequency: the steady output equals the input.
        let mut s2 = (b2 - a2) * first;
        let mut s1 = (b1 - a1) * first + s2;
        for value in values {
            let input = *value;
            let output = b0 * input + s1;
            s1 = b1 * input - a1 * output + s2;
            s2 = b2 * input - a2 * output;
            *value = output;
        }
    }
}

/// Highest usable cut-off as a share of the sampling rate: the stencils that follow are accurate to here.
pub const MAX_CUTOFF_SHARE: f64 = 0.2;

/// Zero-phase low-pass: fourth-order Butterworth forward and backward (−6 dB at `cutoff_hz`), with the ends continued by
/// their point reflection over three filter lengths (Gustafsson 1996 discusses the choice).
///
/// `values`: n samples at `rate_hz`. A cut-off at or above 0.45 of the rate returns the samples as they are.
pub fn low_pass(values: &[f64], rate_hz: f64, cutoff_hz: f64) -> Vec<f64> {
    let n = values.len();
    // Written so that a NaN lands here too.
    let usable = cutoff_hz > 0.0 && cutoff_hz < 0.45 * rate_hz;
    if n < 2 || !usable {
        return values.to_vec();
    }
    let pad = (2 * edge_samples(rate_hz, cutoff_hz)).min(n - 1);
    let mut work = Vec::with_capacity(n + 2 * pad);
    work.extend((1..=pad).rev().map(|i| 2.0 * values[0] - values[i]));
    work.extend_from_slice(values);
    work.extend((1..=pad).map(|i| 2.0 * values[n - 1] - values[n - 1 - i]));
    let sections = butterworth(cutoff_hz, rate_hz);
    for _ in 0..2 {
        for section in &sections {
            section.run(&mut work);
        }
        work.reverse();
    }
    work[pad..pad + n].to_vec()
}

/// Samples at each end that the continuation of the signal may have touched noticeably: 1.5 periods of the cut-off.
pub fn edge_samples(rate_hz: f64, cutoff_hz: f64) -> usize {
    (1.5 * rate_hz / cutoff_hz).ceil() as usize
}

/// Ratio of the noise variance after [`low_pass`] to the variance of the white noise before.
pub fn white_noise_gain(rate_hz: f64, cutoff_hz: f64) -> f64 {
    // ∫ df / (1 + (f/fc)^8)² = fc · 7π/(64 sin(π/8)), of a band of rate/2.
    let width = cutoff_hz * 7.0 * PI / (64.0 * (PI / 8.0).sin());
    (2.0 * width / rate_hz).min(1.0)
}

/// Points of the numerical integral in [`derivative_noise`]: exact to 1e-4.
const NOISE_POINTS: u32 = 400;

/// Variance of the `order`-th time derivative of unit white noise after [`low_pass`], in 1/s^(2 order). It is the power
/// density 2/rate times the squared gains of the filter, 1/(1 + x⁸), and of the derivative, (2πf)^order, summed over
/// all frequencies.
pub fn derivative_noise(rate_hz: f64, cutoff_hz: f64, order: i32) -> f64 {
    let usable = cutoff_hz > 0.0 && cutoff_hz < 0.45 * rate_hz;
    // Beyond four cut-offs the filter leaves 1e-9 of the power.
    let top = if usable { (4.0 * cutoff_hz).min(0.5 * rate_hz) } else { 0.5 * rate_hz };
    let step = top / f64::from(NOISE_POINTS);
    let power = |k: u32| {
        let frequency = (f64::from(k) + 0.5) * step;
        // The bilinear transform bends the frequency axis.
        let x = (PI * frequency / rate_hz).tan() / (PI * cutoff_hz / rate_hz).tan();
        let gain = if usable { 1.0 / (1.0 + x.powi(8)) } else { 1.0 };
        (gain * (2.0 * PI * frequency).powi(order)).powi(2)
    };
    2.0 / rate_hz * step * (0..NOISE_POINTS).map(power).sum::<f64>()
}

/// Mean of each block of `factor` samples; an incomplete last block is dropped. Zero phase about the block's middle.
pub fn decimate(values: &[f64], factor: usize) -> Vec<f64> {
    let factor = factor.max(1);
    values.chunks_exact(factor).map(|block| block.iter().sum::<f64>() / factor as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tone(n: usize, frequency: f64) -> Vec<f64> {
        (0..n).map(|i| (2.0 * PI * frequency * i as f64 / 1000.0 + 0.3).sin()).collect()
    }

    #[test]
    fn passes_slow_halves_at_the_cutoff_and_stops_fast_without_delay() {
        for (frequency, expected) in [(2.0, 1.0), (20.0, 0.5), (100.0, 0.0)] {
            let input = tone(4000, frequency);
            let output = low_pass(&input, 1000.0, 20.0);
            for i in 1000..3000 {
                assert!((output[i] - expected * input[i]).abs() < 2e-3, "{frequency} Hz at {i}");
            }
        }
    }

    #[test]
    fn a_line_passes_untouched_up_to_the_ends() {
        let line: Vec<f64> = (0..500).map(|i| 3.0 - 0.01 * f64::from(i)).collect();
        let output = low_pass(&line, 1000.0, 15.0);
        let worst = line.iter().zip(&output).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-4, "{worst}");
    }

    #[test]
    fn short_and_odd_inputs_do_not_panic() {
        assert!(low_pass(&[], 100.0, 10.0).is_empty());
        assert_eq!(low_pass(&[1.0, 2.0], 100.0, 60.0), [1.0, 2.0]);
        assert_eq!(low_pass(&[1.0, 1.0, 1.0], 100.0, f64::NAN), [1.0, 1.0, 1.0]);
        assert_eq!(low_pass(&[5.0; 7], 100.0, 1.0).len(), 7);
        assert_eq!(decimate(&[1.0, 3.0, 5.0, 7.0, 9.0], 2), [2.0, 6.0]);
    }

    #[test]
    fn the_noise_of_derivatives_is_that_of_filter_and_stencil() {
        use rand::{RngExt as _, SeedableRng as _};
        let mut rng = rand::rngs::StdRng::seed_from_u64(4);
        let noise: Vec<f64> = (0..200_000).map(|_| rng.sample::<f64, _>(rand_distr::StandardNormal)).collect();
        let (first, second) = crate::signal::derive::stencil(&low_pass(&noise, 1000.0, 50.0), 1e-3);
        for (order, derived) in [(1, first), (2, second)] {
            let power = derived.iter().map(|v| v * v).sum::<f64>() / derived.len() as f64;
            let expected = derivative_noise(1000.0, 50.0, order);
            assert!((power / expected - 1.0).abs() < 0.05, "{order}: {power} against {expected}");
        }
        assert!((derivative_noise(1000.0, 50.0, 0) / white_noise_gain(1000.0, 50.0) - 1.0).abs() < 0.02);
    }

    #[test]
    fn the_noise_gain_is_that_of_the_filter() {
        // White noise from a fixed chaotic map would be correlated; a seeded generator is not.
        use rand::{RngExt as _, SeedableRng as _};
        let mut rng = rand::rngs::StdRng::seed_from_u64(3);
        let noise: Vec<f64> = (0..200_000).map(|_| rng.sample::<f64, _>(rand_distr::StandardNormal)).collect();
        let filtered = low_pass(&noise, 1000.0, 50.0);
        let power = filtered.iter().map(|v| v * v).sum::<f64>() / filtered.len() as f64;
        let expected = white_noise_gain(1000.0, 50.0);
        assert!((power / expected - 1.0).abs() < 0.05, "{power} against {expected}");
    }
}
