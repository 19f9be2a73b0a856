//! Timing statistics without allocation: since the start, and of the last seconds.
//!
//! A figure since the start never forgets: one stall while the window opens stays its maximum for hours. So each figure is told
//! twice, since the start and for the last [`RECENT_S`].

mod collector;
mod figures;

pub use collector::{RECENT_S, TimingCollector};
pub use figures::{Figures, STALL_S, TickTiming, Timing};
