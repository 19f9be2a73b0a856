//! Errors of a regression's values when the residual repeats with the motion.
//!
//! Equal strokes repeat the rounding of an encoder and every force that the model lacks: thirty of them tell no more than one.
//! Each stroke's share of the normal equations is then zero, so neither the influences nor a resampling of blocks sees the error.
//! The spectrum does. With the Fourier transforms x(f) of the regressors and r(f) of the residual, the covariance is
//! `(XᵀWX)⁻¹ Σ x(f) x(f)ᴴ |r(f)|² (XᵀWX)⁻¹ / n` (Hannan 1963, without smoothing over frequencies). A residual that repeats has its
//! power at the frequencies of the motion alone. The power that the fit takes there is given back (HC2, `MacKinnon` & White 1985).

use super::linear::LinearFit;
use super::long_run_variance::inflation;
use nalgebra::DMatrix;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Largest leverage by which the power at a frequency is corrected.
const LARGEST_LEVERAGE: f64 = 0.9;
/// Width of a spectral line that the length of the recording makes, over that of the product of two.
/// Derived: ∫ sinc² / ∫ sinc⁴.
const LINE: f64 = 1.5;
/// Probability that a residual without repetition is not taken for a repeated one.
const CERTAIN: f64 = 0.99;

/// Factor on the standard error of each value, at least 1: above it where the residual repeats with the motion.
///
/// `columns`: p regressors of n samples, `weights`: n (absent: all 1), as in the fit. All 1 if a value is not identified.
pub fn factors(fit: &LinearFit, columns: &[Vec<f64>], weights: Option<&[f64]>) -> Vec<f64> {
    let (n, p) = (fit.residuals.len(), columns.len());
    if n <= p || fit.normal_inverse.shape() != (p, p) || !fit.identified.iter().all(|i| *i) {
        return vec![1.0; p];
    }
    // Twice the length: the circle of the transform does not join the end to the start.
    let size = (2 * n).next_power_of_two();
    let mut planner = FftPlanner::new();
    let transform = planner.plan_fft_forward(size);
    let spectrum = |values: &[f64]| {
        let weighted = |(i, v): (usize, &f64)| Complex::new(v * weights.map_or(1.0, |w| w[i].max(0.0).sqrt()), 0.0);
        let mut transformed: Vec<Complex<f64>> = values.iter().enumerate().map(weighted).collect();
        transformed.resize(size, Complex::ZERO);
        transform.process(&mut transformed);
        transformed
    };
    let residual = spectrum(&fit.residuals);
    let columns: Vec<Vec<Complex<f64>>> = columns.iter().map(|column| spectrum(column)).collect();
    let mut sums = Sums { variance: vec![0.0; p], power: vec![0.0; p], squares: vec![0.0; p] };
    let (mut parts, mut influence) = (DMatrix::zeros(p, 2), DMatrix::zeros(p, 2));
    // The other half of a real sequence's spectrum mirrors this one.
    for (f, residual) in residual.iter().enumerate().take(size / 2 + 1) {
        for (j, column) in columns.iter().enumerate() {
            (parts[(j, 0)], parts[(j, 1)]) = (column[f].re, column[f].im);
        }
        fit.normal_inverse.mul_to(&parts, &mut influence);
        let count = if f == 0 || f == size / 2 { 1.0 } else { 2.0 };
        sums.add(&influence, parts.dot(&influence) / n as f64, residual.norm_sqr(), count);
    }
    (0..p).map(|j| sums.factor(j, fit.covariance[(j, j)], n as f64, size as f64)).collect()
}

/// Sums over the frequencies, one a value.
struct Sums {
    /// |a(f)|² |r(f)|² with the influence a = (XᵀWX)⁻¹ x.
    variance: Vec<f64>,
    /// |a(f)|².
    power: Vec<f64>,
    /// |a(f)|⁴.
    squares: Vec<f64>,
}

impl Sums {
    /// `influence`: real and imaginary parts, p x 2; `residual`: |r|²; `count` of equal frequencies.
    fn add(&mut self, influence: &DMatrix<f64>, leverage: f64, residual: f64, count: f64) {
        let residual = residual / (1.0 - leverage.clamp(0.0, LARGEST_LEVERAGE));
        for (j, parts) in influence.row_iter().enumerate() {
            let power = parts.norm_squared();
            self.variance[j] += count * power * residual;
            self.power[j] += count * power;
            self.squares[j] += count * power * power;
        }
    }

    fn factor(&self, j: usize, stated: f64, n: f64, size: f64) -> f64 {
        let variance = self.variance[j] / (n * size);
        let freedom = (self.power[j].powi(2) / self.squares[j] * n / (LINE * size)).max(1.0);
        let Ok(chance) = ChiSquared::new(freedom) else { return 1.0 };
        let is_repeated = variance > stated * chance.inverse_cdf(CERTAIN) / freedom;
        if is_repeated { (LINE * variance * inflation(freedom) / stated).sqrt() } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::regression::linear::least_squares;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    const STROKES: usize = 30;
    const ROWS: usize = 150;
    const TRIALS: u32 = 300;

    /// Shares of 300 trials: intervals that hold both values without and with the factors, and values that are widened.
    /// `repeated`: each stroke has the same noise.
    fn held(repeated: bool) -> [f64; 3] {
        let mut rng = StdRng::seed_from_u64(45);
        let place = |i: usize| std::f64::consts::TAU * (i % ROWS) as f64 / ROWS as f64;
        let columns: Vec<Vec<f64>> = [0.0, 2.0]
            .map(|shift| {
                let wave =
                    |i: usize| (1..6).map(|k: i32| (f64::from(k) * place(i) + shift * f64::from(k * k)).sin()).sum();
                (0..STROKES * ROWS).map(wave).collect()
            })
            .into();
        let mut counts = [0.0; 3];
        for _ in 0..TRIALS {
            let noise: Vec<f64> = (0..STROKES * ROWS).map(|_| rng.sample(StandardNormal)).collect();
            let noise_of = |i: usize| noise[if repeated { i % ROWS } else { i }];
            let rhs: Vec<f64> =
                (0..STROKES * ROWS).map(|i| 1.5 * columns[0][i] + 2.0 * columns[1][i] + noise_of(i)).collect();
            let fit = least_squares(&columns, &rhs, None).expect("solves");
            for (j, factor) in factors(&fit, &columns, None).into_iter().enumerate() {
                let off = (fit.values[j] - [1.5, 2.0][j]).abs() / (1.96 * fit.std_errors[j]);
                let count = 2.0 * f64::from(TRIALS);
                counts[0] += f64::from(u8::from(off < 1.0)) / count;
                counts[1] += f64::from(u8::from(off < factor)) / count;
                counts[2] += f64::from(u8::from(factor > 1.0)) / count;
            }
        }
        counts
    }

    #[test]
    fn equal_strokes_with_equal_noise_tell_no_more_than_one() {
        let [before, after, _] = held(true);
        println!("{before} hold before, {after} after");
        assert!(before < 0.4 && after > 0.85, "{before} {after}");
    }

    #[test]
    fn independent_noise_is_not_taken_for_a_repeated_one() {
        let [before, after, widened] = held(false);
        println!("{before} hold before, {after} after, {widened} widened");
        assert!(before > 0.92 && after < 0.98 && widened < 0.03, "{before} {after} {widened}");
    }
}
