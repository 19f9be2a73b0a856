//! Weighted linear least squares with an honest covariance.
//!
//! Solved through QR and the singular values of R with columns scaled to unit norm (Golub & Van Loan, §5.3, §5.5). The
//! residuals of a mechanical log are never white, so a parameter's error comes from the long-run variance of its influence: the
//! series of what every sample adds to its value (see [`super::influence`] and [`super::long_run_variance`]).

use super::influence::Solved;
use super::long_run_variance::inflation;
use foundation::cancellation;
use foundation::estimate::EstimateError;
use nalgebra::{DMatrix, DVector};

/// Share of the largest singular value (columns scaled to 1) below which one counts as zero: the direction is not
/// excited.
const RANK_TOLERANCE: f64 = 1e-9;
/// Largest loading of an identified parameter on a lost direction.
const LOADING_TOLERANCE: f64 = 1e-4;

/// The answer of [`least_squares`].
#[derive(Clone, Debug)]
pub struct LinearFit {
    /// One value a column; 0 where not identified.
    pub values: Vec<f64>,
    /// Covariance of the values, p × p, with autocorrelation and small samples counted in; infinite on the diagonal of a
    /// parameter that is not identified.
    pub covariance: DMatrix<f64>,
    /// Square roots of the covariance's diagonal.
    pub std_errors: Vec<f64>,
    /// `rhs − columns · values`, unweighted, one a sample.
    pub residuals: Vec<f64>,
    /// Ratio of the largest to the smallest singular value of the scaled columns; infinite when a direction is lost.
    pub condition: f64,
    /// Root mean square of the residuals, weighted.
    pub rms: f64,
    /// False for a parameter that the data do not excite, or only together with another one.
    pub identified: Vec<bool>,
    /// Number of independent samples in the residuals.
    pub effective_samples: f64,
    /// Inverse (pseudo-inverse) of the normal matrix `Σ wᵢ xᵢ xᵢᵀ`, in the columns' own units.
    pub normal_inverse: DMatrix<f64>,
}

/// Minimises Σ wᵢ (rhsᵢ − Σⱼ columns[j][i] valuesⱼ)².
///
/// `columns`: p regressors of n samples; `weights`: n numbers ≥ 0, inverse variances up to a factor (absent: all 1). A
/// sample of zero weight does not count. Degenerate: fewer weighted samples than regressors is an error; a zero or
/// dependent regressor is not, its parameter comes back as not identified. Every fit passes here: an unwanted one ends
/// ([`wanted`]).
pub fn least_squares(columns: &[Vec<f64>], rhs: &[f64], weights: Option<&[f64]>) -> Result<LinearFit, EstimateError> {
    Ok(least_squares_values(columns, rhs, weights)?.with_errors(columns, weights))
}

/// Result of [`least_squares`] without the errors: their computation takes most of its time, and a search for a shape
/// needs them only at its end.
#[derive(Clone, Debug)]
pub struct Values {
    /// As in [`LinearFit`].
    pub values: Vec<f64>,
    /// As in [`LinearFit`].
    pub residuals: Vec<f64>,
    /// As in [`LinearFit`].
    pub condition: f64,
    /// As in [`LinearFit`].
    pub rms: f64,
    /// As in [`LinearFit`].
    pub identified: Vec<bool>,
    /// Norms of the weighted columns.
    scales: Vec<f64>,
    /// Inverse of the normal matrix of the scaled columns.
    inverse: DMatrix<f64>,
    /// Samples of a weight above zero.
    used: usize,
}

