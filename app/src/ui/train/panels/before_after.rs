//! The base and the extended world of a diagnosis, to be felt alternately.

use crate::ui::kit::theme;
use crate::ui::kit::widgets::{card_with_head, compact, key_hint, segmented};
use crate::ui::shell::message_list::Messages;
use crate::ui::train::trainer::live::Trainer;
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui::{Align, Key, Layout, Ui};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const BEFORE: &str = "A  before";
    pub const BEFORE_MORE: &str = "The model alone";
    pub const AFTER: &str = "B  after";
    pub const AFTER_MORE: &str = "The model with what the diagnosis found";
    pub const FEEL_IT: &str = "Feel it";
    pub const THIS_IS_THE_MODEL_AS_IT_WAS: &str =
        "This is the model as it was. Everything stays where it is when you switch.";
    pub const THIS_IS_THE_MODEL_WITH_WHAT: &str =
        "This is the model with what was found. Everything stays where it is when you switch.";
    pub const CHOOSE_A_SIDE: &str = "Choose a side; from then on everything stays where it is when you switch.";
    pub const SWITCHES_WHILE_YOU: &str = "switches while you hold it";
    pub const CLOSE: &str = "Close";
    pub const CLOSE_MORE: &str = "Back to the other worlds";
}

/// Card beside the trainer's picture, while there are worlds to compare.
pub fn compare(ui: &mut Ui, trainer: &mut Trainer, messages: &mut Messages) {
    if trainer.compare.is_none() {
        return;
    }
    let shown = trainer.choice;
    let mut choice = shown;
    let choices = [
        (WorldChoice::Before, words::BEFORE, words::BEFORE_MORE),
        (WorldChoice::After, words::AFTER, words::AFTER_MORE),
    ];
    let (mut changed, mut closed) = (false, false);
    card_with_head(
        ui,
        words::FEEL_IT,
        30.0,
        |ui| changed = segmented(ui, &mut choice, &choices),
        |ui| {
            let text = match shown {
                WorldChoice::Before => words::THIS_IS_THE_MODEL_AS_IT_WAS,
                WorldChoice::After => words::THIS_IS_THE_MODEL_WITH_WHAT,
                _ => words::CHOOSE_A_SIDE,
            };
            ui.label(theme::caption(ui, text));
            compact(ui, |ui| {
                key_hint(ui, "B", words::SWITCHES_WHILE_YOU);
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    closed = ui.link(words::CLOSE).on_hover_text(words::CLOSE_MORE).clicked();
                });
            });
        },
    );
    if changed {
        switch(trainer, messages, choice);
    }
    if closed {
        trainer.compare = None;
        if matches!(trainer.choice, WorldChoice::Before | WorldChoice::After) {
            switch(trainer, messages, WorldChoice::default());
        }
    }
}

/// Handles the key that switches, for hands that hold an object.
pub fn key(ui: &Ui, trainer: &mut Trainer, messages: &mut Messages) {
    if trainer.compare.is_none() || ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    if ui.input(|i| i.key_pressed(Key::B)) {
        let other = if trainer.choice == WorldChoice::After { WorldChoice::Before } else { WorldChoice::After };
        switch(trainer, messages, other);
    }
}

fn switch(trainer: &mut Trainer, messages: &mut Messages, choice: WorldChoice) {
    if let Err(problem) = trainer.choose(choice) {
        messages.fail(problem);
    }
}
