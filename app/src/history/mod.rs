//! Who practised what, when, and how well: an embedded database on this machine.
//!
//! [`Store`] is the database itself: whatever it says is kept has reached the disk. [`History`] is a thread that has one, for the
//! window; an attempt that the database does not take is kept beside it and taken in at the next start ([`aside`]).

pub mod aside;
pub mod attempt;
pub mod keeper;
pub mod schema;
pub mod store;
pub mod table;
#[cfg(test)]
mod tests;