/// The values alone of [`least_squares`], to the bit.
pub fn least_squares_values(
    columns: &[Vec<f64>],
    rhs: &[f64],
    weights: Option<&[f64]>,
) -> Result<Values, EstimateError> {
    cancellation::check()?;
    check(columns, rhs, weights)?;
    let (n, p) = (rhs.len(), columns.len());
    let root = |i: usize| weights.map_or(1.0, |w| w[i].max(0.0).sqrt());
    let used = (0..n).filter(|&i| root(i) > 0.0).count();
    if used < p.max(1) {
        return Err(EstimateError::TooFewSamples {
            recording: "the fit".to_owned(),
            samples: used,
            what: format!(" for {p} parameters"),
            needed: p.max(1),
        });
    }
    let scales: Vec<f64> = columns
        .iter()
        .map(|c| (0..n).map(|i| (c[i] * root(i)).powi(2)).sum::<f64>().sqrt())
        .map(|norm| if norm > 0.0 { norm } else { 1.0 })
        .collect();
    let design = DMatrix::from_fn(n, p, |i, j| columns[j][i] * root(i) / scales[j]);
    let target = DVector::from_fn(n, |i, _| rhs[i] * root(i));
    let Solution { values: scaled_values, inverse, condition, identified } = solve(design, &target)?;

    let values: Vec<f64> = (0..p).map(|j| if identified[j] { scaled_values[j] / scales[j] } else { 0.0 }).collect();
    // Residuals belong to the full minimum-norm solution, also when single parameters cannot be told apart.
    let residual = |i: usize| rhs[i] - (0..p).map(|j| columns[j][i] * scaled_values[j] / scales[j]).sum::<f64>();
    let residuals: Vec<f64> = (0..n).map(residual).collect();
    let weight = |i: usize| weights.map_or(1.0, |w| w[i].max(0.0));
    let weight_sum: f64 = (0..n).map(weight).sum();
    let rms = ((0..n).map(|i| weight(i) * residuals[i].powi(2)).sum::<f64>() / weight_sum).sqrt();
    Ok(Values { values, residuals, condition, rms, identified, scales, inverse, used })
}

impl Values {
    /// The whole answer; `columns` and `weights` are those that the values came from.
    #[must_use]
    pub fn with_errors(self, columns: &[Vec<f64>], weights: Option<&[f64]>) -> LinearFit {
        let Self { values, residuals, condition, rms, identified, scales, inverse, used } = self;
        let p = columns.len();
        let solved = Solved { columns, scales: &scales, weights, residuals: &residuals, inverse: &inverse };
        let (mut covariance, correlation) = solved.covariance();
        let effective_samples = (used as f64 / correlation).clamp(1.0, used as f64);
        // Never below the variance of independent samples: an estimate of the correlation from few of them scatters.
        let freedom = (used as f64 - p as f64).max(1.0);
        let variance = weight_sum_of_squares(&residuals, weights) / freedom * inflation(freedom);
        let raise = |j: usize| (inverse[(j, j)] * variance / covariance[(j, j)]).max(1.0).sqrt();
        let raise: Vec<f64> = (0..p).map(raise).map(finite_or_one).collect();
        for (i, j) in (0..p).flat_map(|i| (0..p).map(move |j| (i, j))) {
            covariance[(i, j)] *= raise[i] * raise[j];
        }
        for (i, j) in (0..p).flat_map(|i| (0..p).map(move |j| (i, j))) {
            covariance[(i, j)] /= scales[i] * scales[j];
            if !(identified[i] && identified[j]) {
                covariance[(i, j)] = if i == j { f64::INFINITY } else { 0.0 };
            }
        }
        let std_errors = (0..p).map(|j| covariance[(j, j)].max(0.0).sqrt()).collect();
        let normal_inverse = DMatrix::from_fn(p, p, |i, j| inverse[(i, j)] / (scales[i] * scales[j]));
        LinearFit {
            values,
            covariance,
            std_errors,
            residuals,
            condition,
            rms,
            identified,
            effective_samples,
            normal_inverse,
        }
    }
}

/// Relative uncertainty of the noise in the columns (a white level read from its upper band).
pub const COLUMN_NOISE_UNCERTAINTY: f64 = 0.25;
/// Share of noise in the own part of a regressor above which it is not corrected: the correction would amplify errors.
const CORRECTABLE: f64 = 0.5;

