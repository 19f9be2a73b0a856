//! The trainer behind its panels: servo, device, worlds, recording. No drawing here.

pub mod choice;
pub mod control;
pub mod delay;
pub mod engine;
pub mod hand;
pub mod heard;
pub mod history;
pub mod hold;
pub mod impacts;
pub mod live;
pub mod pinch;
pub mod recording;
pub mod remote;
pub mod script;
pub mod task;
#[cfg(test)]
mod tests;
pub mod trial;
pub mod watch;
