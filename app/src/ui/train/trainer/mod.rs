//! The trainer behind its panels: servo, device, worlds, recording. No drawing here.

pub mod control;
pub mod delay;
pub mod engine;
pub mod force_test;
pub mod hand;
pub mod history;
pub mod impacts;
pub mod live;
pub mod pause;
pub mod pointer_grip;
pub mod recording;
pub mod remote;
pub mod script;
pub mod slip_sound;
pub mod task;
#[cfg(test)]
mod tests;
pub mod watch;
pub mod world_choice;
