//! Give of the pads: one stiffness out of several measurements.

use super::signals::Blocks;
use crate::identify::limits::SIGNIFICANT;
use foundation::estimate::Parameter;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// A measured give of a pad, m/N, with its standard error by covariance and by resampling.
struct Give {
    m_per_n: f64,
    error: f64,
    resampled: Option<f64>,
    rows: usize,
}

impl Blocks<'_> {
    /// Stiffness of one pad: both give under the grip, so the width falls by 2 F / k. Blocks averaged by their errors.
    pub(super) fn pad_stiffness(&self, count: usize) -> Parameter {
        let gives = (1..=count).filter_map(|number| self.pads(number).ok()?).map(|pads| Give {
            m_per_n: pads.give_m_per_n,
            error: pads.give_error,
            resampled: pads.resampled.map(|(_, give)| give),
            rows: pads.rows,
        });
        pad_parameter("stiffness_N_m", gives, "the grip varied too little to tell the pads' give")
    }
}

/// A stiffness from several measurements of a give, averaged by their errors.
///
/// A scatter larger than their errors means that the errors are too small by that ratio (Birge 1932).
fn pad_parameter(name: &str, gives: impl Iterator<Item = Give>, missing: &str) -> Parameter {
    let gives: Vec<Give> = gives.filter(|g| g.error > 0.0 && g.error.is_finite()).collect();
    let weights: f64 = gives.iter().map(|g| g.error.powi(-2)).sum();
    let give = gives.iter().map(|g| g.m_per_n * g.error.powi(-2)).sum::<f64>() / weights;
    let scatter: f64 = gives.iter().map(|g| ((g.m_per_n - give) / g.error).powi(2)).sum();
    let freedom = gives.len().saturating_sub(1) as f64;
    // A ratio below its own 95 % limit is chance.
    let birge = if freedom > 0.0 && scatter > chi_square_95(freedom) { (scatter / freedom).sqrt() } else { 1.0 };
    let error = weights.powf(-0.5) * birge;
    // The same weighted mean with each one's own resampled error.
    let resampled: Option<f64> = gives.iter().map(|g| Some((g.resampled? * g.error.powi(-2)).powi(2))).sum();
    let resampled = resampled.map(|sum| sum.sqrt() / weights * birge);
    let rows = gives.iter().map(|g| g.rows).sum();
    if weights > 0.0 && give > SIGNIFICANT * error {
        let how = "give of the pads under load, one pad";
        Parameter::identified("pad", name, 1.0 / give, error / (give * give), rows, how)
            .with_bootstrap(resampled.map(|r| r / (give * give)))
    } else {
        Parameter::unidentified("pad", name, rows, missing)
    }
}

/// 95 % quantile of χ².
fn chi_square_95(freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(f64::INFINITY, |d| d.inverse_cdf(0.95))
}
