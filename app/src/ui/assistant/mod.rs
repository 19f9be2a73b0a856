//! The assistant over the trainer's picture: what is in the hand, what is about to go wrong, what was found to hold. Which of it is shown
//! is the user's choice; in a test nobody helps.

pub mod draw;
pub mod readings;
pub mod state;
pub mod words;
