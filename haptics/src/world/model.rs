//! The immutable description of a virtual world: the content of a world file.

use super::block::Block;
use super::fixture::{Membrane, Switch};
use super::limits::SCHEMA;
use super::mechanism_path::MechanismPath;
use super::plane::Plane;
use crate::Vec2;
use crate::hand::Hand;
use crate::law::contact::{Cushion, Densification, FingertipSlip, StiffnessHardening, VelocityLoss};
use crate::law::{Coordinate, Effect};
use serde::{Deserialize, Serialize};

/// A virtual world. Build or load it, then [`World::check`] it; `step` never changes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct World {
    /// File format version, [`SCHEMA`].
    #[serde(default = "schema")]
    pub schema: u32,
    /// Name for people.
    pub name: String,
    /// Downward acceleration, m/s².
    #[serde(default = "gravity")]
    pub gravity_m_s2: f64,
    /// Tilt of the whole set-up, rad: gravity points along (sin, −cos) of it.
    #[serde(default)]
    pub tilt_rad: f64,
    /// The hand that touches it.
    #[serde(default)]
    pub hand: Hand,
    /// The fingertips.
    #[serde(default)]
    pub pad: Pad,
    /// A table under everything, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<Floor>,
    /// A fixed plane at any angle, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plane: Option<Plane>,
    /// Movable rectangular blocks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blocks: Vec<Block>,
    /// A crank, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub crank: Option<Crank>,
    /// A sheet that a needle can pierce, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub membrane: Option<Membrane>,
    /// A toggle switch, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub switch: Option<Switch>,
    /// A mechanism with one degree of freedom that is driven directly, if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mechanism: Option<Mechanism>,
    /// Sources of the numbers: nothing here is guessed without saying so.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub provenance: Vec<Provenance>,
}

/// Compliant fingertip pad: a spring and damper with friction (closed-cell foam in the thesis).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pad {
    /// Normal stiffness, N/m, positive.
    pub stiffness_n_m: f64,
    /// Hardening of the normal stiffness, N/m³, ≥ 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub cubic_n_m3: f64,
    /// Hertz's part of the normal force, N/m^1.5, ≥ 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub hertz_n_m15: f64,
    /// Thickness of the foam, m, positive: towards it the pad gets hard, and cannot be pressed through (see [`Densification`]).
    #[serde(default = "foam_m")]
    pub thickness_m: f64,
    /// Normal damping, N s/m, ≥ 0.
    pub damping_n_s_m: f64,
    /// Tangential stiffness of the sticking pad, N/m, positive.
    pub shear_stiffness_n_m: f64,
    /// Tangential damping of the sticking pad, N s/m, ≥ 0.
    pub shear_damping_n_s_m: f64,
    /// Height of the pad's flat face, m, ≥ 0: it keeps the pressed object from turning. 0: it touches at a point.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub face_m: f64,
    /// A slip of the held object, at a given time and over a given way; absent: it slips when friction says so.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slip: Option<FingertipSlip>,
}

impl Default for Pad {
    fn default() -> Self {
        Self {
            stiffness_n_m: 2500.0,
            cubic_n_m3: 0.0,
            hertz_n_m15: 0.0,
            thickness_m: foam_m(),
            damping_n_s_m: 1.5,
            shear_stiffness_n_m: 1500.0,
            shear_damping_n_s_m: 1.5,
            face_m: 0.0,
            slip: None,
        }
    }
}

impl Pad {
    /// The pad's normal force over its compression.
    pub fn elastic(&self) -> Cushion {
        Cushion {
            spring: StiffnessHardening { k1: self.stiffness_n_m, k3: self.cubic_n_m3, hertz: self.hertz_n_m15 },
            end: Densification::of(self.thickness_m, self.stiffness_n_m),
        }
    }
}

