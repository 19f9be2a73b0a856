//! Switches of the assistant's parts over the picture.

use crate::ui::kit::theme;
use crate::ui::kit::widgets::{call, card};
use crate::ui::train::assistant::readings;
use crate::ui::train::state::Training;
use egui::Ui;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const SAYS_OVER_THE_PICTURE: &str = "Says over the picture what the hand has measured, and warns (H)";
    pub const ON: &str = "On";
    pub const ASSISTANT_ON: &str = "Assistant on";
    pub const ASSISTANT: &str = "Assistant";
    pub const SWITCHED_OFF_NOTHING: &str = "Switched off: nothing is said over the picture.";
    pub const WHAT_IS_HELD: &str = "What is held";
    pub const WHAT_IS_HELD_MORE: &str = "Weight, width and stiffness, each with its error, once they are known";
    pub const SLIP_MARGIN: &str = "Slip margin";
    pub const SLIP_MARGIN_MORE: &str = "How much of the friction is free, as far as it is known";
    pub const CONTENTS: &str = "Contents";
    pub const CONTENTS_MORE: &str = "What may be in a vessel, by the density of what it holds";
    pub const TOO_MUCH_FORCE: &str = "Too much force";
    pub const TOO_MUCH_FORCE_MORE: &str = "Warns from 80 % of what a finger should press";
    pub const COLLISIONS: &str = "Collisions";
    pub const COLLISIONS_MORE: &str = "Warns of what will be hit faster than 60 mm/s before you could stop";
    pub const EDGE_OF_REACH: &str = "Edge of reach";
    pub const EDGE_OF_REACH_MORE: &str = "Warns where the hand's workspace ends";
    pub const WHAT_HOLDS_IT: &str = "What holds it";
    pub const WHAT_HOLDS_IT_MORE: &str = "Draws a cable's pull and where it is tied, or the circle of a crank";
}

/// The card beside the trainer's picture.
pub fn assistant(ui: &mut Ui, training: &mut Training) {
    let silent = readings::silent(&training.lessons);
    let parts = &mut training.assistant;
    let mut on = parts.on;
    let switch = |ui: &mut Ui| {
        let hint = words::SAYS_OVER_THE_PICTURE;
        let response = ui.checkbox(&mut on, words::ON).on_hover_text(hint);
        call(&response, words::ASSISTANT_ON);
    };
    card(ui, words::ASSISTANT, switch, |ui| {
        if let Some(why) = silent {
            ui.label(theme::caption(ui, why));
            return;
        }
        if !parts.on {
            ui.label(theme::caption(ui, words::SWITCHED_OFF_NOTHING));
            return;
        }
        let choices: [(&mut bool, &str, &str); 7] = [
            (&mut parts.held, words::WHAT_IS_HELD, words::WHAT_IS_HELD_MORE),
            (&mut parts.slip, words::SLIP_MARGIN, words::SLIP_MARGIN_MORE),
            (&mut parts.contents, words::CONTENTS, words::CONTENTS_MORE),
            (&mut parts.force, words::TOO_MUCH_FORCE, words::TOO_MUCH_FORCE_MORE),
            (&mut parts.collision, words::COLLISIONS, words::COLLISIONS_MORE),
            (&mut parts.edge, words::EDGE_OF_REACH, words::EDGE_OF_REACH_MORE),
            (&mut parts.constraint, words::WHAT_HOLDS_IT, words::WHAT_HOLDS_IT_MORE),
        ];
        let mut choices = choices.into_iter();
        while let Some(first) = choices.next() {
            let second = choices.next();
            ui.columns(2, |columns| {
                for (ui, (value, label, hint)) in columns.iter_mut().zip(std::iter::once(first).chain(second)) {
                    ui.checkbox(value, label).on_hover_text(hint);
                }
            });
        }
    });
    training.assistant.on = on;
}
