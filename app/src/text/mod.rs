//! Words and numbers for people, the same in the window, on the command line and in reports.

pub mod constraint_words;
pub mod diagnosis_words;
pub mod file_name;
pub mod format;
pub mod sentence;
pub mod states;
