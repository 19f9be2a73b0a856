//! Identification.

pub mod block;
pub mod linear;
