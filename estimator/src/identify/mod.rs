//! Identification.

pub mod barrel;
pub mod block;
pub mod bootstrap;
pub mod crank;
mod influence;
mod limits;
pub mod linear;
pub mod long_run_variance;
pub mod mechanism;
pub mod needle;
mod pads;
pub mod priors;
pub mod robust;
pub mod switch;
pub mod tossed;
