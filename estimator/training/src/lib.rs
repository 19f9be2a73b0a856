//! Measures of training, from the recording alone.
//!
//! The hand's measures ([`hand`]) need positions and forces. The results for the objects ([`course`]) are found by
//! moving the recorded fingers through the world that was touched. Nothing here is an opinion: every measure has a unit
//! and a definition, and the same recording gives the same numbers, to the bit. Definitions that people are shown are
//! in [`definitions`].

pub mod assistant;
pub mod course;
pub mod definitions;
pub mod figures;
pub mod hand;
pub mod lesson;
pub mod progress;
pub mod smoothness;

use course::Course;
use foundation::estimate::EstimateError;
use hand::HandMeasures;
use haptics::recording::Recording;
use haptics::world::World;
use schemars::JsonSchema;
use serde::Serialize;

/// Version of the definitions: numbers of different versions are not compared.
pub const VERSION: u32 = 1;

/// Everything that was measured.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Measures {
    /// [`VERSION`].
    pub version: u32,
    /// Of the hand.
    pub hand: HandMeasures,
    /// Of the objects; absent without the world that was touched.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub course: Option<Course>,
}

/// Measures a recording of two fingers, or of one tool; with the world that was touched also the results for its
/// objects. Forces above `limit_n` count as too large, N.
///
/// The recording must begin where the world does: objects at rest in their places.
///
/// # Errors
/// Without positions, or without a clock.
pub fn measure(recording: &Recording, world: Option<&World>, limit_n: f64) -> Result<Measures, EstimateError> {
    let hand = hand::measure(recording, limit_n)?;
    let course = world.map(|world| course::follow(world, recording, |_, _| {})).transpose()?;
    Ok(Measures { version: VERSION, hand, course })
}

#[cfg(test)]
mod tests;
