//! Positions of the panels: tiles that can be resized, dragged into tabs, closed and restored; one layout per
//! workspace.
//!
//! As long as nothing was moved, columns keep widths that match the window ([`layout`]); afterwards the shares are the
//! user's.

pub mod arrangement;
pub mod behavior;
pub mod layout;
pub mod name_field;
pub mod named;
pub mod naming;
pub mod panes;
pub mod place;