impl LinearFit {
    /// Adds independent errors (one standard deviation a parameter) to the covariance; parameters beyond `errors` keep theirs.
    pub fn widen(&mut self, errors: &[f64]) {
        for (j, error) in errors.iter().enumerate().take(self.values.len()) {
            self.covariance[(j, j)] += error * error;
            self.std_errors[j] = self.covariance[(j, j)].max(0.0).sqrt();
        }
    }

    /// Multiplies the error of each value, and keeps the correlations.
    pub fn scale_errors(&mut self, factors: &[f64]) {
        let p = self.values.len();
        self.covariance = DMatrix::from_fn(p, p, |i, j| self.covariance[(i, j)] * factors[i] * factors[j]);
        self.std_errors.iter_mut().zip(factors).for_each(|(error, factor)| *error *= factor);
    }

    /// Takes out the attenuation by noise in the regressors (errors in variables, Fuller 1987, §2.2). The normal matrix
    /// is larger than that of the true regressors by `noise`, `Σ wᵢ E[eᵢ eᵢᵀ]`, which is known to the share
    /// `known_to`. This share of the correction joins the errors. With noise too large to be taken out, the values stay
    /// and all of it joins the errors.
    #[must_use]
    pub fn without_attenuation(mut self, noise: &DMatrix<f64>, known_to: f64) -> Self {
        let p = self.values.len();
        if noise.shape() != (p, p) || self.normal_inverse.shape() != (p, p) || !self.identified.iter().all(|i| *i) {
            return self;
        }
        let values = DVector::from_column_slice(&self.values);
        let loss = &self.normal_inverse * noise;
        // Its trace sums the shares of noise in the own parts of the regressors.
        let correctable = loss.trace().abs() < CORRECTABLE;
        let regained = if correctable { (DMatrix::identity(p, p) - &loss).try_inverse() } else { None };
        let (change, known_to) = match &regained {
            Some(regained) => (regained * &values - &values, known_to),
            None => (&loss * &values, 1.0),
        };
        if let Some(regained) = regained {
            self.values = (&values + &change).iter().copied().collect();
            self.covariance = &regained * &self.covariance * regained.transpose();
        }
        self.covariance += &change * change.transpose() * (known_to * known_to);
        self.std_errors = (0..p).map(|j| self.covariance[(j, j)].max(0.0).sqrt()).collect();
        self
    }

    /// The parameter's t-value; 0 when it is not identified.
    pub fn t_value(&self, index: usize) -> f64 {
        if self.identified[index] { self.values[index] / self.std_errors[index].max(f64::MIN_POSITIVE) } else { 0.0 }
    }
}

fn weight_sum_of_squares(residuals: &[f64], weights: Option<&[f64]>) -> f64 {
    residuals.iter().enumerate().map(|(i, r)| weights.map_or(1.0, |w| w[i].max(0.0)) * r * r).sum()
}

fn finite_or_one(factor: f64) -> f64 {
    if factor.is_finite() { factor } else { 1.0 }
}

fn check(columns: &[Vec<f64>], rhs: &[f64], weights: Option<&[f64]>) -> Result<(), EstimateError> {
    let n = rhs.len();
    if columns.iter().any(|c| c.len() != n) || weights.is_some_and(|w| w.len() != n) {
        return Err(EstimateError::Other(format!("the columns of a fit do not all have its {n} samples")));
    }
    let finite = rhs.iter().all(|v| v.is_finite())
        && columns.iter().all(|c| c.iter().all(|v| v.is_finite()))
        && weights.is_none_or(|w| w.iter().all(|v| v.is_finite()));
    if finite { Ok(()) } else { Err(EstimateError::Other("a fit was given a number that is not finite".to_owned())) }
}

/// Solution of the scaled problem.
struct Solution {
    values: DVector<f64>,
    /// `(XᵀX)⁺`.
    inverse: DMatrix<f64>,
    condition: f64,
    identified: Vec<bool>,
}

