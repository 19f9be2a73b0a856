//! Keys that are held or have two strengths: moving the time cursor. Everything else is an action.

use crate::ui::document::state::Document;
use crate::ui::shell::workspace::Workspace;
use egui::{Key, Ui};

/// Share of the visible time that an arrow key moves the cursor by.
const SCRUB_SHARE: f64 = 0.01;

/// Handles keys that are not meant for a text field.
pub fn handle(ui: &Ui, workspace: Workspace, document: &mut Document) {
    let ctx = ui.ctx().clone();
    if ctx.egui_wants_keyboard_input() || !matches!(workspace, Workspace::Calibrate | Workspace::Diagnose) {
        return;
    }
    let pressed = |key| ctx.input(|i| i.key_pressed(key));
    let coarse = if ctx.input(|i| i.modifiers.shift) { 10.0 } else { 1.0 };
    let step = SCRUB_SHARE * coarse * (document.view_s.1 - document.view_s.0);
    if pressed(Key::ArrowLeft) {
        document.seek(document.cursor_s - step);
    }
    if pressed(Key::ArrowRight) {
        document.seek(document.cursor_s + step);
    }
}
