//! The long-run variance of a sum of correlated numbers, from an autoregressive model of the series.
//!
//! Residuals of a mechanical log are never white. A sum over n of them has n times their *long-run* variance, the
//! spectral density at frequency zero, not n times their variance. It comes from an autoregression fitted to the series
//! (Berk 1974; den Haan and Levin 1998): σ²/(1 − Σ aₖ)². Its order is the one with the least BIC, but never zero: a
//! negative test for correlation is no proof that there is none, and intervals after such a test are too short. The
//! estimated sum of the coefficients is low by about (1 + 3 Σ aₖ)/n (Kendall 1954), which is added back.

use statrs::distribution::{ContinuousCDF, StudentsT};

/// Largest order of the autoregression that is tried; no more than a tenth of the samples either.
const LARGEST_ORDER: usize = 6;
/// Half width of a 95 % interval, in standard errors: `value ± 1.96 std_error` everywhere.
/// Derived: the 97.5 % quantile of the normal distribution in two decimals.
pub const HALF_INTERVAL: f64 = 1.96;
/// 97.5 % quantile of the normal distribution.
/// Derived: Φ⁻¹(0.975).
pub(super) const NORMAL_975: f64 = 1.959_963_984_540_054;

/// The long-run variance of one series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LongRun {
    /// Variance of the sum of the series.
    pub variance_of_sum: f64,
    /// Degrees of freedom that this variance is known with: how wide Student's t must be.
    pub freedom: f64,
    /// Long-run variance over the variance of one sample: how many samples amount to one independent one.
    pub correlation_time: f64,
}

/// Long-run variance of a series of mean zero.
///
/// Degenerate: fewer than three entries or all zero count as white.
pub fn long_run(series: &[f64]) -> LongRun {
    let n = series.len();
    let count = n as f64;
    let power: f64 = series.iter().map(|v| v * v).sum();
    if n < 3 || power <= 0.0 {
        return LongRun { variance_of_sum: power, freedom: (count - 1.0).max(1.0), correlation_time: 1.0 };
    }
    let highest = LARGEST_ORDER.min(n / 10).max(1);
    let covariance = |lag: usize| series.iter().zip(&series[lag..]).map(|(a, b)| a * b).sum::<f64>() / count;
    let lags: Vec<f64> = (0..=highest).map(covariance).collect();
    let (order, innovation, sum) = autoregression(&lags, count);
    let sum = (sum + (1.0 + 3.0 * sum) / count).min(1.0 - 1.5 / count);
    let innovation = innovation * count / (count - order as f64 - 1.0).max(1.0);
    let variance = innovation / (1.0 - sum).powi(2);
    let persistence = ((1.0 + sum) / (1.0 - sum)).max(1.0);
    // ln(variance) scatters by that of σ² (2/n) and by twice that of Σ a over 1 − Σ a: together about 6/n times the persistence.
    let freedom = (count / (3.0 * persistence)).max(3.0);
    LongRun { variance_of_sum: count * variance, freedom, correlation_time: (variance * count / power).max(1.0) }
}

/// Levinson's recursion; the order of least BIC among 1 … with its innovation variance and the sum of its coefficients.
fn autoregression(lags: &[f64], count: f64) -> (usize, f64, f64) {
    let mut coefficients: Vec<f64> = Vec::new();
    let mut innovation = lags[0];
    let mut best = (f64::INFINITY, 1, innovation, 0.0);
    for order in 1..lags.len() {
        let predicted: f64 = coefficients.iter().zip(lags[1..order].iter().rev()).map(|(a, r)| a * r).sum();
        let reflection = (lags[order] - predicted) / innovation;
        let before = coefficients.clone();
        for (a, b) in coefficients.iter_mut().zip(before.iter().rev()) {
            *a -= reflection * b;
        }
        coefficients.push(reflection);
        innovation *= (1.0 - reflection * reflection).max(1e-12);
        let bic = count * innovation.ln() + order as f64 * count.ln();
        if bic < best.0 {
            best = (bic, order, innovation, coefficients.iter().sum());
        }
    }
    (best.1, best.2, best.3)
}

/// Factor on the square of a standard error so that 1.96 of it cover as much as Student's t with `freedom` degrees.
pub fn inflation(freedom: f64) -> f64 {
    (student_quantile_975(freedom) / NORMAL_975).powi(2)
}

/// 97.5 % quantile of Student's t with `freedom` degrees (≥ 1).
pub fn student_quantile_975(freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom.max(1.0)).map_or(NORMAL_975, |t| t.inverse_cdf(0.975))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    #[test]
    fn an_autoregression_has_the_long_run_variance_of_its_formula() {
        let mut rng = StdRng::seed_from_u64(9);
        for rho in [0.0_f64, 0.5, 0.9, -0.5] {
            let mut state = 0.0;
            let series: Vec<f64> = (0..40_000)
                .map(|_| {
                    let shock: f64 = rng.sample(StandardNormal);
                    state = rho * state + shock;
                    state
                })
                .collect();
            let found = long_run(&series).variance_of_sum / 40_000.0;
            let expected = (1.0 - rho).powi(-2);
            assert!((found / expected - 1.0).abs() < 0.12, "{rho}: {found} against {expected}");
        }
    }

    #[test]
    fn a_second_order_swing_is_seen_too() {
        // x = 1.6 x₋₁ − 0.8 x₋₂ + e swings; its long-run variance is 1/(1 − 0.8)² = 25, its variance much more than that of e.
        let mut rng = StdRng::seed_from_u64(10);
        let (mut a, mut b) = (0.0, 0.0);
        let series: Vec<f64> = (0..40_000)
            .map(|_| {
                let shock: f64 = rng.sample(StandardNormal);
                (a, b) = (1.6 * a - 0.8 * b + shock, a);
                a
            })
            .collect();
        let found = long_run(&series).variance_of_sum / 40_000.0;
        assert!((found / 25.0 - 1.0).abs() < 0.15, "{found}");
    }

    #[test]
    fn short_and_empty_series_do_not_panic() {
        for n in 0..6 {
            let found = long_run(&vec![1.0; n]);
            assert!(found.variance_of_sum.is_finite() && found.freedom >= 1.0);
        }
        assert_eq!(long_run(&[0.0; 50]).variance_of_sum, 0.0);
    }
}
