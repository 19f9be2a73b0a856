//! One regression with the information that other motions would add to it.

use super::motion::Motion;
use nalgebra::{DMatrix, DVector};

/// Longest wait for a number, s.
const LONGEST_S: f64 = 1800.0;

/// One regression with the information that other motions would add to it.
#[derive(Clone, Debug)]
pub(crate) struct Problem {
    pub(crate) object: String,
    /// Names of parameters with their place among the columns.
    pub(crate) names: Vec<(String, usize)>,
    /// Inverse covariance of the collected data, regressors in their own units.
    pub(crate) information: DMatrix<f64>,
    /// Standard deviation of every column's value before anything is seen: far beyond any object.
    pub(crate) before: Vec<f64>,
    /// Information a second of each motion; the first is going on as before.
    pub(crate) motions: Vec<(Motion, DMatrix<f64>)>,
}

impl Problem {
    /// Variance of a parameter's value after a number of seconds of a motion.
    pub(super) fn variance(&self, column: usize, motion: &DMatrix<f64>, seconds: f64) -> f64 {
        let n = self.before.len();
        let prior = DMatrix::from_diagonal(&DVector::from_iterator(n, self.before.iter().map(|s| s.powi(-2))));
        // Scaled by the present errors: the regressors' units differ by orders of magnitude.
        let scale = DMatrix::from_diagonal(&DVector::from_column_slice(&self.before));
        let total = &scale * (&self.information + motion * seconds + prior) * &scale;
        let inverse = total.cholesky().map(|c| c.inverse());
        inverse.map_or(f64::INFINITY, |i| i[(column, column)] * self.before[column].powi(2))
    }

    /// Seconds of a motion until a column's variance is `wanted`; `None` when that takes too long.
    pub(super) fn seconds(&self, column: usize, motion: &DMatrix<f64>, wanted: f64) -> Option<f64> {
        if self.variance(column, motion, LONGEST_S) > wanted {
            return None;
        }
        let (mut low, mut high) = (0.0, LONGEST_S);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if self.variance(column, motion, middle) > wanted { low = middle } else { high = middle }
        }
        Some(high)
    }
}
