//! The mapping dialog: the meaning of the columns of a foreign table, with a live preview; it writes the sidecar.
//!
//! [`facts`] inspects the file, [`words`] and [`guess`] read the names, [`draft`] is edited and becomes the sidecar,
//! [`preview`] loads with it in the background, [`dialog`] draws.

pub mod actions;
pub mod dialog;
#[cfg(test)]
mod dialog_tests;
pub mod draft;
#[cfg(test)]
mod draft_tests;
pub mod facts;
pub mod file_units;
pub mod guess;
#[cfg(test)]
mod guess_tests;
pub mod look;
pub mod names;
pub mod options;
pub mod plot;
pub mod preview;
pub mod state;
pub mod table;
pub mod words;
