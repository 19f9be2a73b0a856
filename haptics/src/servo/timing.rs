//! Timing statistics without allocation: since the start, and of the last seconds.
//!
//! A figure since the start never forgets: one stall while the window opens stays its maximum for hours. Each figure is
//! therefore told twice, since the start and for the last [`RECENT_S`].

mod collector;
mod figures;

pub use collector::TimingCollector;
pub use figures::{Figures, RECENT_S, STALL_S, TickTiming, Timing};