/// Pseudo-inverse solution of the scaled problem.
fn solve(design: DMatrix<f64>, target: &DVector<f64>) -> Result<Solution, EstimateError> {
    let p = design.ncols();
    if p == 0 {
        let (values, inverse) = (DVector::zeros(0), DMatrix::zeros(0, 0));
        return Ok(Solution { values, inverse, condition: 1.0, identified: Vec::new() });
    }
    let qr = design.qr();
    let mut rotated = target.clone();
    qr.q_tr_mul(&mut rotated);
    let svd = qr.r().svd(true, true);
    let (Some(u), Some(vt)) = (svd.u.as_ref(), svd.v_t.as_ref()) else {
        return Err(EstimateError::Other("the singular values of a fit could not be computed".to_owned()));
    };
    let largest = svd.singular_values.max();
    let smallest = svd.singular_values.min();
    let kept: Vec<bool> = svd.singular_values.iter().map(|&s| s > largest * RANK_TOLERANCE && s > 0.0).collect();
    let mut values = DVector::zeros(p);
    let mut inverse = DMatrix::zeros(p, p);
    let mut identified = vec![true; p];
    for (k, &keep) in kept.iter().enumerate() {
        let v = vt.row(k).transpose();
        if keep {
            let s = svd.singular_values[k];
            values += &v * (u.column(k).dot(&rotated.rows(0, p)) / s);
            inverse += &v * v.transpose() / (s * s);
        } else {
            for (flag, loading) in identified.iter_mut().zip(v.iter()) {
                *flag &= loading.abs() < LOADING_TOLERANCE;
            }
        }
    }
    let condition = if kept.iter().all(|&k| k) { largest / smallest } else { f64::INFINITY };
    Ok(Solution { values, inverse, condition, identified })
}

