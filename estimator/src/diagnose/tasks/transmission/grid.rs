//! Search grids for half gaps and presliding distances: over the input's travel, then finer around the values found.

use crate::diagnose::data::limits::MOST_ROUNDS;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::profile_likelihood::known;
use crate::diagnose::selection::refinement::{Refinement, refined};
use foundation::estimate::EstimateError;

/// Tried half gaps, as shares of the input's range.
/// Choice: no case of the ablation reads it.
const GAPS: Axis = Axis::geometric(3e-3, 0.1, 14);
/// Standard error, as a share of the distance between tried values, up to which the grid is refined. Closer values
/// cannot be separated.
/// Choice: no case of the ablation reads it.
const SHARPER: f64 = 0.3;

/// Tried half gaps or presliding distances, finer around a value found.
pub struct Tried {
    id: &'static str,
    values: Vec<f64>,
}

impl Tried {
    pub fn new(id: &'static str, range: f64) -> Self {
        Self { id, values: GAPS.values().map(|share| share * range).collect() }
    }

    /// Tried values in the unit of the input, in order.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Adds values around the one found, closer with a smaller step; false if finer values would not improve the estimate.
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
        self.values.extend(GAPS.around(found, 1.0, step));
        self.values.sort_by(f64::total_cmp);
        self.values.dedup_by(|a, b| (*a - *b).abs() < 1e-9 * *b);
        true
    }
}

/// A comparison over tried values.
struct Closer<'a> {
    tried: &'a mut [Tried],
    once: &'a dyn Fn(&[Tried]) -> Result<ChannelFit, EstimateError>,
    step: f64,
}

impl Refinement for Closer<'_> {
    fn compare(&mut self, _: Option<ChannelFit>) -> Result<ChannelFit, EstimateError> {
        (self.once)(self.tried)
    }

    fn close_in(&mut self, found: &ChannelFit, _: usize) -> bool {
        let step = self.step;
        self.step /= 3.0;
        self.tried.iter_mut().map(|t| t.close_in(found, step)).fold(false, |any, one| any | one)
    }
}

/// Compares repeatedly, with a finer grid around the values found.
pub fn closer(
    tried: &mut [Tried],
    once: &dyn Fn(&[Tried]) -> Result<ChannelFit, EstimateError>,
) -> Result<ChannelFit, EstimateError> {
    refined(&mut Closer { tried, once, step: 1.0 }, MOST_ROUNDS)
}
