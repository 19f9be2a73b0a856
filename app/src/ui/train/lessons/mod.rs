//! Lessons in Train: the expert's demonstration, practice, the test, and the result. No drawing here.

pub mod ghost;
pub mod kept;
pub mod pointer;
pub mod practising;
pub mod state;
pub mod trace;
