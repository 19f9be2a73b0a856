//! Identification.

pub mod block;
pub mod crank;
pub mod linear;
pub mod mechanism;
pub mod needle;
