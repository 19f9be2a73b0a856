//! Several recordings of one crank: the laws are shared, so all recordings' rows go into one regression; the place of
//! the crank and the grasp on it are each recording's own.
//!
//! Averaging the single fits is not the same: two recordings that each show only the sum of two parameters can show both together.

use super::friction::{Friction, Sensed, friction};
use super::path_coordinate::Rows;
use super::single_fit::{Prepared, Seen, describe, see};
use crate::segment::{Method, Segmentation};
use foundation::estimate::{Correlated, EstimateError, Fit, Parameter};
use foundation::tasks::Thresholds;
use haptics::recording::Recording;

/// Every recording's own fit and segmentation, and the shared parameters from all of them at once.
pub struct JointFit {
    /// In the order of the recordings.
    pub fits: Vec<Fit>,
    /// In the order of the recordings.
    pub segmentations: Vec<Segmentation>,
    /// Weight, friction and inertia.
    pub shared: Vec<Parameter>,
    /// Covariance of the shared parameters.
    pub correlated: Correlated,
}

/// Fits several recordings of the same crank. Facts stated in the first one's sidecar hold for all.
pub fn fit_jointly(
    method: Method,
    recordings: &[Recording],
    thresholds: Option<Thresholds>,
) -> Result<JointFit, EstimateError> {
    let prepared = recordings.iter().map(Prepared::of).collect::<Result<Vec<_>, _>>()?;
    refit_jointly(method, recordings, &prepared, thresholds)
}

/// [`fit_jointly`] of recordings that were prepared before, one a recording.
pub fn refit_jointly(
    method: Method,
    recordings: &[Recording],
    prepared: &[Prepared],
    thresholds: Option<Thresholds>,
) -> Result<JointFit, EstimateError> {
    let all = || recordings.iter().zip(prepared);
    let seen = all().map(|(r, p)| see(method, r, p, thresholds)).collect::<Result<Vec<_>, _>>()?;
    let fits = all().zip(&seen).map(|((r, p), s)| describe(r, p, s)).collect::<Result<Vec<_>, _>>()?;
    let rows = Rows::join(seen.iter().map(|s| &s.rows));
    let mut joint = friction(&recordings[0], &rows)?;
    joint.geometry_errors = geometry_errors(&seen, &joint);
    let sensed = sensed(&seen);
    let mut shared = joint.parameters(&sensed, &rows);
    for parameter in shared.iter_mut().filter(|p| p.identified && p.samples > 0) {
        parameter.how = format!("{}, {} recordings in one regression", parameter.how, recordings.len());
    }
    let correlated = joint.correlated(&sensed, &rows);
    Ok(JointFit { fits, segmentations: seen.into_iter().map(|s| s.segmentation).collect(), shared, correlated })
}

/// Each recording pulls at the joint fit with its share of the rows; their errors have nothing to do with each other.
fn pooled(seen: &[Seen], error: impl Fn(&Seen) -> f64) -> f64 {
    let total: f64 = seen.iter().map(|s| s.rows.len() as f64).sum();
    seen.iter().map(|s| (s.rows.len() as f64 / total * error(s)).powi(2)).sum::<f64>().sqrt()
}

fn geometry_errors(seen: &[Seen], joint: &Friction) -> Vec<f64> {
    let of = |law: usize| {
        pooled(seen, |s| {
            let column = s.friction.used.iter().position(|l| *l == law);
            column.map_or(0.0, |c| s.friction.geometry_errors[c])
        })
    };
    joint.used.iter().map(|law| of(*law)).collect()
}

fn sensed(seen: &[Seen]) -> Sensed {
    let total: f64 = seen.iter().map(|s| s.rows.len() as f64).sum();
    let mean = |value: &dyn Fn(&Seen) -> f64| seen.iter().map(|s| s.rows.len() as f64 * value(s)).sum::<f64>() / total;
    Sensed {
        samples: seen.iter().map(|s| s.held.turning.len()).sum(),
        // The same sensors: their steps do not average out between recordings.
        resolution_n: mean(&|s| s.held.resolution_n),
        bias_error_n: pooled(seen, |s| s.held.bias_error_n.unwrap_or(0.0)),
        radius_m: mean(&|s| s.geometry.radius_m),
    }
}
