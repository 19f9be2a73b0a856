//! Weighted least squares one row at a time, with true errors, for hours.
//!
//! Square-root information form: the triangular R with `RᵀR = Σ w x xᵀ` takes in every row by Givens rotations (Bierman
//! 1977, ch. V), so that information can neither become negative nor lose digits to squaring.
//!
//! **Forgetting** is directional (after Kulhavý 1987). Before a row comes in, the precision of its combination xᵀθ is
//! lowered by the share 1/memory, never by more than the row brings back. Directions that are not excited are not
//! forgotten at all, and the precision of an excited one never falls through forgetting: nothing winds up.
//!
//! **Errors** are those of the estimate as it was made: Λ⁻¹ Γ Λ⁻¹ with Γ the sum of the squared scores x ε (ε the recursive residuals of
//! Brown, Durbin & Evans 1975, which are independent where the noise is), forgotten along with Λ. Scores are summed over short blocks,
//! and their correlation from block to block gives each parameter the long-run variance of its own influence (AR(1)), as in
//! [`crate::regression::long_run_variance`].
//!
//! A row costs about 10 P² operations (with forgetting 10 P³) and allocates nothing.

use super::triangular::{Square, back, between, dot, forward, inverse_times, rotate_in, triangularise};
use crate::regression::long_run_variance::inflation;

/// Information before the first row, as a share of a typical row's: it decides nothing but keeps R invertible.
const RIDGE: f64 = 1e-4;
/// Fewer blocks say nothing about correlation.
const LEAST_BLOCKS: f64 = 4.0;
/// A parameter is known when the data have this many times the information that it was begun with.
const SHOWN: f64 = 1e2;

/// Fit of a new row to the earlier estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Innovation {
    /// Prediction error over √(1 + leverage), in the unit of the right-hand side: as large as the noise.
    pub residual: f64,
    /// Variance of the prediction over that of the noise.
    pub leverage: f64,
}

/// A regression of P parameters that takes one row after the other.
#[derive(Clone, Debug)]
pub struct Recursive<const P: usize> {
    root: Square<P>,
    rotated: [f64; P],
    begin: [f64; P],
    /// Share that a row forgets, 0 for never.
    forgets: f64,
    block_rows: u32,
    /// Scores of the running block, of the one before, and how many rows are in the running one.
    block: [f64; P],
    before: [f64; P],
    filled: u32,
    /// Σ b bᵀ and Σ b b₋₁ᵀ over blocks.
    scores: Square<P>,
    lagged: Square<P>,
    blocks: f64,
    /// Sum of squared residuals and their number.
    power: f64,
    freedom: f64,
    rows: u64,
}

impl<const P: usize> Recursive<P> {
    /// `sizes`: typical sizes of the regressors. `memory_rows`: rows after which a direction that is excited all the
    /// time has forgotten; infinite: never. `block_rows`: rows a block of scores; about the time in which residuals
    /// forget each other.
    pub fn new(sizes: [f64; P], memory_rows: f64, block_rows: u32) -> Self {
        let begin = sizes.map(|s| RIDGE * if s > 0.0 && s.is_finite() { s } else { 1.0 });
        let forgets = if memory_rows >= 1.0 { 1.0 / memory_rows } else { 0.0 };
        let mut new = Self {
            root: [[0.0; P]; P],
            rotated: [0.0; P],
            begin,
            forgets,
            block_rows: block_rows.max(1),
            block: [0.0; P],
            before: [0.0; P],
            filled: 0,
            scores: [[0.0; P]; P],
            lagged: [[0.0; P]; P],
            blocks: 0.0,
            power: 0.0,
            freedom: -(P as f64),
            rows: 0,
        };
        new.reset();
        new
    }

    /// Forgets everything: the next row is the first.
    pub fn reset(&mut self) {
        let zero = [[0.0; P]; P];
        (self.root, self.scores, self.lagged) = (zero, zero, zero);
        for i in 0..P {
            self.root[i][i] = self.begin[i];
        }
        (self.rotated, self.block, self.before) = ([0.0; P], [0.0; P], [0.0; P]);
        (self.filled, self.blocks, self.power, self.freedom, self.rows) = (0, 0.0, 0.0, -(P as f64), 0);
    }

    /// Takes in `rhs = row · values + noise`, with a weight (an inverse variance up to a factor). Rows that are not finite, have no
    /// weight or are all zero are left out: `None`.
    pub fn push(&mut self, row: &[f64; P], rhs: f64, weight: f64) -> Option<Innovation> {
        let finite = rhs.is_finite() && row.iter().all(|v| v.is_finite()) && weight.is_finite();
        if !(finite && weight > 0.0) || row.iter().all(|v| *v == 0.0) {
            return None;
        }
        let x = row.map(|v| v * weight.sqrt());
        let y = rhs * weight.sqrt();
        let values = back(&self.root, &self.rotated);
        let u = forward(&self.root, &x);
        let mut leverage = dot(&u, &u);
        // At most as much as the row brings: 1/h − share/h + 1 ≥ 1/h.
        let share = self.forgets.min(leverage);
        if share > 0.0 {
            self.forget(&x, &u, leverage, share);
            leverage /= 1.0 - share;
        }
        let residual = (y - dot(&x, &values)) / (1.0 + leverage).sqrt();
        rotate_in(&mut self.root, &mut self.rotated, x, y);
        self.power += residual * residual;
        self.freedom += 1.0;
        self.rows += 1;
        self.score(&x, residual);
        Some(Innovation { residual: residual / weight.sqrt(), leverage })
    }

