//! From a log to numbers one can sign.
//!
//! `log` reads, `signal` derives, `segment` says what was happening when, `identify` and `constraint` estimate, `calibrate`
//! writes a world, `simulate` replays the measured motion through it. Every stage is a plain function between plain types.

pub mod assistant;
pub mod calibrate;
pub mod constraint;
pub mod diagnose;
pub mod estimate;
pub mod hmm;
pub mod identify;
pub mod log;
pub mod online;
pub mod pipeline;
pub mod segment;
pub mod signal;
pub mod simulate;
pub mod training;
pub mod wanted;
pub mod words;
