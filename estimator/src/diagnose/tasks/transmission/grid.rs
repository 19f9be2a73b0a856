//! Search grids for half gaps and presliding distances: over the input's travel, then finer around the values found.

use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::profile_likelihood::known;
use foundation::estimate::EstimateError;

/// Tried half gaps, as shares of the input's range.
const GAPS: [f64; 14] =
    [0.003, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.018, 0.022, 0.027, 0.033, 0.042, 0.055, 0.075, 0.1];
/// Refinement steps around a half gap or presliding distance found, as shares of it, and number of steps to either
/// side.
const GAP_REFINEMENT_STEPS: [f64; 3] = [0.05, 0.01, 0.002];
const STEPS_TO_EITHER_SIDE: i32 = 5;
/// Standard error, as a share of the distance between tried values, up to which the grid is refined. Closer values
/// cannot be separated.
const SHARPER: f64 = 0.3;

/// Tried half gaps or presliding distances, finer around a value found.
pub struct Tried {
    id: &'static str,
    values: Vec<f64>,
}

impl Tried {
    pub fn new(id: &'static str, range: f64) -> Self {
        Self { id, values: GAPS.map(|share| share * range).to_vec() }
    }

    /// Tried values in the unit of the input, in order.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Adds values in these steps around the one found; false if finer values would not improve the estimate.
    fn close_in(&mut self, study: &ChannelFit, step: f64) -> bool {
        let Some(k) = study.chosen.iter().position(|c| study.candidates[c.candidate].id == self.id) else {
            return false;
        };
        let found = study.candidates[study.chosen[k].candidate].searched[0].value;
        let apart = self.values.iter().map(|v| (v - found).abs()).filter(|d| *d > 1e-9 * found);
        let nearest = apart.fold(f64::INFINITY, f64::min);
        if known(study, k, 0).std_error > SHARPER * nearest {
            return false;
        }
        let more = (-STEPS_TO_EITHER_SIDE..=STEPS_TO_EITHER_SIDE)
            .filter(|k| *k != 0)
            .map(|k| found * (1.0 + f64::from(k) * step));
        self.values.extend(more);
        self.values.sort_by(f64::total_cmp);
        self.values.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * *b);
        true
    }
}

/// Compares repeatedly, with a finer grid around the values found.
pub fn closer(
    tried: &mut [Tried],
    once: &dyn Fn(&[Tried]) -> Result<ChannelFit, EstimateError>,
) -> Result<ChannelFit, EstimateError> {
    let mut study = once(tried)?;
    for step in GAP_REFINEMENT_STEPS {
        let more = tried.iter_mut().map(|t| t.close_in(&study, step)).fold(false, |any, one| any | one);
        if !more {
            break;
        }
        study = once(tried)?;
    }
    Ok(study)
}
