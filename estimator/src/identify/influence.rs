//! Errors of a regression's values from what every sample adds to them.
//!
//! The influence of sample i on value j is `aᵢⱼ wᵢ rᵢ`, with `a = (XᵀWX)⁻¹ x` and the residual r. The residual of a sample that
//! pulls the fit towards itself is too small: it is divided by √(1 − leverage) (HC2, `MacKinnon` & White 1985). A value that hangs
//! on few samples is known with few degrees of freedom, however many samples there are: (Σ a²)²/Σ a⁴ (Bell & `McCaffrey` 2002, in the
//! limit of small leverages). Autocorrelation is counted by [`super::long_run`].

use super::long_run::{inflation, long_run};
use nalgebra::DMatrix;

/// The influences are summed in blocks down to about this many before the long-run variance is taken.
const BLOCKS: usize = 192;
/// No residual is trusted to be shrunk by more than this.
const LARGEST_LEVERAGE: f64 = 0.9;

/// A solved regression: p columns of n samples scaled by `scales`, and the inverse of its normal matrix in scaled columns.
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
        let (mut x, mut a) = (vec![0.0; p], vec![0.0; p]);
        for i in 0..n {
            let weight = self.weights.map_or(1.0, |w| w[i].max(0.0));
            if weight == 0.0 {
                continue;
            }
            for (x, (column, scale)) in x.iter_mut().zip(self.columns.iter().zip(self.scales)) {
                *x = column[i] / scale;
            }
            for (j, a) in a.iter_mut().enumerate() {
                *a = self.inverse.column(j).iter().zip(&x).map(|(m, x)| m * x).sum::<f64>() * weight;
            }
            let leverage: f64 = a.iter().zip(&x).map(|(a, x)| a * x).sum();
            let residual = self.residuals[i] / (1.0 - leverage.clamp(0.0, LARGEST_LEVERAGE)).sqrt();
            for j in 0..p {
                series[j][i / block] += a[j] * residual;
                power[j] += (a[j] * residual).powi(2);
                squares[j] += a[j] * a[j];
                fourths[j] += a[j].powi(4);
            }
        }
        let count = |j: usize| if fourths[j] > 0.0 { squares[j] * squares[j] / fourths[j] } else { n as f64 };
        Influence { samples: (0..p).map(count).collect(), series, power }
    }
}
