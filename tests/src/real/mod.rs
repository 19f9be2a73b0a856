//! Questions about real measurements that other people answered with other means, and the answers of the program.
//!
//! The measurements are not part of this repository. `cargo run -p tests --bin real` writes the table
//! `docs/evidence/real-data.md`.

pub mod judged;
pub mod questions;

pub use judged::{Judged, Outcome, ask};
pub use questions::{Expected, QUESTIONS, Question};
