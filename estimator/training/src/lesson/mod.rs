//! Lessons: the task, its world, the demonstration of an expert, and the judged measures. A lesson is a JSON file, with
//! a text for people beside it (`assets/lessons`, `docs/lessons.md`); users add their own without code.

pub mod advice;
pub mod attempt;
pub mod expert;
mod expert_level;
mod format;
pub mod goal;
pub mod grade;
mod graded;
pub mod library;
pub mod perform;
pub mod practise;
mod progress;

pub use attempt::Attempted;
pub use expert_level::{Expert, Spread};
pub use format::{Base, Judged, Lesson, Over, Question, SCHEMA, Step};
pub use goal::{Goal, Rule, Seen, Standing};
pub use grade::grade;
pub use graded::{Figure, GRADE_VERSION, Grade, Reached};
pub use progress::Progress;

#[cfg(test)]
mod tests;
