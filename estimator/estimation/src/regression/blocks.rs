//! Least squares over rows in independent blocks, with an honest covariance also of few of them.
//!
//! Residuals of one block may go together in any way: the three components of a reading, neighbours in a slow motion. The
//! covariance is the sum over blocks of their influence, with residuals enlarged by the block's own leverage: CR2 (Bell &
//! `McCaffrey` 2002). Their degrees of freedom belong to it: few blocks make Student's t.

use super::long_run_variance::inflation;
use nalgebra::{DMatrix, DVector};

/// Rows of one block.
#[derive(Clone, Debug)]
pub struct Block {
    /// Regressors, one row a component of a reading.
    pub x: DMatrix<f64>,
    /// Readings.
    pub y: DVector<f64>,
}

/// The solution.
#[derive(Clone, Debug)]
pub struct Solved {
    /// Values; 0 for a direction that the readings do not show.
    pub values: DVector<f64>,
    /// False for a value that no reading shows, or only together with another one, and for one whose error no block shows.
    pub identified: Vec<bool>,
    /// Influence of each block on the values; the sum of their squares is the covariance.
    pub influence: Vec<DVector<f64>>,
    /// Degrees of freedom of each value's error.
    pub freedom: Vec<f64>,
    /// Residuals of each block.
    pub residuals: Vec<DVector<f64>>,
    /// Residuals of each block by a fit without it; none if the others do not show all that it needs.
    pub left_out: Vec<Option<DVector<f64>>>,
}

/// Share of the largest eigenvalue below which one counts as zero.
/// Derived: the square of a millionth of the largest singular value.
const NOT_SHOWN: f64 = 1e-12;
/// Eigenvalue of a block's part of the residual maker below which the other blocks do not show all that it needs.
const WITHOUT_OTHERS: f64 = 1e-8;
/// Largest loading of an identified value on a lost direction.
const LOST_LOADING: f64 = 1e-4;

/// Symmetric matrix function by eigenvalues; those that vanish give zero.
fn by_eigenvalues(matrix: &DMatrix<f64>, of: &dyn Fn(f64) -> f64) -> (DMatrix<f64>, Vec<DVector<f64>>) {
    // A model without a term has no values.
    if matrix.is_empty() {
        return (matrix.clone(), Vec::new());
    }
    let eigen = matrix.clone().symmetric_eigen();
    let largest = eigen.eigenvalues.amax();
    let mut result = DMatrix::zeros(matrix.nrows(), matrix.nrows());
    let mut lost = Vec::new();
    for (k, value) in eigen.eigenvalues.iter().enumerate() {
        let v = eigen.eigenvectors.column(k);
        if *value > largest * NOT_SHOWN && *value > 0.0 {
            result += v * v.transpose() * of(*value);
        } else {
            lost.push(v.into_owned());
        }
    }
    (result, lost)
}

