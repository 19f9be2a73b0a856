//! The window: top bar, messages, the panels of the workspace, keys, files dropped on it.

use crate::ui::document::autosave::{Autosave, State};
use crate::ui::session::Session;
use crate::ui::shell::command_palette::CommandPalette;
use crate::ui::shell::dock::arrangement::Dock;
use crate::ui::shell::dock::panes::Panels;
use crate::ui::shell::tour_progress::Tour;

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
