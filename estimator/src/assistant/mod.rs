//! What an assistant says while somebody handles things: what is in the hand, what is about to go wrong, what was found to hold.
//!
//! What is in the hand comes from the estimator beside the servo ([`crate::online`]), fed by the operator's own motion; nothing is told
//! without its error. Warnings look at the newest tick and at the outlines of what stands around (the world as the operator sees it: over a
//! slow line the late picture, with its lateness in the warning). No drawing here: the window draws it (`docs/assistant.md`).

pub mod collision;
pub mod contents;
pub mod held;
mod known;
pub mod slip;
pub mod warnings;

pub use collision::Collision;
pub use contents::{Guess, guess};
pub use held::{Held, Look};
pub use known::Known;
pub use slip::{Slip, slip};
pub use warnings::{Load, Warning, Warnings, warnings};
