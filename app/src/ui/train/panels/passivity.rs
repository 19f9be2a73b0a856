//! The passivity observer's reading, and the switch of the controller.

use crate::text::format::number;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::widgets::{card, fact, remark};
use crate::ui::shell::message_list::Messages;
use crate::ui::train::trainer::control::USUAL_CONTROL_N_S_M;
use crate::ui::train::trainer::live::Trainer;
use egui::{Align, Layout, Ui};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const CONTROLLER: &str = "Controller";
    pub const NOT_WHILE_A_RECORDING: &str = "Not while a recording runs.";
    pub const PASSIVITY: &str = "Passivity";
    pub const ENERGY_TAKEN_IN: &str = "Energy taken in";
    pub const MORE_WAS_GIVEN: &str =
        "More was given out than taken in: the force on you may swing. The controller brakes it.";
    pub const BRAKES_WITH_AT_MOST: &str = "Brakes with at most, N s/m";
    pub const BRAKES_WITH_AT_MOST_MORE: &str =
        "The extra damping on each of your fingers; more takes the energy back sooner";
}

const WHY: &str = "The observer always counts the energy that the world has taken in. When more was given out than taken in (below \
                   zero) the force on you can start to swing; the controller then brakes your fingers until it is back. It is off \
                   unless you want it: it makes some contacts feel sticky.";

/// Energy below which a warning is shown, J: rounding and brief moments are above it.
const GIVEN_OUT_J: f64 = -0.5e-3;

/// Selectable damping limits, N s/m.
const STRENGTHS: [(&str, f64); 3] = [("0.5", 0.5), ("2", USUAL_CONTROL_N_S_M), ("10", 10.0)];

/// The card beside the trainer's picture and on the devices page.
pub fn passivity(ui: &mut Ui, trainer: &mut Trainer, messages: &mut Messages) {
    let Some(energy_j) = trainer.scene().map(|(snapshot, _)| snapshot.tick.energy_j) else { return };
    let before = trainer.control_n_s_m();
    let (mut on, mut most) = (before.is_some(), before.unwrap_or(USUAL_CONTROL_N_S_M));
    // The servo restarts, which would end a recording.
    let free = !trainer.is_recording();
    let switch = |ui: &mut Ui| {
        let response = ui.add_enabled(free, egui::Checkbox::new(&mut on, words::CONTROLLER));
        response.on_hover_text(WHY).on_disabled_hover_text(words::NOT_WHILE_A_RECORDING);
    };
    card(ui, words::PASSIVITY, switch, |ui| {
        fact(ui, words::ENERGY_TAKEN_IN, format!("{} mJ", number(energy_j * 1e3, 1)));
        if energy_j < GIVEN_OUT_J {
            let text = words::MORE_WAS_GIVEN;
            remark(ui, Icon::Doubt, text);
        }
        if before.is_some() {
            ui.add_enabled_ui(free, |ui| strength(ui, &mut most));
        }
    });
    let wanted = on.then_some(most);
    if wanted != before
        && let Err(problem) = trainer.set_control(wanted)
    {
        messages.fail(problem);
    }
}

fn strength(ui: &mut Ui, most: &mut f64) {
    ui.horizontal(|ui| {
        ui.label(theme::caption(ui, words::BRAKES_WITH_AT_MOST));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for (label, value) in STRENGTHS.iter().rev() {
                let hint = words::BRAKES_WITH_AT_MOST_MORE;
                ui.selectable_value(most, *value, *label).on_hover_text(hint);
            }
        });
    });
}
