//! Noise of a channel, from its own high-frequency part.

use std::f64::consts::PI;

/// Coefficients of the fourth difference.
const FOURTH: [f64; 5] = [1.0, -4.0, 6.0, -4.0, 1.0];
/// Sum of the squares of [`FOURTH`].
/// Derived: 1² + 4² + 6² + 4² + 1².
const FOURTH_POWER: f64 = 70.0;
/// Median absolute deviation of a normal variable with unit variance.
const NORMAL_MAD: f64 = 0.674_489_750_196_081_7;

/// Standard deviation of the white part of the noise: median size of the fourth differences, robust against motion,
/// impacts and outliers. Never below the value that the channel's quantum implies (q/√12).
///
/// `values`: n samples, evenly spaced. Fewer than 8 samples give 0.
pub fn white_noise(values: &[f64]) -> f64 {
    if values.len() < 8 {
        return 0.0;
    }
    let mut sizes: Vec<f64> =
        values.windows(5).map(|w| w.iter().zip(FOURTH).map(|(v, c)| v * c).sum::<f64>().abs()).collect();
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    let spread = *median / (NORMAL_MAD * FOURTH_POWER.sqrt());
    spread.max(quantum(values) / 12.0_f64.sqrt())
}

/// Coefficients of the eighth difference; their squares sum to 12870.
const EIGHTH: [f64; 9] = [1.0, -8.0, 28.0, -56.0, 70.0, -56.0, 28.0, -8.0, 1.0];
const EIGHTH_POWER: f64 = 12_870.0;
/// The eighth differences are believed when they show less than this share: otherwise the two only scatter.
const CLEARLY_LESS: f64 = 0.8;

/// [`white_noise`], also where the motion is fast for the sampling rate: fourth differences of a 2 Hz motion at 20 Hz are mostly
/// motion, eighth differences are not.
pub fn white_noise_under_fast_motion(values: &[f64]) -> f64 {
    let fourth = white_noise(values);
    if values.len() < 24 {
        return fourth;
    }
    let mut sizes: Vec<f64> =
        values.windows(9).map(|w| w.iter().zip(EIGHTH).map(|(v, c)| v * c).sum::<f64>().abs()).collect();
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    let eighth = (*median / (NORMAL_MAD * EIGHTH_POWER.sqrt())).max(quantum(values) / 12.0_f64.sqrt());
    if eighth < CLEARLY_LESS * fourth { eighth } else { fourth }
}

/// The same for samples at uneven times: each one against the cubic through its two neighbours on either side, in units
/// of that difference for unit noise.
pub fn white_noise_uneven(time_s: &[f64], values: &[f64]) -> f64 {
    let n = values.len().min(time_s.len());
    if n < 8 {
        return 0.0;
    }
    let difference = |i: usize| {
        let others = [i - 2, i - 1, i + 1, i + 2];
        let weight = |j: usize| -> f64 {
            let rest = others.iter().filter(|&&k| k != j);
            rest.map(|&k| (time_s[i] - time_s[k]) / (time_s[j] - time_s[k])).product()
        };
        let weights = others.map(weight);
        let guess: f64 = weights.iter().zip(others).map(|(w, j)| w * values[j]).sum();
        (values[i] - guess).abs() / (1.0 + weights.iter().map(|w| w * w).sum::<f64>()).sqrt()
    };
    let mut sizes: Vec<f64> = (2..n - 2).map(difference).collect();
    let middle = sizes.len() / 2;
    let (_, median, _) = sizes.select_nth_unstable_by(middle, f64::total_cmp);
    (*median / NORMAL_MAD).max(quantum(values) / 12.0_f64.sqrt())
}

/// Smallest step between different neighbouring samples when the channel is quantised, else 0.
///
/// A channel counts as quantised when a tenth of its steps or more are multiples of the smallest one up to five times, zero
/// included.
pub fn quantum(values: &[f64]) -> f64 {
    let steps = || values.windows(2).map(|w| (w[1] - w[0]).abs());
    let scale = values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let floor = 1e-12 * scale;
    let smallest = steps().filter(|&s| s > floor).fold(f64::INFINITY, f64::min);
    if !smallest.is_finite() {
        return 0.0;
    }
    let on_grid = steps()
        .filter(|&s| {
            let multiple = (s / smallest).round();
            multiple <= 5.0 && (s - multiple * smallest).abs() <= 1e-3 * smallest + floor
        })
        .count();
    if 10 * on_grid >= values.len() { smallest } else { 0.0 }
}

