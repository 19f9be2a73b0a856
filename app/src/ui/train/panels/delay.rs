//! The link between hand and world: its latency, its prediction model, and the resulting picture.

use crate::text::format::{number, with_error};
use crate::ui::kit::theme;
use crate::ui::kit::widgets::{card_with_head, fact, segmented};
use crate::ui::shell::message_list::Messages;
use crate::ui::train::trainer::live::Trainer;
use egui::Ui;
use haptics::teleop::{Delay, Weighed};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const DELAY: &str = "Delay";
    pub const PRACTISE_OVER_A_SLOW: &str =
        "Practise over a slow line: the world is far away, and what you see and feel of it comes late.";
    pub const A_MODEL_OF_THE_FAR: &str =
        "A model of the far world answers your hand at once, and learns from what comes back";
    pub const PREDICTIVE_MODEL: &str = "Predictive model";
    pub const UNSTEADY_LINE: &str = "Unsteady line";
    pub const CARRIED_LAST: &str = "Carried last";
}

/// Selectable round-trip times, s.
const ROUND_TRIPS: [(f64, &str, &str); 3] = [
    (0.0, "None", "Your hand is where the world is"),
    (0.15, "150 ms", "A line round half the world: 75 ms there, 75 ms back"),
    (0.5, "500 ms", "A line by satellite: a quarter of a second there, as long back"),
];
/// Effect of an unsteady link on a packet: maximum additional latency, s, and loss rate.
const UNSTEADY: (f64, f64) = (0.02, 0.05);

/// The card beside the trainer's picture.
pub fn delay(ui: &mut Ui, trainer: &mut Trainer, messages: &mut Messages) {
    let before = trainer.delay();
    let (mut line, mut manner) = (before, before);
    // The servo restarts, which would end a recording.
    let free = !trainer.is_recording();
    card_with_head(
        ui,
        words::DELAY,
        30.0,
        |ui| {
            ui.add_enabled_ui(free, |ui| round_trip(ui, &mut line));
        },
        |ui| {
            if before.is_none() {
                let text = words::PRACTISE_OVER_A_SLOW;
                ui.label(theme::caption(ui, text));
            } else {
                ui.add_enabled_ui(free, |ui| choices(ui, &mut manner));
                shown(ui, trainer);
            }
        },
    );
    let wanted = if line == before { manner } else { line };
    if wanted != before
        && let Err(problem) = trainer.set_delay(wanted)
    {
        messages.fail(problem);
    }
}

fn round_trip(ui: &mut Ui, wanted: &mut Delay) {
    let mut chosen = wanted.round_trip_s;
    if segmented(ui, &mut chosen, &ROUND_TRIPS) {
        // The first link has a model, to show the purpose of models.
        let first = wanted.is_none();
        *wanted = if chosen == 0.0 {
            Delay::default()
        } else {
            Delay { round_trip_s: chosen, predicted: wanted.predicted || first, ..*wanted }
        };
    }
}

fn choices(ui: &mut Ui, wanted: &mut Delay) {
    ui.horizontal(|ui| {
        let model = words::A_MODEL_OF_THE_FAR;
        ui.checkbox(&mut wanted.predicted, words::PREDICTIVE_MODEL).on_hover_text(model);
        let mut unsteady = wanted.jitter_s > 0.0 || wanted.loss > 0.0;
        let (jitter_s, loss) = UNSTEADY;
        let hint = format!(
            "Packets come up to {} ms later, and {} % of them never",
            number(1e3 * jitter_s, 0),
            number(1e2 * loss, 0)
        );
        if ui.checkbox(&mut unsteady, words::UNSTEADY_LINE).on_hover_text(hint).clicked() {
            (wanted.jitter_s, wanted.loss) = if unsteady { UNSTEADY } else { (0.0, 0.0) };
        }
    });
}

/// Describes the content of the picture, and the knowledge of the model.
fn shown(ui: &mut Ui, trainer: &Trainer) {
    let Some(view) = trainer.view() else { return };
    let late_ms = number(1e3 * trainer.delay().one_way_s(), 0);
    let text = if view.predicted {
        format!("Solid: the model under your hand, at once. Ghost: the far world as it was {late_ms} ms ago.")
    } else {
        format!("You see the far world as it was {late_ms} ms ago. Move, wait, look.")
    };
    ui.label(theme::caption(ui, text));
    if let (Some(weighed), Some((_, world))) = (view.weighed, trainer.scene()) {
        let gravity = world.gravity_m_s2;
        fact(ui, words::CARRIED_LAST, weight_text(&weighed, gravity));
    }
}

fn weight_text(weighed: &Weighed, gravity_m_s2: f64) -> String {
    let (value, error) = with_error(weighed.mass_kg * gravity_m_s2, Some(weighed.std_kg * gravity_m_s2));
    let error = error.map_or_else(String::new, |error| format!(" ± {error}"));
    format!("{value}{error} N (guess {} N)", number(weighed.guess_kg * gravity_m_s2, 2))
}