/// 1 + 2 Σ ρₖ up to the self-consistent window; at least 1. Zero or short series give 1.
pub fn integrated_autocorrelation(series: &[f64]) -> f64 {
    let n = series.len();
    let mean = series.iter().sum::<f64>() / n.max(1) as f64;
    let power: f64 = series.iter().map(|v| (v - mean).powi(2)).sum();
    if n < 4 || power <= 0.0 {
        return 1.0;
    }
    let mut time: f64 = 1.0;
    for lag in 1..n / 2 {
        let product: f64 = series.iter().zip(&series[lag..]).map(|(a, b)| (a - mean) * (b - mean)).sum();
        // The sum of all sample autocorrelations is −1/2: give back the part that removing the mean takes.
        time += 2.0 * (product / power + time.max(1.0) / n as f64);
        if lag as f64 >= 5.0 * time.max(1.0) {
            break;
        }
    }
    time.max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    fn ar1(rng: &mut StdRng, n: usize, rho: f64) -> Vec<f64> {
        let mut state: f64 = rng.sample(StandardNormal);
        let drive = (1.0 - rho * rho).sqrt();
        (0..n)
            .map(|_| {
                let shock: f64 = rng.sample(StandardNormal);
                state = rho * state + drive * shock;
                state
            })
            .collect()
    }

    /// Share of 95 % intervals that hold the truth, for a constant and a slow sine, in AR(1) noise.
    fn coverage(n: usize, rho: f64, trials: usize) -> [f64; 2] {
        let mut rng = StdRng::seed_from_u64(7);
        let sine: Vec<f64> = (0..n).map(|i| (20.0 * i as f64 / n as f64).sin()).collect();
        let mut hits = [0.0; 2];
        for _ in 0..trials {
            let noise = ar1(&mut rng, n, rho);
            let rhs: Vec<f64> = (0..n).map(|i| 1.5 + 2.0 * sine[i] + noise[i]).collect();
            let fit = least_squares(&[vec![1.0; n], sine.clone()], &rhs, None).expect("solves");
            for (k, truth) in [1.5, 2.0].into_iter().enumerate() {
                hits[k] += f64::from(u8::from((fit.values[k] - truth).abs() < 1.96 * fit.std_errors[k]));
            }
        }
        hits.map(|h| h / trials as f64)
    }

    #[test]
    fn intervals_hold_the_truth_under_white_and_correlated_noise() {
        // 1500 trials: the standard error of a coverage of 0.95 is 0.006.
        for (n, rho) in [(20, 0.0), (40, 0.3), (200, 0.0), (500, 0.6), (1000, 0.9), (4000, 0.98), (20_000, 0.99)] {
            let [constant, sine] = coverage(n, rho, 1500);
            println!("n {n} rho {rho}: constant {constant}, sine {sine}");
            for held in [constant, sine] {
                assert!((0.925..0.975).contains(&held), "n {n} rho {rho}: {constant} {sine}");
            }
        }
    }

    #[test]
    fn an_exact_line_is_found_exactly() {
        let x: Vec<f64> = (0..50).map(f64::from).collect();
        let rhs: Vec<f64> = x.iter().map(|x| 3.0 - 2.0 * x).collect();
        let fit = least_squares(&[vec![1.0; 50], x], &rhs, None).expect("solves");
        assert!((fit.values[0] - 3.0).abs() < 1e-12 && (fit.values[1] + 2.0).abs() < 1e-13);
        assert!(fit.rms < 1e-12 && fit.identified == [true, true]);
    }

    #[test]
    fn weights_of_zero_take_samples_out() {
        let rhs = [1.0, 1.0, 1.0, 100.0];
        let fit = least_squares(&[vec![1.0; 4]], &rhs, Some(&[1.0, 1.0, 1.0, 0.0])).expect("solves");
        assert!((fit.values[0] - 1.0).abs() < 1e-12 && fit.rms < 1e-12);
    }

    #[test]
    fn a_pair_that_merges_is_named_and_the_rest_stands() {
        let x: Vec<f64> = (0..40).map(|i| (f64::from(i) * 0.3).sin()).collect();
        let doubled: Vec<f64> = x.iter().map(|v| 2.0 * v).collect();
        let rhs: Vec<f64> = x.iter().map(|v| 4.0 * v + 1.0).collect();
        let fit = least_squares(&[x, doubled, vec![1.0; 40], vec![0.0; 40]], &rhs, None).expect("solves");
        assert_eq!(fit.identified, [false, false, true, false]);
        assert!((fit.values[2] - 1.0).abs() < 1e-12 && fit.condition.is_infinite() && fit.rms < 1e-12);
    }

    #[test]
    fn noise_in_a_column_no_longer_attenuates() {
        let mut rng = StdRng::seed_from_u64(11);
        let n = 4000;
        let clean: Vec<f64> = (0..n).map(|i| (0.05 * f64::from(i)).sin()).collect();
        // Nearly the same as the first regressor: the own part of each is small.
        let other: Vec<f64> = (0..n).map(|i| (0.05 * f64::from(i) + 0.3).sin()).collect();
        let rhs: Vec<f64> = clean.iter().zip(&other).map(|(a, b)| 2.0 * a - b).collect();
        let noisy: Vec<f64> = clean.iter().map(|v| v + 0.05 * rng.sample::<f64, _>(StandardNormal)).collect();
        let plain = least_squares(&[noisy, other], &rhs, None).expect("solves");
        assert!(plain.values[0] < 1.93, "the noise attenuates: {:?}", plain.values);
        let mut noise = DMatrix::zeros(2, 2);
        noise[(0, 0)] = f64::from(n) * 0.05_f64.powi(2);
        let first = plain.values[0];
        let corrected = plain.without_attenuation(&noise, COLUMN_NOISE_UNCERTAINTY);
        for (value, (error, truth)) in corrected.values.iter().zip(corrected.std_errors.iter().zip([2.0, -1.0])) {
            assert!((value - truth).abs() < 2.5 * error && *error < 0.05, "{value} ± {error} against {truth}");
        }
        assert!(corrected.std_errors[0] > 0.2 * (corrected.values[0] - first), "a share of the correction is an error");
    }

    #[test]
    fn too_few_samples_and_bad_numbers_are_refused() {
        assert!(least_squares(&[vec![1.0], vec![2.0]], &[1.0], None).is_err());
        assert!(least_squares(&[vec![f64::NAN, 1.0]], &[1.0, 1.0], None).is_err());
        assert!(least_squares(&[vec![1.0]], &[1.0, 1.0], None).is_err());
    }
}
