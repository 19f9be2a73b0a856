//! Turning of a barrel in the grip, held above or below its middle, while a cable pulls at it, and the shift of its
//! middle by that.
//!
//! The fingers stick to its sides: as it turns, one rises and the other sinks. The height of the grip above its middle
//! follows from the balance of moments: the couple of the fingers' vertical forces equals the moment of the pull about
//! the middle of the grip.

use super::signals::Signals;
use crate::identify::limits::LEAST_FIT_ROWS;
use crate::identify::pads::CLOSED_GRIP_SHARE;
use crate::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use haptics::Vec2;

/// Largest distance of the grip from the barrel's middle, as a share of its size: a larger estimate is no balance of a stiff barrel.
/// Choice: no case of the ablation reads it.
const FARTHEST: f64 = 0.2;

/// The turning of one recording.
#[derive(Clone, Debug, Default)]
pub struct GripRotation {
    /// Angle against how it stood on the floor, rad, one a sample of the recording; empty where that is not known.
    angle_rad: Vec<f64>,
    /// Height of the grip above the barrel's middle, m, and its standard error.
    pub above_m: (f64, f64),
}

impl GripRotation {
    /// From the samples while it hangs; `give`: of both fingers together along x and y, m/N.
    pub fn of(signals: &Signals, hanging: &[usize], give: Vec2) -> Result<Self, EstimateError> {
        let held = signals.held();
        let first = hanging.first().copied().unwrap_or(0);
        let closed = |i: &usize| *i < first && signals.grip_n[*i] > CLOSED_GRIP_SHARE * signals.levels.usual_grip_n;
        let standing: Vec<usize> = held.into_iter().filter(closed).collect();
        if standing.is_empty() || hanging.len() < LEAST_FIT_ROWS {
            return Ok(Self::default());
        }
        // The give of one finger is twice that of both together.
        let force = |i: usize| signals.finger_n[1][i] - signals.finger_n[0][i];
        let apart = |i: usize| {
            let by = 2.0 * give.component_mul(&force(i));
            Vec2::new(signals.width_m[i] - by.x, signals.rise_m[i] - by.y)
        };
        let level = standing.iter().map(|i| apart(*i).y).sum::<f64>() / standing.len() as f64;
        let angle_rad: Vec<f64> =
            (0..signals.time_s.len()).map(|i| (apart(i).y - level) / apart(i).x.max(f64::MIN_POSITIVE)).collect();
        let couple: Vec<f64> = hanging.iter().map(|&i| 0.5 * apart(i).perp(&force(i))).collect();
        let pull = |i: &usize| {
            let (sin, cos) = angle_rad[*i].sin_cos();
            signals.net_n[*i].dot(&Vec2::new(cos, sin))
        };
        let fit = least_squares(&[hanging.iter().map(pull).collect(), vec![1.0; hanging.len()]], &couple, None)?;
        let above_m = (fit.values[0], fit.std_errors[0]);
        let farthest_m = FARTHEST * signals.task.object_m();
        let seen = fit.identified[0] && above_m.0.abs() < farthest_m && above_m.1 < farthest_m;
        Ok(if seen { Self { angle_rad, above_m } } else { Self::default() })
    }

    /// The same with the grip one standard error farther up.
    pub fn higher(&self) -> Self {
        Self { above_m: (self.above_m.0 + self.above_m.1, self.above_m.1), ..self.clone() }
    }

    /// Displacement of the barrel's middle against that of the fingers by turning, m.
    pub fn shift(&self, i: usize) -> Vec2 {
        let Some(angle) = self.angle_rad.get(i) else { return Vec2::zeros() };
        Vec2::new(angle.sin(), 1.0 - angle.cos()) * self.above_m.0
    }
}
