//! The state of the command palette.

use egui::{Key, Ui};

/// Width of the list, points.
pub(crate) const WIDTH: f32 = 520.0;

/// Its height at most.
pub(crate) const HEIGHT: f32 = 380.0;

/// Width of the column with the names of the menus.
pub(crate) const GROUP: f32 = 54.0;

/// Height of a line.
pub(crate) const LINE: f32 = 28.0;

/// The palette and what is typed into it.
#[derive(Debug, Default)]
pub struct CommandPalette {
    pub(crate) shown: bool,
    pub(crate) query: String,
    pub(crate) chosen: usize,
    /// Set when the chosen line has to come into sight.
    pub(crate) follow: bool,
}

impl CommandPalette {
    /// Opens it, empty.
    pub fn open(&mut self) {
        *self = Self { shown: true, ..Self::default() };
    }

    /// True while it is open.
    pub fn is_open(&self) -> bool {
        self.shown
    }
}

pub(crate) fn moved_by_keys(ui: &Ui, palette: &mut CommandPalette, count: usize) {
    let (down, up) = ui.input_mut(|i| {
        let none = egui::Modifiers::NONE;
        (i.count_and_consume_key(none, Key::ArrowDown), i.count_and_consume_key(none, Key::ArrowUp))
    });
    if down + up > 0 {
        palette.chosen = (palette.chosen + down).saturating_sub(up);
        palette.follow = true;
    }
    palette.chosen = palette.chosen.min(count.saturating_sub(1));
}
