//! Tasks as files: states with their rules, subtasks, and thresholds.

mod check;
pub mod definition;
pub mod library;
pub mod shows;
mod sign;
mod state;
mod thresholds;

pub use sign::Sign;
pub use state::SystemState;
pub use thresholds::Thresholds;
