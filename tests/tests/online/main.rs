//! The estimator beside the servo, blind: drawn worlds, an operator, sensors. Truth is opened by the assertions only.

mod agree;
mod generator;
mod leaks;
mod losses;
mod missing;

use estimator::{identify, online};
