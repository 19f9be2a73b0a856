//! Identification.

pub mod block;
pub mod linear;
pub mod mechanism;
