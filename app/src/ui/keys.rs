//! Keys of the whole window.

use super::files;
use super::jobs::Purpose;
use super::session::{Session, Workspace};
use egui::{Key, KeyboardShortcut, Modifiers, Ui, ViewportCommand};

/// Share of the visible time that an arrow key moves the cursor by.
const SCRUB_SHARE: f64 = 0.01;

/// Handles keys that are not meant for a text field.
pub fn handle(ui: &Ui, session: &mut Session) {
    let ctx = ui.ctx().clone();
    let command = |key| KeyboardShortcut::new(Modifiers::COMMAND, key);
    if ctx.input_mut(|i| i.consume_shortcut(&command(Key::O))) {
        files::ask(&ctx, &mut session.jobs, Purpose::OpenLog);
    }
    if ctx.input_mut(|i| i.consume_shortcut(&command(Key::Num1))) {
        session.workspace = Workspace::Train;
    }
    if ctx.input_mut(|i| i.consume_shortcut(&command(Key::Num2))) {
        session.workspace = Workspace::Calibrate;
    }
    if ctx.input_mut(|i| i.consume_shortcut(&command(Key::Num3))) {
        session.workspace = Workspace::Diagnose;
    }
    if ctx.input_mut(|i| i.consume_shortcut(&command(Key::Num4))) {
        session.workspace = Workspace::Devices;
    }
    if ctx.input(|i| i.key_pressed(Key::F5)) {
        session.reload(&ctx);
    }
    if ctx.input(|i| i.key_pressed(Key::F11)) {
        let full = ctx.input(|i| i.viewport().fullscreen.unwrap_or(false));
        ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!full));
    }
    if ctx.egui_wants_keyboard_input() {
        return;
    }
    match session.workspace {
        Workspace::Calibrate => playback(&ctx, session),
        Workspace::Devices | Workspace::Diagnose => {}
        Workspace::Train => {
            if ctx.input(|i| i.key_pressed(Key::R)) && !session.trainer.is_recording() {
                super::recorder::start(session);
            }
        }
    }
}

fn playback(ctx: &egui::Context, session: &mut Session) {
    let pressed = |key| ctx.input(|i| i.key_pressed(key));
    if ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Space)) {
        session.toggle_play();
    }
    let coarse = if ctx.input(|i| i.modifiers.shift) { 10.0 } else { 1.0 };
    let step = SCRUB_SHARE * coarse * (session.view_s.1 - session.view_s.0);
    if pressed(Key::ArrowLeft) {
        session.seek(session.cursor_s - step);
    }
    if pressed(Key::ArrowRight) {
        session.seek(session.cursor_s + step);
    }
    if pressed(Key::Home) {
        session.seek(f64::NEG_INFINITY);
    }
    if pressed(Key::End) {
        session.seek(f64::INFINITY);
    }
}
