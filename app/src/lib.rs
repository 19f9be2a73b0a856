//! Touchstone, the program: its command line and its window.
//!
//! Everything that computes lives in `haptics` and `estimator`, everything that draws the hand in `render`.

pub mod cli;
pub mod ui;
