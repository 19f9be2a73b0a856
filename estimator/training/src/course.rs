//! Results for the objects: the recorded fingers are moved through the world that was touched.

mod blocks;
mod crank;
mod needle;
mod switch;

use estimation::simulate::walk;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use haptics::world::{State, World};
use schemars::JsonSchema;
use serde::Serialize;

pub use blocks::{BlockMeasures, Drop, Slip, Stack};
pub use crank::CrankMeasures;
pub use needle::NeedleMeasures;
pub use switch::{SwitchMeasures, Watch as SwitchWatch};

/// What happened to the things of a world.
#[derive(Clone, Debug, Default, PartialEq, JsonSchema, Serialize)]
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
    /// Of a switch.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub switch: Option<SwitchMeasures>,
}

/// Watches the things of a world from tick to tick.
pub struct Watch {
    blocks: Option<blocks::Watch>,
    crank: Option<crank::Watch>,
    needle: Option<needle::Watch>,
    switch: Option<switch::Watch>,
}

impl Watch {
    /// Nothing seen yet.
    pub fn new(world: &World) -> Self {
        Self {
            blocks: (!world.blocks.is_empty()).then(|| blocks::Watch::new(world)),
            crank: world.crank.is_some().then(crank::Watch::default),
            needle: world.membrane.is_some().then(needle::Watch::default),
            switch: switch::Watch::new(world),
        }
    }

    /// The next state, at the recording's clock, s.
    pub fn see(&mut self, time_s: f64, state: &State) {
        if let Some(watch) = &mut self.blocks {
            watch.see(time_s, state);
        }
        if let Some(watch) = &mut self.crank {
            watch.see(time_s, state);
        }
        if let Some(watch) = &mut self.needle {
            watch.see(time_s, state);
        }
        if let Some(watch) = &mut self.switch {
            watch.see(state);
        }
    }

    /// All that was seen.
    pub fn end(self) -> Course {
        Course {
            blocks: self.blocks.map(blocks::Watch::end),
            crank: self.crank.map(crank::Watch::end),
            needle: self.needle.map(needle::Watch::end),
            switch: self.switch.map(|watch| watch.found()),
        }
    }
}

/// Moves the recorded fingers through `world` and watches its things; `also` sees every state, too, with its time, s.
pub fn follow(
    world: &World,
    recording: &Recording,
    mut also: impl FnMut(f64, &State),
) -> Result<Course, EstimateError> {
    let mut watch = Watch::new(world);
    walk(world, recording, |time_s, state: &State| {
        watch.see(time_s, state);
        also(time_s, state);
    })?;
    Ok(watch.end())
}
