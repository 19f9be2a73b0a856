//! Touchstone, the program: its command line and its window.
//!
//! Everything that computes lives in `haptics` and `estimator`, everything that draws the hand in `render`.

pub mod boards;
mod built_in;
pub mod cli;
pub mod experiment;
pub mod export;
pub mod history;
pub mod lessons;
pub mod operator;
pub mod path_bytes;
pub mod recorder;
pub mod report;
pub mod schema;
pub mod tasks;
pub mod text;
pub mod ui;
pub mod video;
pub mod worlds;
pub mod write_whole;

use std::path::PathBuf;

/// The running `touchstone` program, to be started again as a helper of itself; `None` inside other programs (tests).
pub(crate) fn program() -> Option<PathBuf> {
    std::env::current_exe().ok().filter(|path| path.file_stem().is_some_and(|stem| stem == "touchstone"))
}
