//! The reason why a world cannot be run, in one sentence, and the checks of single numbers.

use super::limits::{MAX_BLOCKS, SCHEMA};
use crate::law::MAX_EFFECTS;

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
        /// Which body.
        who: String,
        /// Parts of a tick at 1 kHz.
        parts: f64,
    },
    /// Bodies that start inside each other would be thrown apart.
    #[error("{who} starts {depth_mm:.1} mm inside {other}; move one of them in the world file")]
    Overlap {
        /// Which body.
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
