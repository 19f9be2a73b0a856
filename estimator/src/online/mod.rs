//! Estimates while it happens, and what is still missing for them.

pub mod leak;
