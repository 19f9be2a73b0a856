//! Identification.

pub mod barrel;
pub mod block;
pub mod crank;
pub mod limits;
pub mod mechanism;
pub mod needle;
mod pads;
pub mod payload;
pub mod priors;
pub mod switch;
pub mod tossed;
