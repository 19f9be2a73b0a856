//! The open files: recordings, videos, projects, the choice of a fit, undo, and file dialogs.

pub mod autosave;
pub mod correction;
pub mod file_kind;
pub mod files;
pub mod fit_choice;
pub mod opening;
pub mod overlays;
pub mod playback;
pub mod prepared;
pub mod project;
pub mod project_files;
pub mod recent;
pub mod recovery;
pub mod state;
pub mod undo;
pub mod undo_actions;
pub mod video_actions;
pub mod videos;
