//! Marginal likelihood of linear models whose coefficients have Gaussian priors.
//!
//! Rows y = X b + Σ A θ + Σ Z w + e: the model's regressors X with flat priors, causes A with fixed prior variances,
//! and discrepancies Z whose coefficients share one variance each. The variances of the discrepancies and of the noise
//! are those that maximise the evidence (`MacKay` 1992, Bayesian interpolation).

use crate::diagnose::data::limits::MOST_ROUNDS;
use crate::diagnose::selection::normal_equations::NUMERICAL_RIDGE;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::ops::Range;

/// Prior variance of the coefficients of one element of a model.
#[derive(Clone, Debug)]
pub enum Prior {
    /// A cause: this variance for each coefficient, times the mean square of the target.
    Fixed(Vec<f64>),
    /// A discrepancy: one variance for all coefficients, estimated from the rows.
    Estimated,
}

/// A cause or a discrepancy: its columns of the Gram matrix, and the prior of their coefficients.
#[derive(Clone, Debug)]
pub struct Element {
    pub columns: Range<usize>,
    pub prior: Prior,
}

/// Gram matrix of whitened rows from which the model's regressors are projected out; the target comes last.
pub struct Products {
    gram: DMatrix<f64>,
    /// The same with the model's regressors, and the factor of their part.
    whole: DMatrix<f64>,
    factor: Cholesky<f64, Dyn>,
    /// Effective number of rows less the number of the model's regressors.
    freedom: f64,
    elements: Vec<Element>,
}

/// Elements of a model with the variances of its priors and of its noise.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// Elements in use, each with the variance of its coefficients (1 for a cause).
    pub used: Vec<(usize, f64)>,
    /// Variance of the whitened noise.
    pub noise: f64,
    /// Logarithm of the marginal likelihood.
    pub ln_evidence: f64,
    /// Posterior mean of the coefficients, element by element.
    pub mean: Vec<f64>,
}

/// Evidence that an element would add to a model, with its best variance.
pub struct Screened {
    pub element: usize,
    pub gain: f64,
    pub variance: f64,
}

/// Factored posterior of a model.
struct Posterior {
    columns: Vec<usize>,
    /// Square roots of the prior variances.
    deviation: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
    /// Whitened projection of the target: L⁻¹ D^½ Gcy/σ².
    projection: DVector<f64>,
    ln_evidence: f64,
}

/// Smallest and largest variance of a discrepancy beside a target of this mean square: nothing, and flat.
fn variances(power: f64) -> [f64; 2] {
    [1e-6 * power, 1e4 * power]
}

impl Products {
    /// `whole`: products of base columns, elements and target, in this order. `rows`: effective number of rows.
    /// `None` if the base cannot be solved.
    pub fn new(whole: DMatrix<f64>, base: usize, rows: f64, elements: Vec<Element>) -> Option<Self> {
        let size = whole.ncols();
        let mut of_base = whole.view((0, 0), (base, base)).into_owned();
        (0..base).for_each(|i| of_base[(i, i)] = of_base[(i, i)] * (1.0 + NUMERICAL_RIDGE) + f64::MIN_POSITIVE);
        let factor = of_base.cholesky()?;
        let beside = whole.view((0, base), (base, size - base)).into_owned();
        let solved = factor.l_dirty().solve_lower_triangular(&beside)?;
        let mut gram = whole.view((base, base), (size - base, size - base)).into_owned();
        gram.gemm_tr(-1.0, &solved, &solved, 1.0);
        Some(Self { gram, whole, factor, freedom: (rows - base as f64).max(1.0), elements })
    }

    /// Effective number of rows less the number of the model's regressors.
    pub fn freedom(&self) -> f64 {
        self.freedom
    }

    fn target(&self) -> usize {
        self.gram.ncols() - 1
    }

    /// Power of the target, a row.
    pub fn power(&self) -> f64 {
        self.gram[(self.target(), self.target())] / self.freedom
    }

