//! Information matrices: of rows that a motion would add, and of recursions.

use crate::online::recursive::Recursive;
use nalgebra::{DMatrix, DVector};

/// Mean of x xᵀ over rows, times the rows a second.
pub(crate) fn per_second(rows: &[Vec<f64>], rows_per_s: f64) -> DMatrix<f64> {
    let n = rows.first().map_or(0, Vec::len);
    let sum = rows.iter().fold(DMatrix::zeros(n, n), |sum, row| {
        let x = DVector::from_column_slice(row);
        sum + &x * x.transpose()
    });
    sum * (rows_per_s / rows.len().max(1) as f64)
}

/// Information of a recursion, and the variance that its rows are divided by: the noise with all that its errors count.
pub(crate) fn collected<const P: usize>(fit: &Recursive<P>) -> (DMatrix<f64>, f64) {
    let (inverse, errors) = (fit.inverse(), fit.std_errors());
    let known: Vec<f64> =
        (0..P).filter(|j| errors[*j].is_finite()).map(|j| errors[j] * errors[j] / inverse[j][j]).collect();
    let variance =
        if known.is_empty() { fit.noise().powi(2).max(1e-12) } else { known.iter().sum::<f64>() / known.len() as f64 };
    let information =
        DMatrix::from_fn(P, P, |i, j| inverse[i][j]).try_inverse().unwrap_or_else(|| DMatrix::zeros(P, P));
    (information / variance, variance.max(1e-300))
}

/// The same with one more column that is a copy of column `of`: a bias that acts as that parameter does.
pub(crate) fn with_copy(matrix: &DMatrix<f64>, of: usize) -> DMatrix<f64> {
    let n = matrix.nrows();
    let place = |i: usize| if i == n { of } else { i };
    DMatrix::from_fn(n + 1, n + 1, |i, j| matrix[(place(i), place(j))])
}
