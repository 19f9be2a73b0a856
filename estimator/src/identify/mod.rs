//! Identification.

pub mod linear;
