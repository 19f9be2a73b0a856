//! The live world, lessons in it, and the people who practise.

pub mod assistant;
pub mod comfort;
pub mod learning;
pub mod lessons;
pub mod panels;
pub mod recorder;
pub mod restart;
pub mod state;
pub mod trainees;
pub mod trainer;
