//! Movable bodies: blocks, barrels, needles.

use super::error::{WorldError, finite, not_negative, positive};
use super::guide::Guide;
use crate::Vec2;
use serde::{Deserialize, Serialize};

/// A rectangular block that may rotate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// `block-1`, `block-2`, …: the name in fits and reports.
    pub name: String,
    /// Mass, kg, positive.
    pub mass_kg: f64,
    /// Horizontal size when upright, m.
    pub width_m: f64,
    /// Vertical size when upright, m.
    pub height_m: f64,
    /// Friction coefficient against the finger pads.
    pub finger_friction: f64,
    /// Friction coefficient against other blocks.
    pub block_friction: f64,
    /// Contact stiffness against blocks per contact point, N/m.
    pub stiffness_n_m: f64,
    /// Contact damping against blocks per contact point, N s/m.
    pub damping_n_s_m: f64,
    /// Starting pose: centre, m, and angle, rad counter-clockwise.
    pub start: Pose,
    /// Shape of the body: its look, and whether it may turn.
    #[serde(default, skip_serializing_if = "Shape::is_block")]
    pub shape: Shape,
    /// Its wall yields under a finger; absent: rigid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wall: Option<Wall>,
    /// Content that it can lose; absent: it is solid.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub content: Option<Content>,
    /// A cable that holds it; absent: it is free.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cable: Option<Cable>,
    /// A curve that its middle is held to; absent: it goes where it is carried. A guided body keeps upright.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub guide: Option<Guide>,
}

/// Kind of a movable body.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// A block: it turns as it likes.
    #[default]
    Block,
    /// A barrel: a block that is drawn round.
    Barrel,
    /// A paper cup: a block that is drawn round, open and tapering.
    Cup,
    /// A needle, point down in the middle of its lower edge. The flat pads keep it upright, as they do the crank's handle.
    Needle,
}

impl Shape {
    /// True if it is carried about as it is, like a block: no barrel that is examined, no needle.
    pub fn is_carried(self) -> bool {
        matches!(self, Self::Block | Self::Cup)
    }

    // serde hands over a reference.
    #[allow(clippy::trivially_copy_pass_by_ref)]
    fn is_block(&self) -> bool {
        *self == Self::Block
    }
}

/// A wall that yields: a spring in series with the finger's pad.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Stiffness, N/m, positive.
    pub stiffness_n_m: f64,
    /// Force of one finger at which it breaks and the content begins to leak, N; absent: it holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub strength_n: Option<f64>,
}

/// Content of a body; part of its `mass_kg`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Content {
    /// Mass of the content at the start, kg, less than the whole.
    pub mass_kg: f64,
    /// Rate at which it runs out of a leak, kg/s, ≥ 0.
    pub leak_kg_s: f64,
    /// Start of a leak without a cause, s of simulated time; absent: it leaks only when the wall breaks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaks_from_s: Option<f64>,
}

/// A cable from a fixed point to the body's centre. It pulls and never pushes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cable {
    /// Anchor of the cable, m in the world.
    pub anchor_m: Vec2,
    /// Length at which it gets taut, m, ≥ 0.
    pub length_m: f64,
    /// Stiffness, N/m, positive.
    pub stiffness_n_m: f64,
    /// Damping while taut, N s/m, ≥ 0.
    pub damping_n_s_m: f64,
}

/// Position and orientation in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pose {
    /// Centre in the world, m.
    pub center_m: Vec2,
    /// Rotation, rad, counter-clockwise.
    #[serde(default)]
    pub angle_rad: f64,
}

impl Block {
    /// Needles and sliders keep upright, as the flat pads hold them.
    pub fn keeps_upright(&self) -> bool {
        self.shape == Shape::Needle || self.guide.is_some()
    }

    /// A block with usual contact values, standing upright with its base at (`x_m`, `base_y_m`).
    pub fn upright(name: &str, mass_kg: f64, width_m: f64, height_m: f64, x_m: f64, base_y_m: f64) -> Self {
        Self {
            name: name.to_owned(),
            mass_kg,
            width_m,
            height_m,
            finger_friction: 0.9,
            block_friction: 0.5,
            stiffness_n_m: 8000.0,
            damping_n_s_m: 6.0,
            start: Pose { center_m: Vec2::new(x_m, base_y_m + 0.5 * height_m), angle_rad: 0.0 },
            shape: Shape::Block,
            wall: None,
            content: None,
            cable: None,
            guide: None,
        }
    }

    /// Moment of inertia about the centre, kg m² (a homogeneous rectangle).
    pub fn inertia_kg_m2(&self) -> f64 {
        self.mass_kg * (self.width_m.powi(2) + self.height_m.powi(2)) / 12.0
    }

    pub(super) fn check(&self) -> Result<(), WorldError> {
        positive(&self.name, "mass_kg", self.mass_kg)?;
        positive(&self.name, "width_m", self.width_m)?;
        positive(&self.name, "height_m", self.height_m)?;
        positive(&self.name, "stiffness_n_m", self.stiffness_n_m)?;
        not_negative(&self.name, "damping_n_s_m", self.damping_n_s_m)?;
        not_negative(&self.name, "finger_friction", self.finger_friction)?;
        not_negative(&self.name, "block_friction", self.block_friction)?;
        finite(&self.name, "start.center_m[0]", self.start.center_m.x)?;
        finite(&self.name, "start.center_m[1]", self.start.center_m.y)?;
        finite(&self.name, "start.angle_rad", self.start.angle_rad)?;
        if let Some(wall) = &self.wall {
            positive(&self.name, "wall.stiffness_n_m", wall.stiffness_n_m)?;
            positive(&self.name, "wall.strength_n", wall.strength_n.unwrap_or(1.0))?;
        }
        if let Some(content) = &self.content {
            not_negative(&self.name, "content.leak_kg_s", content.leak_kg_s)?;
            finite(&self.name, "content.leaks_from_s", content.leaks_from_s.unwrap_or(0.0))?;
            not_negative(&self.name, "content.mass_kg", content.mass_kg)?;
            positive(&self.name, "mass_kg without its content", self.mass_kg - content.mass_kg)?;
        }
        if let Some(guide) = &self.guide {
            guide.check(&self.name)?;
        }
        if let Some(cable) = &self.cable {
            positive(&self.name, "cable.stiffness_n_m", cable.stiffness_n_m)?;
            not_negative(&self.name, "cable.damping_n_s_m", cable.damping_n_s_m)?;
            not_negative(&self.name, "cable.length_m", cable.length_m)?;
            finite(&self.name, "cable.anchor_m[0]", cable.anchor_m.x)?;
            finite(&self.name, "cable.anchor_m[1]", cable.anchor_m.y)?;
        }
        Ok(())
    }
}
