//! Which parts of the assistant are shown over the picture.

use crate::ui::assistant;
use crate::ui::session::Session;
use crate::ui::theme;
use crate::ui::widgets::{call, card};
use egui::Ui;

/// The card beside the trainer's picture.
pub fn assistant(ui: &mut Ui, session: &mut Session) {
    let silent = assistant::silent(session);
    let parts = &mut session.assistant;
    let mut on = parts.on;
    let switch = |ui: &mut Ui| {
        let hint = "Says over the picture what the hand has measured, and warns (H)";
        let response = ui.checkbox(&mut on, "On").on_hover_text(hint);
        call(&response, "Assistant on");
    };
    card(ui, "Assistant", switch, |ui| {
        if let Some(why) = silent {
            ui.label(theme::caption(ui, why));
            return;
        }
        if !parts.on {
            ui.label(theme::caption(ui, "Switched off: nothing is said over the picture."));
            return;
        }
        let choices: [(&mut bool, &str, &str); 7] = [
            (&mut parts.held, "What is held", "Weight, width and stiffness, each with its error, once they are known"),
            (&mut parts.slip, "Slip margin", "How much of the friction is free, as far as it is known"),
            (&mut parts.contents, "Contents", "What may be in a vessel, by the density of what it holds"),
            (&mut parts.force, "Too much force", "Warns from 80 % of what a finger should press"),
            (&mut parts.collision, "Collisions", "Warns of what will be hit faster than 60 mm/s before you could stop"),
            (&mut parts.edge, "Edge of reach", "Warns where the hand's workspace ends"),
            (
                &mut parts.constraint,
                "What holds it",
                "Draws a cable's pull and where it is tied, or the circle of a crank",
            ),
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
    session.assistant.on = on;
}
