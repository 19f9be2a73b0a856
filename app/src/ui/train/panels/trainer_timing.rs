//! Timing of the servo, in numbers.

use crate::text::format;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{card, fact};
use crate::ui::train::trainer::live::Trainer;
use egui::{RichText, Ui, vec2};
use haptics::servo::coupling::{Coupling, SOFTEST_N_M};
use haptics::servo::timing::{RECENT_S, Timing};
use haptics::servo::{Percentiles, Snapshot};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const TIMING: &str = "Timing";
    pub const NO_TICK_WAS: &str = "No tick was timed yet: the figures come as soon as the servo runs.";
    pub const PERIOD: &str = "Period";
    pub const LATENESS: &str = "Lateness";
    pub const COMPUTE: &str = "Compute";
    pub const FORCE_AGE: &str = "Force age";
    pub const SINCE_START: &str = "since start";
    pub const NEW_AT_THIS_TICK: &str = "new at this tick";
    pub const MISSED_DEADLINES: &str = "Missed deadlines";
    pub const AGE_OF_THE_NEWEST: &str = "Age of the newest sample";
}

/// The card beside the trainer's picture.
pub fn timing(ui: &mut Ui, trainer: &Trainer) {
    let Some((snapshot, _)) = trainer.scene() else { return };
    let timing = &snapshot.timing;
    let rate = format!("{} Hz", format::number(timing.rate.rate_hz, 0));
    card(
        ui,
        words::TIMING,
        |ui| drop(ui.label(theme::caption(ui, rate)).on_hover_text(timing.rate.sentence())),
        |ui| {
            ui.spacing_mut().interact_size.y = 15.0;
            if was_timed(&timing.compute) {
                table(ui, timing);
            } else {
                ui.label(theme::caption(ui, words::NO_TICK_WAS));
            }
            ui.add_space(space::XS);
            facts(ui, snapshot);
            sentences(ui, trainer, snapshot);
        },
    );
}

fn table(ui: &mut Ui, timing: &Timing) {
    egui::Grid::new("timing").num_columns(5).min_col_width(46.0).spacing(vec2(8.0, 3.0)).show(ui, |ui| {
        // Recent and overall values: a stall while the window opened is no news an hour later.
        let recent = &timing.recent;
        head(ui, &format!("last {RECENT_S:.0} s"));
        percentiles(ui, words::PERIOD, &recent.period);
        percentiles(ui, words::LATENESS, &recent.lateness);
        percentiles(ui, words::COMPUTE, &recent.compute);
        percentiles(ui, words::FORCE_AGE, &recent.force_age);
        head(ui, words::SINCE_START);
        percentiles(ui, words::PERIOD, &timing.period);
        percentiles(ui, words::LATENESS, &timing.lateness);
        percentiles(ui, words::COMPUTE, &timing.compute);
        percentiles(ui, words::FORCE_AGE, &timing.force_age);
    });
}

/// True if anything was measured: no duration of a real clock is exactly zero.
fn was_timed(p: &Percentiles) -> bool {
    p.max_s > 0.0
}

/// Age of a device's newest sample, as text.
pub fn sample_age(age_s: f64) -> String {
    if age_s > 0.0 { format::short_time(age_s) } else { words::NEW_AT_THIS_TICK.to_owned() }
}

fn facts(ui: &mut Ui, snapshot: &Snapshot) {
    let timing = &snapshot.timing;
    let recent = &timing.recent;
    if was_timed(&timing.compute) {
        let text =
            format!("{} of {} ticks; since start {} of {}", recent.missed, recent.ticks, timing.missed, timing.ticks);
        fact(ui, words::MISSED_DEADLINES, text);
    }
    fact(ui, words::AGE_OF_THE_NEWEST, sample_age(timing.sample_age_s));
}

fn sentences(ui: &mut Ui, trainer: &Trainer, snapshot: &Snapshot) {
    let p = palette(ui);
    let timing = &snapshot.timing;
    ui.add_space(space::XS);
    let color = if timing.rate.overloaded { p.danger } else { p.secondary };
    ui.label(RichText::new(timing.rate.sentence()).size(11.5).color(color));
    if let Some(stalls) = timing.stall_sentence() {
        ui.label(theme::caption(ui, stalls));
    }
    if let Some(coupling) = &snapshot.coupling {
        ui.label(theme::caption(ui, coupling_sentence(coupling)));
    }
    if let Some(privileges) = trainer.privileges() {
        ui.label(theme::caption(ui, privileges.sentence()));
    }
}

/// Description of the feel through a virtual coupling.
pub fn coupling_sentence(coupling: &Coupling) -> String {
    if coupling.damping_n_s_m == 0.0 && coupling.stiffness_n_m <= SOFTEST_N_M {
        return format!(
            "The device feels the world through a soft spring of {} N/m: with what is known of its damping, friction and steps \
             nothing stiffer is surely passive.",
            format::number(coupling.stiffness_n_m, 0)
        );
    }
    format!(
        "The device feels the world through a spring of {} N/m: the stiffest that stays passive on it at this rate.",
        format::number(coupling.stiffness_n_m, 0)
    )
}

fn head(ui: &mut Ui, span: &str) {
    for text in [span, "p50", "p99", "p99.9", "max"] {
        ui.label(theme::caption(ui, text));
    }
    ui.end_row();
}

fn percentiles(ui: &mut Ui, label: &str, p: &Percentiles) {
    ui.label(theme::caption(ui, label));
    for seconds in [p.p50_s, p.p99_s, p.p999_s, p.max_s] {
        // A pointer renders no force, so the force has no age.
        let text = if was_timed(p) { format::short_time(seconds) } else { "–".to_owned() };
        ui.label(RichText::new(text).size(11.5));
    }
    ui.end_row();
}
