//! Fits of the open recordings and all that is derived from them.

pub mod fitting;
pub mod manual_states;
pub mod panels;
pub mod refits;
pub mod replay_frames;
pub mod replayed;
pub mod rule_editing;
pub mod rules;
pub mod sensitivity;
pub mod sensitivity_actions;
pub mod state;
pub mod what_if;
pub mod what_if_actions;
