//! One of every panel, with what it remembers.

use crate::ui::session::Session;
use crate::ui::shell::panel::Panel;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::panel_list::panels;
use egui::Ui;

/// One of every panel.
pub struct Panels {
    all: Vec<(PanelId, Box<dyn Panel>)>,
}

impl Default for Panels {
    fn default() -> Self {
        Self { all: panels().map(|panel| (panel.id, (panel.new)())).collect() }
    }
}

impl Panels {
    /// Draws a panel into the available space.
    pub fn ui(&mut self, id: PanelId, ui: &mut Ui, session: &mut Session) {
        if let Some((_, panel)) = self.all.iter_mut().find(|(known, _)| *known == id) {
            panel.ui(ui, session);
        }
    }
}
