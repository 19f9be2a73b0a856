//! Estimates while it happens, and the motions still missing for them.
//!
//! [`Online`] takes one sample after the other, from the servo or from a log. Its signals are those of the batch fit, delayed by half a
//! window instead of looking ahead ([`filter`]); states come from the task's own rules (`state_tracker`); rows go into square-root
//! recursions ([`recursive`]) that a detector watches ([`change`]). A sample allocates nothing; a [`Report`] does. `docs/online.md`.

pub mod block;
pub mod change;
pub mod crank;
mod decimating_store;
mod estimator;
pub mod filter;
pub mod information;
pub mod leak;
pub mod recursive;
mod replay;
mod report;
mod settings;
mod state_tracker;
#[cfg(test)]
mod tests;
mod triangular;

pub use block::pull::{Anchor, Pull};
pub use estimator::Online;
pub use replay::{enough_for, replay};
pub use report::{Event, Report};
pub use settings::Settings;
