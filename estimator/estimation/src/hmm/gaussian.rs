//! Normal distributions of the emissions.

use nalgebra::{DMatrix, SymmetricEigen};

/// Spread of a normal distribution.
#[derive(Clone, Debug, PartialEq)]
pub enum Covariance {
    /// Independent channels: variances.
    Diagonal(Vec<f64>),
    /// Any: symmetric, rows and columns by channel.
    Full(DMatrix<f64>),
}

/// The inverse of the covariance's lower Cholesky factor.
#[derive(Clone, Copy, Debug)]
pub(super) enum Whitening<'a> {
    /// Of independent channels: its diagonal.
    Channels(&'a [f64]),
    /// Row after row, zeros above the diagonal.
    Rows(&'a [f64]),
}

/// A normal distribution with the precomputed terms of its density.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaussian {
    mean: Vec<f64>,
    covariance: Covariance,
    /// Inverse of the covariance's lower Cholesky factor; of a diagonal one only its diagonal.
    whitening: Vec<f64>,
    /// ½ (d log 2π + log |Σ|).
    log_scale: f64,
}

impl Gaussian {
    /// A distribution whose variance in any direction is at least that of independent channels with variances `floor`
    /// (positive): a channel that never changes does not make its density infinite.
    ///
    /// Raising the small eigenvalues (in units of the floor) is the maximum of the likelihood under that bound, so that training
    /// with a floor still never loses likelihood. Numbers that are not finite count as the floor.
    pub fn new(mean: Vec<f64>, covariance: Covariance, floor: &[f64]) -> Self {
        let channels = mean.len();
        let least = |c: usize| floor.get(c).copied().filter(|f| f.is_finite() && *f > 0.0).unwrap_or(f64::MIN_POSITIVE);
        let covariance = match covariance {
            Covariance::Diagonal(variances) => Covariance::Diagonal(
                (0..channels)
                    .map(|c| variances.get(c).copied().filter(|v| v.is_finite()).unwrap_or(0.0).max(least(c)))
                    .collect(),
            ),
            Covariance::Full(matrix)
                if matrix.shape() == (channels, channels) && matrix.iter().all(|v| v.is_finite()) =>
            {
                Covariance::Full(raised(&matrix, &least))
            }
            Covariance::Full(_) => Covariance::Diagonal((0..channels).map(least).collect()),
        };
        let (covariance, whitening, log_determinant) = whitened(covariance, &least);
        let log_scale = 0.5 * (channels as f64 * std::f64::consts::TAU.ln() + log_determinant);
        Self { mean, covariance, whitening, log_scale }
    }

    /// Number of channels.
    pub fn channels(&self) -> usize {
        self.mean.len()
    }

    /// Mean, by channel.
    pub fn mean(&self) -> &[f64] {
        &self.mean
    }

    /// Spread.
    pub fn covariance(&self) -> &Covariance {
        &self.covariance
    }

    /// Variance of a channel.
    pub fn variance(&self, channel: usize) -> f64 {
        match &self.covariance {
            Covariance::Diagonal(variances) => variances[channel],
            Covariance::Full(matrix) => matrix[(channel, channel)],
        }
    }

