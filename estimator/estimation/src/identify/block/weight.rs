//! Weight of a carried block, and the constraint on it while it is carried.

use super::signals::{Blocks, MAIN, object};
use crate::constraint::{Carry, carried};
use crate::regression::bootstrap::block_bootstrap;
use crate::regression::robust::{RobustFit, robust};
use foundation::estimate::{Constraint, Correlated, EstimateError, Parameter};

impl Blocks<'_> {
    /// Constraint of a carried block, if anything but the hand held it.
    pub(super) fn constraint(&self, number: usize) -> Option<Constraint> {
        carried(&Carry {
            object: &object(number),
            recording: &self.recording.name,
            signals: &self.signals,
            samples: &self.shown(MAIN, number),
            bias_n: self.levels.bias_n[0] + self.levels.bias_n[1],
            bias_error_n: self.bias_error().hypot(std::f64::consts::SQRT_2 * self.resolution_n),
            gravity: self.recording.meta.gravity(),
        })
    }

    /// Weight: mean of the summed vertical forces over the carry, accelerations taken out.
    pub(super) fn weight(&self, number: usize) -> Result<[Parameter; 2], EstimateError> {
        let samples = self.shown(MAIN, number);
        let rows = self.rows(&samples);
        let lift: Vec<f64> = rows.iter().map(|i| self.lift[*i]).collect();
        let acceleration: Vec<f64> = rows.iter().map(|i| self.acceleration_y[*i]).collect();
        let columns = [vec![1.0; rows.len()], acceleration];
        let RobustFit { fit, weights, left_out } = robust(&columns, &lift, None)?;
        let systematic = self.bias_error().hypot(std::f64::consts::SQRT_2 * self.resolution_n);
        let error = fit.std_errors[0].hypot(systematic);
        let resampled = block_bootstrap(&columns, &lift, weights.as_deref(), &fit).map(|b| b[0].hypot(systematic));
        let gravity = self.recording.meta.gravity();
        let (name, n) = (object(number), samples.len());
        let ringing = if left_out > 0.0 {
            format!("; the contacts rang in {:.1} % of the samples, which do not count", 100.0 * left_out)
        } else {
            String::new()
        };
        let how = format!(
            "mean of the summed vertical tip forces while carried, 5 % at each end left out, accelerations and the free-motion bias \
             taken out{ringing}"
        );
        let mass = "weight divided by gravity";
        Ok([
            Parameter::identified(&name, "weight_N", fit.values[0], error, n, &how).with_bootstrap(resampled),
            Parameter::identified(&name, "mass_kg", fit.values[0] / gravity, error / gravity, n, mass)
                .with_bootstrap(resampled.map(|b| b / gravity)),
        ])
    }
}

/// They are one thing: a statement about either holds for both.
pub(super) fn weight_and_mass(weight: &Parameter, mass: &Parameter) -> Option<Correlated> {
    let (a, b) = (weight.std_error?, mass.std_error?);
    Some(Correlated {
        parameters: vec![weight.full_name(), mass.full_name()],
        values: vec![weight.value?, mass.value?],
        covariance: vec![vec![a * a, a * b], vec![a * b, b * b]],
        shown_below: vec![f64::INFINITY; 2],
    })
}
