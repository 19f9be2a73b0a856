//! Errors of a regression's values from the influence of every sample on them.
//!
//! The influence of sample i on value j is `aᵢⱼ wᵢ rᵢ`, with `a = (XᵀWX)⁻¹ x` and the residual r. The residual of a sample that
//! pulls the fit towards itself is too small: it is divided by √(1 − leverage) (HC2, `MacKinnon` & White 1985). A value that hangs
//! on few samples is known with few degrees of freedom, however many samples there are: (Σ a²)²/Σ a⁴ (Bell & `McCaffrey` 2002, in the
//! limit of small leverages). Autocorrelation is counted by [`super::long_run_variance`].

use super::long_run_variance::{inflation, long_run};
use nalgebra::DMatrix;
use std::ops::Range;

/// Least number of blocks to which the influences of a long series are summed before the long-run variance is taken.
const BLOCKS: usize = 192;
/// Largest leverage by which a residual is corrected.
const LARGEST_LEVERAGE: f64 = 0.9;

/// A solved regression: p regressors of n samples scaled by `scales`, and the inverse of its normal matrix in scaled
/// regressors.
pub(super) struct Solved<'a> {
    pub(super) columns: &'a [Vec<f64>],
    pub(super) scales: &'a [f64],
    pub(super) weights: Option<&'a [f64]>,
    pub(super) residuals: &'a [f64],
    pub(super) inverse: &'a DMatrix<f64>,
}

/// Influences summed over blocks (p series) and how many samples each value hangs on.
struct Influence {
    series: Vec<Vec<f64>>,
    samples: Vec<f64>,
    /// Sum of the squares of the single samples' influences.
    power: Vec<f64>,
}

impl Solved<'_> {
    /// Covariance of the scaled values, inflated so that 1.96 standard errors cover 95 %, and the largest correlation time.
    ///
    /// Correlations between values come from the samples one by one (White 1980), which many samples carry better than few waves.
    pub(super) fn covariance(&self) -> (DMatrix<f64>, f64) {
        let p = self.columns.len();
        let influence = self.influence();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let mut covariance = DMatrix::from_fn(p, p, |i, j| dot(&influence.series[i], &influence.series[j]));
        let mut longest: f64 = 1.0;
        let grow: Vec<f64> = (0..p)
            .map(|j| {
                let found = long_run(&influence.series[j]);
                // Counted in samples, not in blocks of them.
                let time = found.variance_of_sum / influence.power[j];
                longest = longest.max(if time.is_finite() { time } else { 1.0 });
                let freedom = found.freedom.min(influence.samples[j]);
                let factor = found.variance_of_sum * inflation(freedom) / covariance[(j, j)];
                if factor.is_finite() { factor.sqrt() } else { 1.0 }
            })
            .collect();
        for (i, j) in (0..p).flat_map(|i| (0..p).map(move |j| (i, j))) {
            covariance[(i, j)] *= grow[i] * grow[j];
        }
        (covariance, longest)
    }

    fn influence(&self) -> Influence {
        let (n, p) = (self.residuals.len(), self.columns.len());
        let block = (n / BLOCKS).max(1);
        let mut series = vec![vec![0.0; n.div_ceil(block)]; p];
        let (mut squares, mut fourths, mut power) = (vec![0.0; p], vec![0.0; p], vec![0.0; p]);
        let mut lanes = Lanes { x: vec![[0.0; LANES]; p], a: vec![[0.0; LANES]; p], residual: [0.0; LANES] };
        for first in (0..n).step_by(LANES) {
            let end = (first + LANES).min(n);
            self.fill(first..end, &mut lanes);
            // Sums are added up sample by sample, whatever was computed side by side.
            for (j, a) in lanes.a.iter().enumerate() {
                for (i, (a, residual)) in (first..end).zip(a.iter().zip(&lanes.residual)) {
                    let added = a * residual;
                    series[j][i / block] += added;
                    power[j] += added * added;
                    squares[j] += a * a;
                    fourths[j] += (a * a) * (a * a);
                }
            }
        }
        let count = |j: usize| if fourths[j] > 0.0 { squares[j] * squares[j] / fourths[j] } else { n as f64 };
        Influence { samples: (0..p).map(count).collect(), series, power }
    }

    /// Scaled columns, influences and residuals of at most [`LANES`] samples. One of no weight has no influence.
    fn fill(&self, samples: Range<usize>, lanes: &mut Lanes) {
        let here = samples.len();
        let mut weight = [1.0; LANES];
        if let Some(weights) = self.weights {
            weight.iter_mut().zip(&weights[samples.clone()]).for_each(|(to, w)| *to = w.max(0.0));
        }
        for (x, (column, scale)) in lanes.x.iter_mut().zip(self.columns.iter().zip(self.scales)) {
            x.iter_mut().zip(&column[samples.clone()]).for_each(|(x, v)| *x = v / scale);
        }
        let mut leverage = [0.0; LANES];
        for (j, a) in lanes.a.iter_mut().enumerate() {
            *a = [0.0; LANES];
            for (m, x) in self.inverse.column(j).iter().zip(&lanes.x) {
                a.iter_mut().zip(x).for_each(|(a, x)| *a += m * x);
            }
            a.iter_mut().zip(&weight).for_each(|(a, w)| *a *= w);
            leverage.iter_mut().zip(a.iter().zip(&lanes.x[j])).for_each(|(l, (a, x))| *l += a * x);
        }
        let residuals = lanes.residual[..here].iter_mut().zip(&self.residuals[samples]).zip(leverage);
        residuals.for_each(|((to, r), leverage)| *to = r / (1.0 - leverage.clamp(0.0, LARGEST_LEVERAGE)).sqrt());
    }
}

