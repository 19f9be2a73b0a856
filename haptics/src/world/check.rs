//! Faults that make a world impossible to run, in one sentence.

use super::block::Block;
use super::error::{WorldError, finite, not_negative, positive};
use super::limits::{MAX_BLOCKS, SCHEMA};
use super::model::{Crank, Floor, Pad, World};
use super::rect::{Rect, rect_rect};
use super::step::{MAX_PARTS, part_rate};
use crate::Vec2;
use crate::law::{Effect, MAX_EFFECTS};

/// Overlap at the start that is taken as a contact, m.
const START_OVERLAP_M: f64 = 1e-3;

impl World {
    /// Reads and checks a world from JSON.
    pub fn from_json(text: &str) -> Result<Self, WorldError> {
        let world: Self = serde_json::from_str(text)?;
        world.check()?;
        Ok(world)
    }

    /// Reads and checks a world file.
    pub fn load(path: &std::path::Path) -> Result<Self, WorldError> {
        Self::from_json(&crate::text_file::read(path)?)
    }

    /// Fault that makes the world impossible to run, if there is one.
    pub fn check(&self) -> Result<(), WorldError> {
        if self.schema > SCHEMA {
            return Err(WorldError::NewerSchema(self.schema));
        }
        if self.blocks.len() > MAX_BLOCKS {
            return Err(WorldError::TooManyBlocks(self.blocks.len()));
        }
        self.pad.check()?;
        finite("the world", "gravity_m_s2", self.gravity_m_s2)?;
        finite("the world", "tilt_rad", self.tilt_rad)?;
        for finger in &self.hand.fingers {
            positive("the hand", "link_m", finger.link_m)?;
        }
        if let Some(floor) = &self.floor {
            floor.check()?;
        }
        if let Some(plane) = &self.plane {
            plane.check()?;
        }
        for block in &self.blocks {
            block.check()?;
        }
        if let Some(membrane) = &self.membrane {
            membrane.check()?;
        }
        if let Some(switch) = &self.switch {
            switch.check()?;
        }
        if let Some(crank) = &self.crank {
            crank.check()?;
        }
        if let Some(mechanism) = &self.mechanism {
            effects(&mechanism.effects)?;
        }
        positive("the hand", "workspace.radius_m", self.hand.workspace.radius_m)?;
        can_be_stepped(self)
    }
}

impl Pad {
    fn check(&self) -> Result<(), WorldError> {
        positive("pad", "stiffness_n_m", self.stiffness_n_m)?;
        positive("pad", "thickness_m", self.thickness_m)?;
        not_negative("pad", "face_m", self.face_m)?;
        positive("pad", "shear_stiffness_n_m", self.shear_stiffness_n_m)?;
        not_negative("pad", "damping_n_s_m", self.damping_n_s_m)?;
        not_negative("pad", "shear_damping_n_s_m", self.shear_damping_n_s_m)?;
        not_negative("pad", "cubic_n_m3", self.cubic_n_m3)?;
        not_negative("pad", "hertz_n_m15", self.hertz_n_m15)
    }
}

impl Floor {
    fn check(&self) -> Result<(), WorldError> {
        finite("the floor", "height_m", self.height_m)?;
        positive("the floor", "stiffness_n_m", self.stiffness_n_m)?;
        not_negative("the floor", "friction", self.friction)?;
        not_negative("the floor", "damping_n_s_m", self.damping_n_s_m)?;
        if let Some(loss) = &self.loss {
            not_negative("the floor", "loss.e", loss.e)?;
            not_negative("the floor", "1 − loss.e", 1.0 - loss.e)?;
            not_negative("the floor", "loss.mu", loss.mu)?;
        }
        Ok(())
    }
}

impl Crank {
    fn check(&self) -> Result<(), WorldError> {
        if self.effects.len() > MAX_EFFECTS {
            return Err(WorldError::TooManyEffects(self.effects.len()));
        }
        positive("the crank", "radius_m", self.radius_m)?;
        positive("the crank", "handle_width_m", self.handle_width_m)?;
        not_negative("the crank", "finger_friction", self.finger_friction)?;
        positive("the crank", "inertia (effect `inertia`, m)", self.mass_at_handle_kg())?;
        if let Some(stiffness) = self.constraint_stiffness_n_m {
            positive("the crank", "constraint_stiffness_n_m", stiffness)?;
        }
        effects(&self.effects)
    }
}

/// Refuses worlds that would throw bodies about: too light for their contacts, or begun inside each other.
fn can_be_stepped(world: &World) -> Result<(), WorldError> {
    // With both fingertips pressed to the end of their foam.
    let (rate, who) = part_rate(world, f64::INFINITY);
    let parts = 1e-3 * rate;
    if parts > 0.5 * f64::from(MAX_PARTS) || !parts.is_finite() {
        return Err(WorldError::TooStiff { who: who.to_owned(), parts });
    }
    let rects: Vec<Rect> = world.blocks.iter().map(outline).collect();
    for (i, (block, rect)) in world.blocks.iter().zip(&rects).enumerate() {
        let overlap = |other: &str, depth_m: f64| {
            let (who, other) = (block.name.clone(), other.to_owned());
            Err(WorldError::Overlap { who, other, depth_mm: 1e3 * depth_m })
        };
        let lowest = (0..4).map(|corner| rect.corner(corner).y).fold(f64::INFINITY, f64::min);
        if let Some(floor) = world.floor.filter(|f| f.height_m - lowest > START_OVERLAP_M) {
            return overlap("the floor", floor.height_m - lowest);
        }
        for (other, other_rect) in world.blocks.iter().zip(&rects).skip(i + 1) {
            let deepest = rect_rect(rect, other_rect, 0.0)
                .map_or(0.0, |(_, points)| points.iter().flatten().map(|(_, depth, _)| *depth).fold(0.0, f64::max));
            if deepest > START_OVERLAP_M {
                return overlap(&other.name, deepest);
            }
        }
    }
    Ok(())
}

fn outline(block: &Block) -> Rect {
    let (sin, cos) = if block.keeps_upright() { (0.0, 1.0) } else { block.start.angle_rad.sin_cos() };
    let half_m = 0.5 * Vec2::new(block.width_m, block.height_m);
    Rect { center_m: block.start.center_m, half_m, axis_x: Vec2::new(cos, sin) }
}

/// Refuses values outside the bounds that a law states for them: a damper that generates energy, a stiffness below
/// zero.
fn effects(list: &[Effect]) -> Result<(), WorldError> {
    for effect in list {
        for (spec, value) in effect.law().parameters().iter().zip(effect.values) {
            let (low, high) = spec.bounds;
            if !(low..=high).contains(&value) {
                return Err(WorldError::Effect { law: effect.law().id(), name: spec.name, value, low, high });
            }
        }
    }
    Ok(())
}
