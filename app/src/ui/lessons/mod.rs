//! Lessons in Train: watching an expert, practising, the test, and what came of it. No drawing here.

pub mod ghost;
pub mod kept;
pub mod pointer;
pub mod practising;
pub mod state;
pub mod trace;
