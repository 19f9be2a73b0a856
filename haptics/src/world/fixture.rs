//! Fixed objects of a world that yield: the membrane and the toggle switch.

use super::error::{WorldError, finite, not_negative, positive, range_error};
use crate::Vec2;
use crate::law::object::{MembraneLaw, ToggleCurve};
use serde::{Deserialize, Serialize};

/// A level sheet, held at both ends, that a needle pierces from above (the bottom of an inverted cup in the thesis).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    /// Middle of the sheet in the world, m.
    pub center_m: Vec2,
    /// Half of its width, m, positive.
    pub half_width_m: f64,
    /// Sideways stiffness of the rim of a hole, N/m, positive.
    pub side_stiffness_n_m: f64,
    /// Force over insertion, with its history.
    pub law: MembraneLaw,
}

/// A lever with a round knob that snaps from one side to the other. Its coordinate is the way of the knob along its arc, m,
/// zero when the lever stands upright, positive to the right.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Switch {
    /// Axis of the lever in the world, m.
    pub pivot_m: Vec2,
    /// From the axis to the middle of the knob, m, positive.
    pub lever_m: f64,
    /// Radius of the knob, m, positive.
    pub knob_radius_m: f64,
    /// Mass at the knob, kg, positive.
    pub mass_kg: f64,
    /// Damping at the knob, N s/m, ≥ 0.
    pub damping_n_s_m: f64,
    /// Friction of the knob against the pads.
    pub finger_friction: f64,
    /// Force over displacement, as captured.
    pub curve: ToggleCurve,
    /// Starting position, m along the arc.
    pub start_m: f64,
}

impl Membrane {
    pub(super) fn check(&self) -> Result<(), WorldError> {
        let law = &self.law;
        finite("the membrane", "center_m[0]", self.center_m.x)?;
        finite("the membrane", "center_m[1]", self.center_m.y)?;
        positive("the membrane", "half_width_m", self.half_width_m)?;
        positive("the membrane", "side_stiffness_n_m", self.side_stiffness_n_m)?;
        positive("the membrane", "law.stiffness_n_m", law.stiffness_n_m)?;
        positive("the membrane", "law.puncture_n", law.puncture_n)?;
        not_negative("the membrane", "law.cubic_n_m3", law.cubic_n_m3)?;
        not_negative("the membrane", "law.give", law.give)?;
        not_negative("the membrane", "law.friction_n", law.friction_n)?;
        not_negative("the membrane", "law.drag_n_s_m", law.drag_n_s_m)?;
        if law.friction_n >= law.puncture_n {
            return Err(range_error("the membrane", "law.friction_n", law.friction_n, "below law.puncture_n"));
        }
        Ok(())
    }
}

impl Switch {
    /// Middle of the knob, m in the world, when it is at `at_m` along its arc.
    pub fn knob_in_world(&self, at_m: f64) -> Vec2 {
        let (sin, cos) = (at_m / self.lever_m).sin_cos();
        self.pivot_m + Vec2::new(sin, cos) * self.lever_m
    }

    pub(super) fn check(&self) -> Result<(), WorldError> {
        finite("the switch", "pivot_m[0]", self.pivot_m.x)?;
        finite("the switch", "pivot_m[1]", self.pivot_m.y)?;
        positive("the switch", "lever_m", self.lever_m)?;
        positive("the switch", "knob_radius_m", self.knob_radius_m)?;
        positive("the switch", "mass_kg", self.mass_kg)?;
        not_negative("the switch", "damping_n_s_m", self.damping_n_s_m)?;
        not_negative("the switch", "finger_friction", self.finger_friction)?;
        finite("the switch", "start_m", self.start_m)?;
        match self.curve.fault() {
            Some(must) => {
                Err(range_error("the switch", "curve of so many points", self.curve.points.len() as f64, must))
            }
            None => Ok(()),
        }
    }
}
