//! Signals derived from recordings.

pub mod chain;
pub mod correlate;
pub mod derive;
pub mod filter;
pub mod gaps;
pub mod interpolation;
pub mod lag;
pub mod noise;
pub mod pieces;
pub mod task;
pub mod thinned;
pub mod transform;
pub mod wrench;