    /// Lowers the precision of xᵀθ by `share` and leaves the values as they are.
    fn forget(&mut self, x: &[f64; P], u: &[f64; P], leverage: f64, share: f64) {
        let cut = (1.0 - (1.0 - share).sqrt()) / leverage;
        let along: [f64; P] = std::array::from_fn(|j| (0..=j).map(|i| u[i] * self.root[i][j]).sum());
        let value = dot(u, &self.rotated);
        let mut full = self.root;
        let mut z = self.rotated;
        for i in 0..P {
            for j in 0..P {
                full[i][j] -= cut * u[i] * along[j];
            }
            z[i] -= cut * u[i] * value;
        }
        // The sum of the scores belongs to the old information: v' = Λ' Λ⁻¹ v.
        let gain = back(&self.root, u);
        let step = share / leverage;
        let passed = |v: &[f64; P]| -> [f64; P] {
            let part = step * dot(&gain, v);
            std::array::from_fn(|i| v[i] - part * x[i])
        };
        (self.block, self.before) = (passed(&self.block), passed(&self.before));
        for matrix in [&mut self.scores, &mut self.lagged] {
            for row in matrix.iter_mut() {
                *row = passed(row);
            }
            let columns = transposed(matrix);
            *matrix = transposed(&columns.map(|c| passed(&c)));
        }
        let kept = 1.0 - share;
        (self.blocks, self.power, self.freedom) = (self.blocks * kept, self.power * kept, self.freedom * kept);
        (self.root, self.rotated) = triangularise(&full, &z);
    }

    fn score(&mut self, x: &[f64; P], residual: f64) {
        for (sum, x) in self.block.iter_mut().zip(x) {
            *sum += x * residual;
        }
        self.filled += 1;
        if self.filled < self.block_rows {
            return;
        }
        for i in 0..P {
            for j in 0..P {
                self.scores[i][j] += self.block[i] * self.block[j];
                self.lagged[i][j] += self.block[i] * self.before[j];
            }
        }
        self.before = std::mem::replace(&mut self.block, [0.0; P]);
        (self.filled, self.blocks) = (0, self.blocks + 1.0);
    }

    /// The values; zero for directions that were never excited.
    pub fn values(&self) -> [f64; P] {
        back(&self.root, &self.rotated)
    }

    /// Rows since the last reset.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Standard deviation of the noise of a row of weight 1.
    pub fn noise(&self) -> f64 {
        (self.power / self.freedom.max(1.0)).sqrt()
    }

    /// Inverse of the information Σ w x xᵀ.
    pub fn inverse(&self) -> Square<P> {
        std::array::from_fn(|j| {
            let mut unit = [0.0; P];
            unit[j] = 1.0;
            inverse_times(&self.root, &unit)
        })
    }

    /// Covariance of the values: autocorrelation, few rows and forgetting are counted. Infinite on the diagonal where nothing is known.
    pub fn covariance(&self) -> Square<P> {
        let inverse = self.inverse();
        let raw: Square<P> =
            std::array::from_fn(|i| std::array::from_fn(|j| between(&inverse[i], &self.scores, &inverse[j])));
        let wanted: [f64; P] = std::array::from_fn(|j| self.variance(j, &inverse));
        let grow: [f64; P] = std::array::from_fn(|j| {
            let factor = wanted[j] / raw[j][j];
            if factor.is_finite() { factor.sqrt() } else { 0.0 }
        });
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { wanted[i] } else { raw[i][j] * grow[i] * grow[j] }))
    }

    /// Standard errors of the values; infinite where nothing is known.
    pub fn std_errors(&self) -> [f64; P] {
        let inverse = self.inverse();
        std::array::from_fn(|j| self.variance(j, &inverse).sqrt())
    }

    fn variance(&self, j: usize, inverse: &Square<P>) -> f64 {
        let known = 1.0 / inverse[j][j] > SHOWN * self.begin[j] * self.begin[j];
        if self.blocks < LEAST_BLOCKS || self.freedom < 2.0 || !known {
            return f64::INFINITY;
        }
        let own = between(&inverse[j], &self.scores, &inverse[j]);
        let next = between(&inverse[j], &self.lagged, &inverse[j]);
        let n = self.blocks;
        let raw = if own > 0.0 { next / own } else { 0.0 };
        // Estimates of a correlation are low by (1 + 3ρ)/n (Kendall 1954).
        let rho = (raw + (1.0 + 3.0 * raw) / n).clamp(-0.5, 1.0 - 1.5 / n);
        let persistence = ((1.0 + rho) / (1.0 - rho)).max(1.0);
        let long_run = own * (1.0 + rho) / (1.0 - rho) * n / (n - 2.0).max(1.0);
        let correlated = long_run * inflation((n / (3.0 * persistence)).max(3.0));
        // Never below the errors of independent rows; forgetting halves that, because a long memory weighs its rows
        // unevenly.
        let even = if self.forgets > 0.0 { 0.5 } else { 1.0 };
        let white = even * self.power / self.freedom * inverse[j][j] * inflation(self.freedom);
        correlated.max(white)
    }
}

fn transposed<const P: usize>(matrix: &Square<P>) -> Square<P> {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]))
}
