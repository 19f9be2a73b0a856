//! What became of the objects: the recorded fingers are moved through the world that was touched.

mod blocks;
mod crank;
mod needle;

use crate::estimate::EstimateError;
use crate::simulate::walk;
use haptics::recording::Recording;
use haptics::world::{State, World};
use serde::Serialize;

pub use blocks::{BlockMeasures, Drop, Slip, Stack};
pub use crank::CrankMeasures;
pub use needle::NeedleMeasures;

/// What happened to the things of a world.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Course {
    /// Of blocks and barrels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blocks: Option<BlockMeasures>,
    /// Of a crank.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub crank: Option<CrankMeasures>,
    /// Of a needle in its sheet.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub needle: Option<NeedleMeasures>,
}

/// Moves the recorded fingers through `world` and watches its things.
pub fn follow(world: &World, recording: &Recording) -> Result<Course, EstimateError> {
    let mut blocks = (!world.blocks.is_empty()).then(|| blocks::Watch::new(world));
    let mut crank = world.crank.is_some().then(crank::Watch::default);
    let mut needle = world.membrane.is_some().then(needle::Watch::default);
    walk(world, recording, |time_s, state: &State| {
        if let Some(watch) = &mut blocks {
            watch.see(time_s, state);
        }
        if let Some(watch) = &mut crank {
            watch.see(time_s, state);
        }
        if let Some(watch) = &mut needle {
            watch.see(time_s, state);
        }
    })?;
    Ok(Course {
        blocks: blocks.map(blocks::Watch::end),
        crank: crank.map(crank::Watch::end),
        needle: needle.map(needle::Watch::end),
    })
}
