//! Every action of the window, once: menus, keys, the command palette and tooltips take it from here.

pub mod faces;
pub mod list;
pub mod run;
pub mod search;
