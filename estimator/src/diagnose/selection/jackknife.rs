//! Jackknife of an effect over blocks of a recording, each of which may have its own model error.

use super::layout::Use;
use super::normal_equations::{Scaled, Solved, System, factored};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Largest share of an effect in one segment, as one minus this.
/// Derived: far above the rounding of a sum of squares (1e-16); it prevents a division by zero.
const LEAST_REST: f64 = 1e-9;

impl System {
    /// Squared effect of these regressors in a solution over its jackknife variance over blocks of the recording
    /// (Tukey 1958), for the most favourable block length. Unlike the variance of the residual, it includes that a
    /// model error at one place affects all rows there. Infinite without blocks.
    pub fn steadiness(&self, solved: &Solved, own: &Range<usize>) -> f64 {
        if self.pieces.is_empty() {
            return f64::INFINITY;
        }
        let Some(effect) = self.apart(solved, own) else { return f64::INFINITY };
        let mut residual = self.whitened[self.target()].clone();
        for (c, value) in solved.columns.iter().zip(&solved.values) {
            residual.iter_mut().zip(&self.whitened[*c]).for_each(|(residual, column)| *residual -= value * column);
        }
        self.pieces.iter().map(|pieces| self.known_to(pieces, &effect, &residual)).fold(0.0, f64::max)
    }

    /// The same for one set of blocks. Without a block, the effect grows by its rows' residual along the effect
    /// over the effect's power in all others.
    fn known_to(&self, pieces: &[usize], effect: &[f64], residual: &[f64]) -> f64 {
        let count = pieces.iter().max().map_or(0, |last| last + 1);
        let (mut power, mut slope) = (vec![0.0; count], vec![0.0; count]);
        for (i, piece) in pieces.iter().enumerate() {
            if matches!(self.uses[i], Use::Always | Use::Fold(_)) {
                power[*piece] += effect[i] * effect[i];
                slope[*piece] += effect[i] * residual[i];
            }
        }
        let whole: f64 = power.iter().sum();
        let moves = |(power, slope): (&f64, &f64)| (slope / (whole - power).max(LEAST_REST * whole)).powi(2);
        1.0 / power.iter().zip(&slope).map(moves).sum::<f64>()
    }

    /// Contribution of these regressors to a solution, row by row, less what its other regressors can explain of it.
    fn apart(&self, solved: &Solved, own: &Range<usize>) -> Option<Vec<f64>> {
        let others: Vec<usize> =
            (0..solved.columns.len()).filter(|j| !own.contains(j)).map(|j| solved.columns[j]).collect();
        let product =
            |a: usize| own.clone().map(|j| solved.values[j] * self.train[(a, solved.columns[j])]).sum::<f64>();
        let taken = combination(&self.train, &others, &product)?;
        let mut effect = vec![0.0; self.uses.len()];
        let mut add = |c: usize, times: f64| {
            effect.iter_mut().zip(&self.whitened[c]).for_each(|(sum, value)| *sum += times * value);
        };
        own.clone().for_each(|j| add(solved.columns[j], solved.values[j]));
        others.iter().zip(&taken).for_each(|(c, taken)| add(*c, -taken));
        Some(effect)
    }
}

/// Combination of columns nearest to another one, from their products with it.
fn combination(gram: &DMatrix<f64>, columns: &[usize], product: &dyn Fn(usize) -> f64) -> Option<Vec<f64>> {
    let Scaled { cholesky, scale } = factored(gram, columns)?;
    let right = DVector::from_fn(columns.len(), |i, _| product(columns[i]) / scale[i]);
    let found = cholesky.solve(&right);
    Some((0..columns.len()).map(|i| found[i] / scale[i]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::selection::layout::Layout;
    use rand::RngExt;
    use rand::SeedableRng;
    use rand::rngs::StdRng;
    use rand_distr::Distribution;
    use rand_distr::StandardNormal;

    const ROWS: usize = 2000;
    /// Rows of a block.
    const OF_A_PIECE: usize = 50;

    /// A constant and a cause's regressor, solved: significance of the cause by its residual, and by the jackknife.
    fn sure(column: &[f64], y: &[f64]) -> [f64; 2] {
        let layout = Layout { may_stand: true, ..Layout::of(vec![0; ROWS], &vec![true; ROWS], 0.01) };
        let mut system = System::new(&[vec![1.0; ROWS], column.to_vec()], &[], y, &layout, Vec::new());
        system.pieces = vec![(0..ROWS).map(|i| i / OF_A_PIECE).collect()];
        let solved = system.solve(&[]).expect("it can be solved");
        let variance = solved.variance(system.rows) * solved.inverse[(1, 1)];
        [solved.values[1].powi(2) / variance, system.steadiness(&solved, &(1..2))]
    }

    fn noise(rng: &mut StdRng) -> f64 {
        StandardNormal.sample(rng)
    }

    #[test]
    fn what_is_there_all_the_time_is_as_sure_by_both() {
        let mut rng = StdRng::seed_from_u64(11);
        for _ in 0..20 {
            let column: Vec<f64> = (0..ROWS).map(|_| noise(&mut rng)).collect();
            let y: Vec<f64> = column.iter().map(|c| 0.3 * c + noise(&mut rng)).collect();
            let [plain, steady] = sure(&column, &y);
            assert!((0.4..2.5).contains(&(steady / plain)), "{plain} {steady}");
        }
    }

    #[test]
    fn what_single_places_miss_is_no_more_sure_for_having_many_rows() {
        let mut rng = StdRng::seed_from_u64(12);
        let mut fooled = 0;
        for _ in 0..40 {
            // A regressor that is large in every fourth block, in which the model has another error each time.
            let of_piece = |rng: &mut StdRng| -> Vec<f64> { (0..ROWS / OF_A_PIECE).map(|_| noise(rng)).collect() };
            let (shape, missed) = (of_piece(&mut rng), of_piece(&mut rng));
            let at = |all: &[f64], i: usize| if (i / OF_A_PIECE).is_multiple_of(4) { all[i / OF_A_PIECE] } else { 0.0 };
            let column: Vec<f64> = (0..ROWS).map(|i| at(&shape, i)).collect();
            let y: Vec<f64> = (0..ROWS).map(|i| at(&missed, i) + rng.random_range(-0.5..0.5)).collect();
            let [plain, steady] = sure(&column, &y);
            fooled += usize::from(plain > 20.0);
            assert!(steady < 15.0, "{plain} {steady}");
        }
        assert!(fooled > 10, "what is left alone would be sure of it: {fooled}");
    }
}