    pub(super) fn whitening(&self) -> Whitening<'_> {
        match &self.covariance {
            Covariance::Diagonal(_) => Whitening::Channels(&self.whitening),
            Covariance::Full(_) => Whitening::Rows(&self.whitening),
        }
    }

    /// ½ (d log 2π + log |Σ|).
    pub(super) fn log_scale(&self) -> f64 {
        self.log_scale
    }

    /// Logarithm of the density at a sample of [`Self::channels`] numbers.
    pub fn log_density(&self, sample: &[f64]) -> f64 {
        -self.log_scale - 0.5 * self.squared_distance(sample)
    }

    /// Squared Mahalanobis distance of a sample from the mean.
    fn squared_distance(&self, sample: &[f64]) -> f64 {
        match &self.covariance {
            Covariance::Diagonal(_) => sample
                .iter()
                .zip(&self.mean)
                .zip(&self.whitening)
                .map(|((x, mean), inverse)| ((x - mean) * inverse).powi(2))
                .sum(),
            Covariance::Full(_) => {
                let d = self.channels();
                (0..d)
                    .map(|row| {
                        let terms = (0..=row).map(|c| self.whitening[row * d + c] * (sample[c] - self.mean[c]));
                        terms.sum::<f64>().powi(2)
                    })
                    .sum()
            }
        }
    }

    /// Mean of [`Self::log_density`] over samples that are distributed as `other`.
    pub fn mean_log_density(&self, other: &Self) -> f64 {
        let d = self.channels();
        let of_other = |a: usize, b: usize| match &other.covariance {
            Covariance::Diagonal(variances) => f64::from(u8::from(a == b)) * variances[a],
            Covariance::Full(matrix) => matrix[(a, b)],
        };
        // tr(Σ⁻¹ C) = tr(W C Wᵀ) with the whitening W.
        let trace: f64 = match &self.covariance {
            Covariance::Diagonal(_) => (0..d).map(|c| self.whitening[c].powi(2) * of_other(c, c)).sum(),
            Covariance::Full(_) => {
                let w = DMatrix::from_row_slice(d, d, &self.whitening);
                (&w * DMatrix::from_fn(d, d, of_other) * w.transpose()).trace()
            }
        };
        -self.log_scale - 0.5 * (trace + self.squared_distance(&other.mean))
    }
}

/// The matrix with its eigenvalues, in units of the floor, raised to 1.
fn raised(matrix: &DMatrix<f64>, least: &dyn Fn(usize) -> f64) -> DMatrix<f64> {
    let d = matrix.nrows();
    let unit = |c: usize| least(c).sqrt();
    let scaled = DMatrix::from_fn(d, d, |a, b| 0.5 * (matrix[(a, b)] + matrix[(b, a)]) / (unit(a) * unit(b)));
    let mut eigen = SymmetricEigen::new(scaled);
    if eigen.eigenvalues.iter().all(|v| *v >= 1.0) {
        return DMatrix::from_fn(d, d, |a, b| 0.5 * (matrix[(a, b)] + matrix[(b, a)]));
    }
    eigen.eigenvalues.iter_mut().for_each(|v| *v = v.max(1.0));
    let back = eigen.recompose();
    DMatrix::from_fn(d, d, |a, b| 0.5 * (back[(a, b)] + back[(b, a)]) * unit(a) * unit(b))
}

/// The covariance, the inverse of its Cholesky factor and log |Σ|. A matrix that rounding left without a factor keeps its diagonal.
fn whitened(covariance: Covariance, least: &dyn Fn(usize) -> f64) -> (Covariance, Vec<f64>, f64) {
    if let Covariance::Full(matrix) = &covariance {
        let d = matrix.nrows();
        let inverse = nalgebra::Cholesky::new(matrix.clone()).and_then(|c| {
            let factor = c.l();
            let log_determinant = 2.0 * factor.diagonal().iter().map(|v| v.ln()).sum::<f64>();
            Some((factor.solve_lower_triangular(&DMatrix::identity(d, d))?, log_determinant))
        });
        if let Some((inverse, log_determinant)) = inverse {
            let rows = inverse.transpose().as_slice().to_vec();
            return (covariance, rows, log_determinant);
        }
    }
    let variances: Vec<f64> = match covariance {
        Covariance::Diagonal(variances) => variances,
        Covariance::Full(matrix) => (0..matrix.nrows()).map(|c| matrix[(c, c)].max(least(c))).collect(),
    };
    let whitening = variances.iter().map(|v| v.sqrt().recip()).collect();
    let log_determinant = variances.iter().map(|v| v.ln()).sum();
    (Covariance::Diagonal(variances), whitening, log_determinant)
}
