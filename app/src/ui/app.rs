//! The window: top bar, messages, the panels of the workspace, keys, files dropped on it.

use super::dock::panes::Panels;
use super::session::Session;
use crate::ui::command_palette::CommandPalette;
use crate::ui::dock::arrangement::Dock;
use crate::ui::document::autosave::{Autosave, State};
use crate::ui::tour_progress::Tour;

/// The application.
pub struct App {
    /// Data of the window.
    pub session: Session,
    /// Positions of the panels.
    pub dock: Dock,
    /// The command palette.
    pub palette: CommandPalette,
    /// The tour.
    pub tour: Tour,
    /// State that a killed program left behind.
    pub left_behind: Option<Box<State>>,
    /// Keeps what is open.
    pub autosave: Option<Autosave>,
    pub(crate) panels: Panels,
}
