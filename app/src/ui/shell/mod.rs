//! The frame around the panels: layout, menu, commands, messages, tour.

pub mod actions;
pub mod app;
pub mod command_palette;
pub mod dialogs;
pub mod dispatch;
pub mod dock;
pub mod fit;
pub mod keys;
pub mod menu;
pub mod message_list;
pub mod messages;
pub mod palette;
pub mod panel;
pub mod panel_id;
pub mod panel_list;
pub mod run;
pub mod start;
pub mod tour;
pub mod tour_progress;
pub mod window;
pub mod workspace;
