//! The window.
//!
//! * [`session`] composes the state of the features; [`background`] runs their jobs.
//! * [`document`], [`calibrate`], [`diagnose`], [`train`] and [`devices`] are the features: state, actions, and panels, one panel a file.
//! * [`column_mapping`] is the dialog for the columns of a foreign table.
//! * [`shell`] lays the panels out into the workspaces, with menu, commands and messages.
//! * [`plots`] draws curves, [`scene`] draws worlds; [`kit`] has the colours, sizes, icons and widgets.
//! * [`headless`] draws any of it without a window.

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
