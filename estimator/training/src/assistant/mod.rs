//! Assistant for handling things: the object in the hand, imminent faults, and constraints that were found.
//!
//! Estimates of the object in the hand come from the estimator beside the servo ([`estimation::online`]), fed by the
//! operator's own motion; each value has its error. Warnings look at the newest tick and at the outlines of the objects
//! around: the world as the operator sees it (over a slow line the late picture, with its lateness in the warning). No
//! drawing here: the window draws it (`docs/assistant.md`).

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
