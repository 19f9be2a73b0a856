//! The world before and after a diagnosis, to be felt by turns.

use crate::ui::session::Session;
use crate::ui::theme;
use crate::ui::trainer::WorldChoice;
use crate::ui::widgets::{card_with_head, compact, key_hint, segmented};
use egui::{Align, Key, Layout, Ui};

/// The card beside the trainer's picture, while there is something to compare.
pub fn compare(ui: &mut Ui, session: &mut Session) {
    if session.trainer.compare.is_none() {
        return;
    }
    let shown = session.trainer.choice;
    let mut choice = shown;
    let choices = [
        (WorldChoice::Before, "A  before", "The model alone"),
        (WorldChoice::After, "B  after", "The model with what the diagnosis found"),
    ];
    let (mut changed, mut closed) = (false, false);
    card_with_head(
        ui,
        "Feel it",
        30.0,
        |ui| changed = segmented(ui, &mut choice, &choices),
        |ui| {
            let text = match shown {
                WorldChoice::Before => "This is the model as it was. Everything stays where it is when you switch.",
                WorldChoice::After => {
                    "This is the model with what was found. Everything stays where it is when you switch."
                }
                _ => "Choose a side; from then on everything stays where it is when you switch.",
            };
            ui.label(theme::caption(ui, text));
            compact(ui, |ui| {
                key_hint(ui, "B", "switches while you hold it");
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    closed = ui.link("Close").on_hover_text("Back to the other worlds").clicked();
                });
            });
        },
    );
    if changed {
        switch(session, choice);
    }
    if closed {
        session.trainer.compare = None;
        if matches!(session.trainer.choice, WorldChoice::Before | WorldChoice::After) {
            switch(session, WorldChoice::default());
        }
    }
}

/// The key that switches; for hands that hold something.
pub fn key(ui: &Ui, session: &mut Session) {
    if session.trainer.compare.is_none() || ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    if ui.input(|i| i.key_pressed(Key::B)) {
        let other = if session.trainer.choice == WorldChoice::After { WorldChoice::Before } else { WorldChoice::After };
        switch(session, other);
    }
}

fn switch(session: &mut Session, choice: WorldChoice) {
    if let Err(problem) = session.trainer.choose(choice) {
        session.fail(problem);
    }
}
