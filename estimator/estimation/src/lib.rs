//! From a recording to numbers one can sign.
//!
//! `segment` finds the states and their times, `identify` and `constraint` estimate, `calibrate` writes a world, `simulate`
//! runs the measured motion through it, `online` estimates beside the servo. Every stage is a plain function between
//! plain types.

mod agreement;
pub mod calibrate;
pub mod constraint;
pub mod hmm;
pub mod identify;
pub mod online;
pub mod pipeline;
mod plausible;
pub mod regression;
pub mod segment;
pub mod simulate;
mod zero_jumps;
