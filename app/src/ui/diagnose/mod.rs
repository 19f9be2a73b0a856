//! The diagnosis of the open recordings, and the experiments that it asks for.

pub mod actions;
pub mod atlas_sheet;
pub mod checked;
pub mod experiment;
pub mod experiment_state;
pub mod guidance;
pub mod guided_experiment;
pub mod panels;
pub mod replays;
pub mod state;
pub mod validation;
