//! The assistant over the trainer's picture: held object, imminent problems, detected constraints. The user chooses the
//! parts; in a test the assistant is off.

pub mod draw;
pub mod readings;
pub mod state;
pub mod words;
