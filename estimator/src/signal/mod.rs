//! Signals derived from recordings.

pub mod derive;
pub mod filter;
pub mod noise;
pub mod task;
