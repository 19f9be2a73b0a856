//! Where panels stand: tiles that can be resized, dragged into tabs, closed and brought back; one arrangement a workspace.
//!
//! As long as nothing was moved, columns keep widths that suit the window ([`layout`]); afterwards the shares are the user's.

pub mod arrangement;
pub mod behavior;
pub mod layout;
pub mod name_field;
pub mod named;
pub mod naming;
pub mod panes;
pub mod place;
