//! Plain least squares over the rows along the motion, each weighted by the fourth power of its direction's estimate.

use super::regression_data::{Model, Place, Row, Track};
use super::row_means::column;
use estimation::regression::linear::{LinearFit, Values, least_squares, least_squares_values};
use foundation::estimate::EstimateError;
use haptics::law::Effect;

/// Rows for plain fits, with the measured forces less the known ones.
pub struct PlainFit<'a> {
    track: &'a Track,
    y: Vec<f64>,
    weight: Vec<f64>,
}

impl<'a> PlainFit<'a> {
    /// `fixed`: laws that are completely known.
    pub fn of(track: &'a Track, fixed: &Model) -> Self {
        let known: Vec<Vec<f64>> = fixed.iter().map(|effect| column(track, effect)).collect();
        let y =
            track.rows.iter().enumerate().map(|(i, r)| r.target - known.iter().map(|k| k[i]).sum::<f64>()).collect();
        Self { track, y, weight: weights(track) }
    }

    pub fn laws(&self, laws: &[Effect]) -> Vec<Vec<f64>> {
        laws.iter().map(|effect| column(self.track, effect)).collect()
    }

    /// Regressor over the rows along the motion, 0 in all others.
    pub fn rows(&self, of: &dyn Fn(&Row) -> f64) -> Vec<f64> {
        self.track.rows.iter().map(|r| if r.place == Place::Along { of(r) } else { 0.0 }).collect()
    }

    pub fn fit(&self, columns: &[Vec<f64>]) -> Result<Values, EstimateError> {
        least_squares_values(columns, &self.y, Some(&self.weight))
    }

    /// The same with standard errors.
    pub fn fit_with_errors(&self, columns: &[Vec<f64>]) -> Result<LinearFit, EstimateError> {
        least_squares(columns, &self.y, Some(&self.weight))
    }
}

/// Weight of a row in the sum of squares.
pub fn weights(track: &Track) -> Vec<f64> {
    track.rows.iter().map(|r| if r.place == Place::Along { r.motion.direction.powi(4) } else { 0.0 }).collect()
}