// serde hands over a reference.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// A horizontal table.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Floor {
    /// Height of its surface, m.
    pub height_m: f64,
    /// Friction coefficient against blocks and fingers.
    pub friction: f64,
    /// Contact stiffness per contact point, N/m.
    pub stiffness_n_m: f64,
    /// Contact damping per contact point, N s/m.
    pub damping_n_s_m: f64,
    /// Measured velocity loss at an impact: it stands in for damping and friction under blocks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub loss: Option<VelocityLoss>,
}

/// A handle on an arm about a fixed axis. The handle keeps upright on its own bearing, as a block held by the pads does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Crank {
    /// Axis in the world, m.
    pub center_m: Vec2,
    /// Arm length, m, positive.
    pub radius_m: f64,
    /// Width of the handle between the pads, m.
    pub handle_width_m: f64,
    /// Friction coefficient of the handle against the pads.
    pub finger_friction: f64,
    /// Radial stiffness of arm and bearing, N/m; absent: rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub constraint_stiffness_n_m: Option<f64>,
    /// Laws along the circle: path length s = R θ, forces in N at the handle (thesis, eq. 5.2). Inertia in kg at the handle.
    pub effects: Vec<Effect>,
    /// Handle angle at the start, rad from the horizontal, counter-clockwise.
    pub start_rad: f64,
}

/// A one-degree-of-freedom mechanism: a coordinate and the laws along it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mechanism {
    /// Length or angle.
    pub coordinate: Coordinate,
    /// Path of the coordinate in space, if a tool path was recorded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub path: Option<MechanismPath>,
    /// Laws along the coordinate.
    pub effects: Vec<Effect>,
    /// Speed within which the direction of motion is blurred, m/s or rad/s: the noise of the velocity it was fitted with.
    #[serde(default)]
    pub direction_blur: f64,
}

/// Source of one number of the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// `block-1`, `crank`, `mechanism`, `pad`, …
    pub object: String,
    /// Parameter name with its unit.
    pub name: String,
    /// The value.
    pub value: f64,
    /// Standard error; absent when the number was assumed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub std_error: Option<f64>,
    /// `measured`, `known` (stated in the sidecar) or `assumed`.
    pub source: Source,
    /// The recording, or the reason for the assumption.
    pub from: String,
}

/// Kind of the source of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// Estimated from a recording.
    Measured,
    /// Stated by the user.
    Known,
    /// Neither: a default, because the recording could not show it.
    Assumed,
}

/// The thesis's foam, m.
fn foam_m() -> f64 {
    0.002
}

fn schema() -> u32 {
    SCHEMA
}

fn gravity() -> f64 {
    9.81
}

impl World {
    /// An empty world with the default hand and a table.
    pub fn empty(name: &str) -> Self {
        Self {
            schema: SCHEMA,
            name: name.to_owned(),
            gravity_m_s2: gravity(),
            tilt_rad: 0.0,
            hand: Hand::default(),
            pad: Pad::default(),
            floor: Some(Floor::default()),
            plane: None,
            blocks: Vec::new(),
            crank: None,
            membrane: None,
            switch: None,
            mechanism: None,
            provenance: Vec::new(),
        }
    }

    /// The world as pretty JSON.
    pub fn to_json(&self) -> String {
        // Serialising plain numbers and strings into memory cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Gravitational acceleration as a vector in the world, m/s².
    pub fn gravity_vector(&self) -> Vec2 {
        let (sin, cos) = self.tilt_rad.sin_cos();
        Vec2::new(sin, -cos) * self.gravity_m_s2
    }
}

impl Default for Floor {
    fn default() -> Self {
        Self { height_m: -0.125, friction: 0.5, stiffness_n_m: 8000.0, damping_n_s_m: 6.0, loss: None }
    }
}

impl Crank {
    /// Sum of the inertia effects, kg at the handle.
    pub fn mass_at_handle_kg(&self) -> f64 {
        crate::law::inertia(&self.effects)
    }
}
