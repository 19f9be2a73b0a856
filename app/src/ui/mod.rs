//! The window.
//!
//! * [`session`] is what the window knows; [`jobs`] fill it in the background; [`trainer`] is the live world.
//! * [`panels`] show and change it, one panel a file; [`app`] lays them out into the two workspaces.
//! * [`mapping`] is the dialog that says what the columns of a foreign table mean.
//! * [`scene`] brings the pictures in, [`plots`] the curves; [`theme`] is the one place for colours and sizes, [`icons`] for icons.
//! * [`screenshot`] draws any of it without a window, [`gallery`] all of it.

pub mod background;
pub mod calibrate;
pub mod column_mapping;
pub mod devices;
pub mod diagnose;
pub mod document;
pub mod headless;
pub mod kit;
pub mod plots;
pub mod scene;
pub mod session;
pub mod shell;
#[cfg(test)]
mod tests;
pub mod train;
