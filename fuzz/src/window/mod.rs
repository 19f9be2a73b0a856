//! Targets that need the window's crate.

pub mod history;
pub mod session;