    /// Mean square of the joint contribution of elements of a model, without its part along the model's regressors.
    pub fn power_of(&self, model: &Fitted, elements: &[usize]) -> f64 {
        let values: Vec<(usize, f64)> = elements.iter().flat_map(|e| self.values_of(model, *e)).collect();
        let beside = |(i, a): &(usize, f64)| values.iter().map(|(j, b)| a * b * self.gram[(*i, *j)]).sum::<f64>();
        values.iter().map(beside).sum::<f64>() / self.freedom
    }

    /// Columns of an element with their coefficients in a model; none if the model lacks it.
    pub fn values_of(&self, model: &Fitted, element: usize) -> Vec<(usize, f64)> {
        let mut at = 0;
        for (e, _) in &model.used {
            let columns = self.elements[*e].columns.clone();
            let own = at..at + columns.len();
            at = own.end;
            if *e == element {
                return columns.zip(model.mean[own].iter().copied()).collect();
            }
        }
        Vec::new()
    }

    fn columns(&self, used: &[(usize, f64)]) -> Vec<usize> {
        used.iter().flat_map(|(e, _)| self.elements[*e].columns.clone()).collect()
    }

    fn posterior(&self, used: &[(usize, f64)], noise: f64) -> Option<Posterior> {
        let columns = self.columns(used);
        let variances = used.iter().flat_map(|(e, variance)| match &self.elements[*e].prior {
            Prior::Fixed(own) => own.iter().map(|v| v * variance).collect::<Vec<f64>>(),
            Prior::Estimated => vec![*variance; self.elements[*e].columns.len()],
        });
        let deviation = DVector::from_iterator(columns.len(), variances.map(f64::sqrt));
        let scaled = DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            deviation[i] * deviation[j] * self.gram[(columns[i], columns[j])] / noise + f64::from(u8::from(i == j))
        });
        let factor = scaled.cholesky()?;
        let target = self.target();
        let right = DVector::from_fn(columns.len(), |i, _| deviation[i] * self.gram[(columns[i], target)] / noise);
        let projection = factor.l_dirty().solve_lower_triangular(&right)?;
        let determinant: f64 = (0..columns.len()).map(|i| factor.l_dirty()[(i, i)].ln()).sum();
        let ln_evidence = -0.5 * self.freedom * (std::f64::consts::TAU * noise).ln()
            - 0.5 * self.gram[(target, target)] / noise
            + 0.5 * projection.norm_squared()
            - determinant;
        Some(Posterior { columns, deviation, factor, projection, ln_evidence })
    }

    /// The model of these elements, with variances found from a start by `updates` steps.
    fn update(&self, mut used: Vec<(usize, f64)>, mut noise: f64, updates: usize) -> Option<Fitted> {
        let power = self.power();
        let mut round = 0;
        loop {
            let posterior = self.posterior(&used, noise)?;
            let scaled = posterior.factor.l_dirty().transpose().solve_upper_triangular(&posterior.projection)?;
            let mean: Vec<f64> = scaled.iter().zip(&posterior.deviation).map(|(m, d)| m * d).collect();
            if round == updates {
                return Some(Fitted { used, noise, ln_evidence: posterior.ln_evidence, mean });
            }
            round += 1;
            let inverse = posterior.factor.inverse();
            let (mut at, mut freedom) = (0, 0.0);
            for (e, variance) in &mut used {
                let own = at..at + self.elements[*e].columns.len();
                at = own.end;
                let determined: f64 = own.clone().map(|i| 1.0 - inverse[(i, i)]).sum();
                freedom += determined;
                if matches!(self.elements[*e].prior, Prior::Estimated) {
                    let square: f64 = mean[own].iter().map(|m| m * m).sum();
                    let [least, most] = variances(power);
                    *variance = (square / determined.max(1e-9)).clamp(least, most);
                }
            }
            let rss = self.rss(&posterior.columns, &mean);
            noise = rss / (self.freedom - freedom).max(1.0);
        }
    }

    fn rss(&self, columns: &[usize], mean: &[f64]) -> f64 {
        let target = self.target();
        let mut rss = self.gram[(target, target)];
        for (i, a) in columns.iter().zip(mean) {
            rss -= 2.0 * a * self.gram[(*i, target)];
            rss += columns.iter().zip(mean).map(|(j, b)| a * b * self.gram[(*i, *j)]).sum::<f64>();
        }
        rss.max(1e-9 * self.gram[(target, target)])
    }

    /// The model of these elements alone; discrepancies begin with these variances.
    pub fn fit(&self, used: Vec<(usize, f64)>, noise: Option<f64>) -> Option<Fitted> {
        self.update(used, noise.unwrap_or_else(|| self.power()), MOST_ROUNDS)
    }

    /// The same model without an element.
    pub fn without(&self, model: &Fitted, element: usize) -> Option<Fitted> {
        let used = model.used.iter().filter(|(e, _)| *e != element).copied().collect();
        self.update(used, model.noise, MOST_ROUNDS)
    }

    /// Evidence that each of these discrepancies would add to a model whose other variances stay, with its best
    /// variance.
    pub fn screen(&self, model: &Fitted, elements: &[usize]) -> Option<Vec<Screened>> {
        let posterior = self.posterior(&model.used, model.noise)?;
        let (noise, target, power) = (model.noise, self.target(), self.power());
        let one = |element: &usize| {
            let own = self.elements[*element].columns.clone();
            let beside = DMatrix::from_fn(posterior.columns.len(), own.len(), |i, j| {
                posterior.deviation[i] * self.gram[(posterior.columns[i], own.start + j)] / noise
            });
            let taken = posterior.factor.l_dirty().solve_lower_triangular(&beside)?;
            let mut precision = self.gram.view((own.start, own.start), (own.len(), own.len())) / noise;
            precision.gemm_tr(-1.0, &taken, &taken, 1.0);
            let mut slope = self.gram.view((own.start, target), (own.len(), 1)) / noise;
            slope.gemm_tr(-1.0, &taken, &posterior.projection, 1.0);
            let eigen = precision.symmetric_eigen();
            let along = eigen.eigenvectors.tr_mul(&slope);
            let gain = |variance: f64| -> f64 {
                let terms = eigen.eigenvalues.iter().zip(along.iter());
                0.5 * terms
                    .map(|(lambda, beta)| {
                        let more = 1.0 + lambda.max(0.0) * variance;
                        beta * beta * variance / more - more.ln()
                    })
                    .sum::<f64>()
            };
            // The maximum is flat: two and a half steps per decade.
            let [least, most] = variances(power);
            let tried = (0..26).map(|k| least * (most / least).powf(f64::from(k) / 25.0));
            let best = tried.map(|v| (gain(v), v)).max_by(|a, b| a.0.total_cmp(&b.0))?;
            Some(Screened { element: *element, gain: best.0, variance: best.1 })
        };
        elements.iter().map(one).collect()
    }

    /// Coefficients of all columns in use: those of the base, refitted beside the elements, and those of the elements.
    /// Indices are those of the whole matrix.
    pub fn values(&self, model: &Fitted) -> Vec<(usize, f64)> {
        let of_elements = self.columns(&model.used).into_iter().zip(model.mean.iter().copied());
        let own: Vec<(usize, f64)> = of_elements.map(|(c, m)| (self.base() + c, m)).collect();
        let without: Vec<(usize, f64)> =
            own.iter().map(|(c, m)| (*c, -m)).chain([(self.base() + self.target(), 1.0)]).collect();
        self.along_base(&without).into_iter().enumerate().chain(own).collect()
    }

    /// A sum of columns less its part along the model's regressors. Indices are those of the whole matrix.
    pub fn beside_base(&self, sum: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
        let along = self.along_base(&sum);
        along.into_iter().map(|v| -v).enumerate().chain(sum).collect()
    }

    fn base(&self) -> usize {
        self.factor.l_dirty().nrows()
    }

    /// Coefficients of the model's regressors that fit a sum of columns best.
    fn along_base(&self, sum: &[(usize, f64)]) -> Vec<f64> {
        let right = DVector::from_fn(self.base(), |i, _| sum.iter().map(|(c, v)| self.whole[(i, *c)] * v).sum::<f64>());
        self.factor.solve(&right).iter().copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand::rngs::StdRng;
    use rand_distr::{Distribution, StandardNormal};

    const ROWS: usize = 40;

    fn normal(rng: &mut StdRng, count: usize) -> Vec<f64> {
        (0..count).map(|_| StandardNormal.sample(rng)).collect()
    }

    fn gram(columns: &[Vec<f64>]) -> DMatrix<f64> {
        let product = |i: usize, j: usize| columns[i].iter().zip(&columns[j]).map(|(a, b)| a * b).sum::<f64>();
        DMatrix::from_fn(columns.len(), columns.len(), product)
    }

    /// Two columns of a cause, three of a discrepancy, and a target.
    fn some(rng: &mut StdRng) -> (Vec<Vec<f64>>, Vec<Element>) {
        let columns = (0..6).map(|_| normal(rng, ROWS)).collect();
        let cause = Element { columns: 0..2, prior: Prior::Fixed(vec![0.5, 2.0]) };
        (columns, vec![cause, Element { columns: 2..5, prior: Prior::Estimated }])
    }

    #[test]
    fn the_evidence_is_the_density_of_the_target_under_the_covariance_of_all_parts() {
        let (columns, elements) = some(&mut StdRng::seed_from_u64(3));
        let products = Products::new(gram(&columns), 0, ROWS as f64, elements).expect("no base");
        let (noise, variances) = (0.7, [0.5, 2.0, 0.3, 0.3, 0.3]);
        let found = products.update(vec![(0, 1.0), (1, 0.3)], noise, 0).expect("regular");
        let covariance = DMatrix::from_fn(ROWS, ROWS, |i, j| {
            let parts = columns.iter().zip(variances).map(|(c, v)| v * c[i] * c[j]).sum::<f64>();
            parts + if i == j { noise } else { 0.0 }
        });
        let target = DVector::from_column_slice(&columns[5]);
        let factor = covariance.cholesky().expect("positive");
        let square = target.dot(&factor.solve(&target));
        let wanted = -0.5 * (square + factor.determinant().ln() + ROWS as f64 * std::f64::consts::TAU.ln());
        assert!((found.ln_evidence - wanted).abs() < 1e-8, "{} {wanted}", found.ln_evidence);
    }

    #[test]
    fn screening_states_the_evidence_that_the_whole_model_has() {
        let (columns, elements) = some(&mut StdRng::seed_from_u64(4));
        let products = Products::new(gram(&columns), 0, ROWS as f64, elements).expect("no base");
        let model = products.update(vec![(0, 1.0)], 0.9, 0).expect("regular");
        let screened = &products.screen(&model, &[1]).expect("regular")[0];
        let whole = products.update(vec![(0, 1.0), (1, screened.variance)], 0.9, 0).expect("regular");
        assert!((whole.ln_evidence - model.ln_evidence - screened.gain).abs() < 1e-8);
    }

    #[test]
    fn a_discrepancy_that_is_there_gets_its_variance_and_the_noise_its_own() {
        let mut rng = StdRng::seed_from_u64(5);
        let mut columns: Vec<Vec<f64>> = (0..30).map(|_| normal(&mut rng, 4000)).collect();
        let size = normal(&mut rng, 30);
        let noise = normal(&mut rng, 4000);
        let sum = |i: usize| columns.iter().zip(&size).map(|(c, s)| 0.3 * s * c[i]).sum::<f64>();
        let target = (0..4000).map(|i| sum(i) + 0.5 * noise[i]).collect();
        columns.push(target);
        let elements = vec![Element { columns: 0..30, prior: Prior::Estimated }];
        let products = Products::new(gram(&columns), 0, 4000.0, elements).expect("no base");
        let found = products.fit(vec![(0, 1.0)], None).expect("regular");
        assert!((found.noise.sqrt() - 0.5).abs() < 0.02, "{}", found.noise);
        assert!((0.2..0.4).contains(&found.used[0].1.sqrt()), "{:?}", found.used);
    }
}