/// Standard deviation of the mean of a channel at rest by resolution alone, in the channel's unit.
///
/// The mean of a signal that is rounded to steps of `step` is off by at most half a step, unless noise carries it over
/// several steps. Dither of standard deviation σ leaves the variance Σₖ `step²`/(2π²k²) exp(−4π²k²σ²/`step²`), averaged
/// over the place of the signal in the step (Widrow & Kollár 2008, ch. 4: the characteristic function at multiples of
/// 2π/`step`). Without noise this is `step²`/12. `noise`: standard deviation of the channel from [`white_noise`],
/// rounding included.
pub fn resolution_error(step: f64, noise: f64) -> f64 {
    const HARMONICS: u32 = 40;
    if step <= 0.0 {
        return 0.0;
    }
    let dither = (noise * noise - step * step / 12.0).max(0.0) / (step * step);
    let harmonic = |k: u32| {
        let order = (PI * f64::from(k)).powi(2);
        (-4.0 * order * dither).exp() / (2.0 * order)
    };
    step * (1..=HARMONICS).map(harmonic).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    #[test]
    fn finds_the_noise_under_a_motion_with_outliers() {
        let mut rng = StdRng::seed_from_u64(1);
        let mut values: Vec<f64> =
            (0..5000).map(|i| (f64::from(i) * 0.01).sin() + 0.002 * rng.sample::<f64, _>(StandardNormal)).collect();
        values[100] += 1.0;
        let sigma = white_noise(&values);
        assert!((sigma / 0.002 - 1.0).abs() < 0.08, "{sigma}");
    }

    #[test]
    fn a_motion_fast_for_its_rate_is_not_noise() {
        let mut rng = StdRng::seed_from_u64(5);
        let values: Vec<f64> =
            (0..400).map(|i| (0.63 * f64::from(i)).sin() + 1e-3 * rng.sample::<f64, _>(StandardNormal)).collect();
        assert!(white_noise(&values) > 5e-3, "fourth differences see the motion");
        let sigma = white_noise_under_fast_motion(&values);
        assert!((sigma / 1e-3 - 1.0).abs() < 0.25, "{sigma}");
    }

    #[test]
    fn uneven_times_do_not_hide_or_make_noise() {
        let mut rng = StdRng::seed_from_u64(2);
        let mut now = 0.0;
        let time: Vec<f64> = (0..5000)
            .map(|_| {
                now += 0.01 * (0.5 + rng.random::<f64>());
                now
            })
            .collect();
        let moving: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        assert!(white_noise_uneven(&time, &moving) < 1e-7);
        let noisy: Vec<f64> = moving.iter().map(|v| v + 0.002 * rng.sample::<f64, _>(StandardNormal)).collect();
        let sigma = white_noise_uneven(&time, &noisy);
        assert!((sigma / 0.002 - 1.0).abs() < 0.08, "{sigma}");
    }

    #[test]
    fn dither_takes_the_resolution_out_of_a_mean() {
        let step = 0.01;
        assert!((resolution_error(step, step / 12.0_f64.sqrt()) / (step / 12.0_f64.sqrt()) - 1.0).abs() < 0.02);
        let mut rng = StdRng::seed_from_u64(8);
        for share in [0.1, 0.2, 0.3, 0.45] {
            // The mean of many rounded noisy samples, at many places within a step.
            let mut squares = 0.0;
            for place in 0..50 {
                let value = step * f64::from(place) / 50.0;
                let sum: f64 = (0..40_000)
                    .map(|_| {
                        ((value + share * step * rng.sample::<f64, _>(StandardNormal)) / step).round() * step - value
                    })
                    .sum();
                squares += (sum / 40_000.0).powi(2);
            }
            let seen = (squares / 50.0).sqrt();
            let expected = resolution_error(step, step * (share * share + 1.0 / 12.0).sqrt());
            // The mean of this number of samples scatters by share · step / 200 itself.
            assert!((seen - expected).abs() < 0.05 * expected + 0.004 * step, "{share}: {seen} against {expected}");
        }
    }

    #[test]
    fn a_quantised_ramp_has_the_noise_of_its_quantum() {
        let values: Vec<f64> = (0..2000).map(|i| (f64::from(i) * 0.0137).round() * 0.05).collect();
        assert!((quantum(&values) - 0.05).abs() < 1e-12);
        assert!(white_noise(&values) >= 0.0499 / 12.0_f64.sqrt());
        assert_eq!(white_noise(&[0.0; 3]), 0.0);
        assert_eq!(quantum(&[1.0; 9]), 0.0);
    }
}