/// Number of samples that are computed side by side.
const LANES: usize = 16;

/// Result of [`Solved::fill`] for some samples: p scaled regressors and influences, and the residuals with their
/// leverage taken out.
struct Lanes {
    x: Vec<[f64; LANES]>,
    a: Vec<[f64; LANES]>,
    residual: [f64; LANES],
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};

    /// The sums of the module's head, written out for one sample after the other.
    fn written_out(solved: &Solved<'_>, j: usize) -> (f64, f64) {
        let (mut sum, mut power) = (0.0, 0.0);
        for i in 0..solved.residuals.len() {
            let weight = solved.weights.map_or(1.0, |w| w[i].max(0.0));
            let x = |k: usize| solved.columns[k][i] / solved.scales[k];
            let p = solved.columns.len();
            let a = |j: usize| weight * (0..p).map(|k| solved.inverse[(k, j)] * x(k)).sum::<f64>();
            let leverage: f64 = (0..p).map(|k| a(k) * x(k)).sum();
            let influence = a(j) * solved.residuals[i] / (1.0 - leverage.clamp(0.0, LARGEST_LEVERAGE)).sqrt();
            sum += influence;
            power += influence * influence;
        }
        (sum, power)
    }

    #[test]
    fn influences_side_by_side_are_those_of_the_formula() {
        let mut rng = StdRng::seed_from_u64(12);
        for (n, weighted) in [(1, false), (15, true), (16, false), (17, true), (500, true), (1000, false)] {
            let mut draw = |low: f64| -> Vec<f64> { (0..n).map(|_| rng.random_range(low..1.0)).collect() };
            let columns = [draw(-1.0), draw(-1.0), draw(0.5)];
            let residuals = draw(-1.0);
            // A third of the samples has zero weight.
            let weights: Vec<f64> = draw(-0.5).into_iter().map(|w| w.max(0.0)).collect();
            let inverse = DMatrix::from_fn(3, 3, |i, j| if i == j { 0.5 } else { 0.1 });
            let weights = weighted.then_some(&weights[..]);
            let (columns, scales) = (&columns[..], &[2.0, 3.0, 0.7][..]);
            let solved = Solved { columns, scales, weights, residuals: &residuals, inverse: &inverse };
            let found = solved.influence();
            for j in 0..3 {
                let (sum, power) = written_out(&solved, j);
                let added: f64 = found.series[j].iter().sum();
                assert!((added - sum).abs() < 1e-12 * f64::from(n), "{n}, {j}: {added} and {sum}");
                assert!((found.power[j] / power - 1.0).abs() < 1e-12, "{n}, {j}: {} and {power}", found.power[j]);
            }
        }
    }
}
