//! Faults that make a world impossible to run, in one sentence.

use super::block::Block;
use super::model::{MAX_BLOCKS, SCHEMA, World};
use super::rect::{Rect, rect_rect};
use super::step::{MAX_PARTS, part_rate};
use crate::Vec2;
use crate::law::{Effect, MAX_EFFECTS};

/// A world that cannot be run, in one sentence.
#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    /// A number out of its physical range.
    #[error("{object} has {name} = {value}, which must be {must}; correct it in the world file")]
    OutOfRange {
        /// Name of the object.
        object: String,
        /// Name of the number.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The condition.
        must: &'static str,
    },
    /// More blocks than the state can hold.
    #[error("the world has {0} blocks; at most {MAX_BLOCKS} can be simulated")]
    TooManyBlocks(usize),
    /// More laws than the state can remember for.
    #[error("the crank has {0} effects; at most {MAX_EFFECTS} can be simulated")]
    TooManyEffects(usize),
    /// A body too light for the contacts around it.
    #[error(
        "{who} would need {parts:.0} steps a millisecond to be simulated; make it heavier, or contacts, dampers and springs softer"
    )]
    TooStiff {
        /// Name of the body.
        who: String,
        /// Parts of a tick at 1 kHz.
        parts: f64,
    },
    /// Bodies that start inside each other would be thrown apart.
    #[error("{who} starts {depth_mm:.1} mm inside {other}; move one of them in the world file")]
    Overlap {
        /// Name of the first body.
        who: String,
        /// Name of the other body or surface.
        other: String,
        /// Depth of the overlap, mm.
        depth_mm: f64,
    },
    /// A law's parameter out of its range.
    #[error(
        "the effect {law} has {name} = {value}, which must be between {low} and {high}; correct it in the world file"
    )]
    Effect {
        /// Id of the law.
        law: &'static str,
        /// Its parameter.
        name: &'static str,
        /// The value.
        value: f64,
        /// Least.
        low: f64,
        /// Most.
        high: f64,
    },
    /// A newer file.
    #[error("the world file has format {0}, this program reads up to {SCHEMA}; update the program")]
    NewerSchema(u32),
    /// Not a world at all.
    #[error("the file is not a world: {}", crate::text_file::one_line(&.0.to_string()))]
    Parse(#[from] serde_json::Error),
    /// The file could not be read.
    #[error("the world file could not be read ({0})")]
    Io(#[from] std::io::Error),
}

pub(super) fn range_error(object: &str, name: &'static str, value: f64, must: &'static str) -> WorldError {
    WorldError::OutOfRange { object: object.to_owned(), name, value, must }
}

pub(super) fn positive(object: &str, name: &'static str, value: f64) -> Result<(), WorldError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(range_error(object, name, value, "positive and finite")) }
}

pub(super) fn not_negative(object: &str, name: &'static str, value: f64) -> Result<(), WorldError> {
    if value >= 0.0 && value.is_finite() { Ok(()) } else { Err(range_error(object, name, value, "zero or positive")) }
}

pub(super) fn finite(object: &str, name: &'static str, value: f64) -> Result<(), WorldError> {
    if value.is_finite() { Ok(()) } else { Err(range_error(object, name, value, "a finite number")) }
}

/// Overlap at the start that is taken as a contact, m.
const START_OVERLAP_M: f64 = 1e-3;

/// Refuses worlds that would throw bodies about: too light for their contacts, or begun inside each other.
pub(super) fn can_be_stepped(world: &World) -> Result<(), WorldError> {
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
pub(super) fn effects(list: &[Effect]) -> Result<(), WorldError> {
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