/// Minimises the sum of the squared residuals of all blocks. All blocks have the same regressors.
pub fn solve(blocks: &[Block]) -> Solved {
    let p = blocks.first().map_or(0, |block| block.x.ncols());
    let squares = blocks.iter().map(|b| DVector::from_fn(p, |j, _| b.x.column(j).norm_squared()));
    let scale = squares.fold(DVector::zeros(p), |a, b| a + b).map(|s: f64| if s > 0.0 { 1.0 / s.sqrt() } else { 1.0 });
    let scaled: Vec<DMatrix<f64>> = blocks.iter().map(|b| &b.x * DMatrix::from_diagonal(&scale)).collect();
    let normal = scaled.iter().fold(DMatrix::zeros(p, p), |sum, x| sum + x.transpose() * x);
    let right = scaled.iter().zip(blocks).fold(DVector::zeros(p), |sum, (x, b)| sum + x.transpose() * &b.y);
    let (inverse, lost) = by_eigenvalues(&normal, &|value| 1.0 / value);
    let values = &inverse * right;
    let is_shown = |j: usize| lost.iter().all(|v| v[j].abs() < LOST_LOADING);
    let residuals: Vec<DVector<f64>> = scaled.iter().zip(blocks).map(|(x, b)| &b.y - x * &values).collect();
    // Residuals without the block's own pull, and half of it taken out.
    let (mut half, mut left_out) = (Vec::new(), Vec::new());
    for (x, residual) in scaled.iter().zip(&residuals) {
        let rest = DMatrix::identity(x.nrows(), x.nrows()) - x * &inverse * x.transpose();
        let eigen = rest.symmetric_eigen();
        let with = |of: &dyn Fn(f64) -> f64| {
            let values = eigen.eigenvalues.map(|v| if v > WITHOUT_OTHERS { of(v) } else { 0.0 });
            &eigen.eigenvectors * DMatrix::from_diagonal(&values) * eigen.eigenvectors.transpose()
        };
        half.push(with(&|v| 1.0 / v.sqrt()));
        let is_whole = eigen.eigenvalues.iter().all(|v| *v > WITHOUT_OTHERS);
        left_out.push(is_whole.then(|| with(&|v| 1.0 / v) * residual));
    }
    let influence =
        scaled.iter().zip(&half).zip(&residuals).map(|((x, a), e)| &inverse * (x.transpose() * (a * e))).collect();
    let freedom: Vec<f64> = (0..p).map(|j| freedom(&scaled, &half, &inverse, j)).collect();
    let unscaled = |v: DVector<f64>| v.component_mul(&scale);
    let influence: Vec<DVector<f64>> = influence;
    Solved {
        values: unscaled(values),
        identified: (0..p).map(|j| is_shown(j) && freedom[j] > 0.0).collect(),
        influence: influence.into_iter().map(unscaled).collect(),
        freedom,
        residuals,
        left_out,
    }
}

/// Degrees of freedom of a value's error, 0 if each block alone shows a part of the value: of the quadratic form that CR2 is, under independent errors (Satterthwaite 1946).
///
/// The form is `B = diag(aᵀa) − UᵀN⁻¹U`, with the weights a of each block and `u = xᵀa`; they are (tr B)²/tr B².
fn freedom(scaled: &[DMatrix<f64>], half: &[DMatrix<f64>], inverse: &DMatrix<f64>, j: usize) -> f64 {
    let wanted = inverse.column(j);
    let (mut trace, mut squares) = (0.0, 0.0);
    let mut all = DMatrix::zeros(inverse.nrows(), inverse.nrows());
    for (x, a) in scaled.iter().zip(half) {
        let weights = a * (x * wanted);
        let (own, u) = (weights.norm_squared(), x.transpose() * &weights);
        let shared = u.dot(&(inverse * &u));
        trace += own - shared;
        squares += own * own - 2.0 * own * shared;
        all += &u * u.transpose();
    }
    let between = inverse * all;
    squares += (&between * &between).trace();
    if trace < WITHOUT_OTHERS * wanted[j] {
        return 0.0;
    }
    if squares > 0.0 { trace * trace / squares } else { 1.0 }
}

impl Solved {
    /// Square roots of the factors by which Student's t widens each error.
    pub fn widening(&self) -> Vec<f64> {
        self.freedom.iter().map(|freedom| inflation(*freedom).sqrt()).collect()
    }

    /// Root mean square of the residuals.
    pub fn rms(&self) -> f64 {
        mean_square(self.residuals.iter()).sqrt()
    }

    /// Root mean square of what a fit without the block leaves of it; none without such a fit.
    pub fn held_out_rms(&self) -> Option<f64> {
        let all: Vec<&DVector<f64>> = self.left_out.iter().map(Option::as_ref).collect::<Option<_>>()?;
        Some(mean_square(all.into_iter()).sqrt())
    }
}

fn mean_square<'a>(residuals: impl Iterator<Item = &'a DVector<f64>>) -> f64 {
    let (sum, count) = residuals.fold((0.0, 0), |(sum, count), r| (sum + r.norm_squared(), count + r.len()));
    sum / count.max(1) as f64
}
