//! The trainees' attempts with their conditions and scores: an embedded database on this machine.
//!
//! [`Store`] is the database itself: everything that it confirms has reached the disk. [`History`] is a thread that
//! owns one, for the window. An attempt that the database rejects is stored beside it and imported at the next start
//! ([`aside`]).

pub mod aside;
pub mod attempt;
pub mod keeper;
pub mod schema;
pub mod store;
pub mod table;
#[cfg(test)]
mod tests;
