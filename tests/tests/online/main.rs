//! The estimator beside the servo, blind: drawn worlds, an operator, sensors. Truth is opened by the assertions only.

mod agree;
mod generator;
mod leaks;
mod losses;
mod missing;
mod pulls;
mod shown;

use estimator::{identify, online};

/// How many recordings of each kind are drawn: a few, or as many as `TOUCHSTONE_ONLINE` says.
fn each(few: u64) -> u64 {
    std::env::var("TOUCHSTONE_ONLINE").ok().and_then(|s| s.parse().ok()).unwrap_or(few)
}
