//! The card of a diagnosed cause.

use crate::text::diagnosis_words::{gain_unit, said_in_words, shown_unit, small, symbol, title};
use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{bar, card, compact};
use egui::{Align, Color32, FontId, Label, Layout, Response, RichText, Sense, Stroke, StrokeKind, Ui, Vec2, vec2};
use estimator::diagnose::{Alternative, Cause, CauseParameter, Findings, Rollout, RolloutOf};
use estimator::words::amount;
use haptics::law::{self, Kind};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const PROBABILITY_MORE: &str = "Probability among the causes that could stand in its place";
    pub const IN_THE_WORLD: &str = "in the world";
    pub const IN_THE_WORLD_MORE: &str = "The extended world has it";
    pub const IN_THE_MEASUREMENT: &str = "in the measurement";
    pub const IN_THE_MEASUREMENT_MORE: &str =
        "A fault of the measurement: it corrects the recording and leaves the world alone";
    pub const THE_MEASURED_FORCE: &str = "the measured force drives it";
    pub const A_HAND_HOLDS: &str = "a hand holds on that wants to be where the motion was measured";
    pub const NOT_RUN: &str = "Not run forward";
    pub const OUT_OF_ALL: &str = "that took part in nothing";
    pub const OUT_OF_THE_FIT: &str = "that were left out of the fit in turn";
    pub const EXPLAINS: &str = "Explains";
    pub const EXPLAINS_MORE: &str =
        "Share of what can be explained (down to the noise) on data that took no part, with its 95 % interval";
    pub const WHAT_IS_LEFT: &str = "What is left goes with this, and no known cause does so here.";
}

/// True if the cause changes the extended world.
pub fn changes_the_world(cause: &Cause) -> bool {
    cause.kind == Kind::Plant && law::cause(&cause.id).is_some()
}

/// Draws the card; `rank` counts from one.
pub(crate) fn cause(ui: &mut Ui, rank: usize, cause: &Cause, diagnosis: &Findings) {
    let p = palette(ui);
    let chance = format!("{} %", format::number(100.0 * cause.posterior, 0));
    let trailing = |ui: &mut Ui| {
        ui.label(theme::strong(chance)).on_hover_text(words::PROBABILITY_MORE);
    };
    card(ui, &format!("{rank}  {}", title(&cause.id)), trailing, |ui| {
        bar(ui, cause.posterior, 1.0, None, p.accent);
        ui.add_space(space::XS);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = space::XS;
            chip(ui, &cause.id, p.secondary).on_hover_ui(|ui| page(ui, &cause.id));
            match cause.kind {
                _ if changes_the_world(cause) => {
                    chip(ui, words::IN_THE_WORLD, p.good).on_hover_text(words::IN_THE_WORLD_MORE);
                }
                // An unnamed term has no law, either.
                Kind::Plant => {}
                Kind::Instrument => {
                    chip(ui, words::IN_THE_MEASUREMENT, p.caution).on_hover_text(words::IN_THE_MEASUREMENT_MORE);
                }
            }
        });
        for parameter in &cause.parameters {
            line(ui, parameter);
        }
        gain(ui, cause, diagnosis);
        if let Some(rollout) = &cause.gain.rollout {
            forward(ui, rollout);
        } else if let Some(why) = &cause.gain.no_rollout {
            ui.add(Label::new(theme::caption(ui, format!("{}: {why}", words::NOT_RUN))).wrap());
        }
        ui.add(Label::new(theme::caption(ui, sentence(&cause.evidence))).wrap());
        for other in diagnosis.alternatives.iter().filter(|a| a.instead_of == cause.id) {
            alternative(ui, other);
        }
    });
}

/// Rollout error of the base model and of the model with this cause.
fn forward(ui: &mut Ui, rollout: &Rollout) {
    let rms = |value: f64| amount(value, &rollout.unit);
    let (what, how) = match rollout.of {
        RolloutOf::Position => ("position", words::THE_MEASURED_FORCE),
        RolloutOf::Force => ("force", words::A_HAND_HOLDS),
    };
    let text = format!(
        "Run forward {} s, {what} is off by {} → {}",
        format::number(rollout.window_s, 1),
        rms(rollout.rms_before),
        rms(rollout.rms_after)
    );
    let [low, high] = rollout.interval.map(|share| format::number(100.0 * share, 0));
    let held_out = if rollout.in_turn { words::OUT_OF_THE_FIT } else { words::OUT_OF_ALL };
    ui.add(Label::new(theme::caption(ui, text)).wrap()).on_hover_text(format!(
        "Root mean square over {} windows {held_out}, each from its measured start; {how}. {low} to {high}\u{a0}% of the error's power go \
         with this cause.",
        rollout.windows
    ));
}

/// Draws a parameter with its standard error.
fn line(ui: &mut Ui, parameter: &CauseParameter) {
    if let Some(said) = said_in_words(parameter) {
        ui.label(theme::strong(said));
        return;
    }
    compact(ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let (value, error) = format::with_error(parameter.value, Some(parameter.std_error));
            let error = error.map_or_else(String::new, |e| format!(" ± {e}"));
            ui.label(RichText::new(shown_unit(&parameter.unit)).size(12.0).color(palette(ui).secondary));
            ui.label(RichText::new(error).color(palette(ui).secondary));
            ui.scope(|ui| {
                ui.spacing_mut().item_spacing.x = 0.0;
                ui.label(theme::strong(value));
            });
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                let name = RichText::new(symbol(&parameter.name)).color(palette(ui).secondary);
                ui.add(Label::new(name).truncate());
            });
        });
    });
}

fn gain(ui: &mut Ui, cause: &Cause, diagnosis: &Findings) {
    let gain = &cause.gain;
    if gain.heldout_rms_before <= 0.0 {
        return;
    }
    let percent = |share: f64| format::number(100.0 * share, 0);
    let [low, high] = gain.interval;
    let unit = gain_unit(cause, diagnosis);
    compact(ui, |ui| {
        ui.label(theme::caption(ui, words::EXPLAINS));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let rms = |value: f64| format::significant(unit.1 * value, 2);
            let text = format!("{} → {} {} RMS", rms(gain.heldout_rms_before), rms(gain.heldout_rms_after), unit.0);
            ui.label(theme::caption(ui, text));
            if let Some(why) = &gain.no_share {
                ui.label(RichText::new("–").size(12.0)).on_hover_text(sentence(why));
                return;
            }
            let text = format!("{} % [{}, {}]", percent(gain.share_of_explainable), percent(low), percent(high));
            ui.label(RichText::new(text).size(12.0)).on_hover_text(words::EXPLAINS_MORE);
        });
    });
}

fn alternative(ui: &mut Ui, other: &Alternative) {
    ui.add_space(space::XS);
    compact(ui, |ui| {
        ui.label(theme::caption(ui, "or"));
        ui.label(RichText::new(title(&other.id)).size(12.0)).on_hover_ui(|ui| page(ui, &other.id));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(RichText::new(format!("{} %", format::number(100.0 * other.posterior, 0))).size(12.0));
        });
    });
    bar(ui, other.posterior, 1.0, None, palette(ui).faint);
    ui.add(Label::new(theme::caption(ui, sentence(&other.why))).wrap());
}

/// Corners of a chip, points.
const CORNER: f32 = 9.0;

/// Draws a small outlined label.
pub(crate) fn chip(ui: &mut Ui, text: &str, color: Color32) -> Response {
    const AROUND: Vec2 = vec2(7.0, 4.0);
    let (fill, rim) = (palette(ui).sunken, palette(ui).border);
    let galley = ui.painter().layout_no_wrap(text.to_owned(), FontId::proportional(11.0), color);
    // As one piece: in a wrapping row it moves to the next line whole.
    let (rect, response) = ui.allocate_exact_size(galley.size() + 2.0 * AROUND, Sense::hover());
    ui.painter().rect(rect, CORNER, fill, Stroke::new(1.0, rim), StrokeKind::Inside);
    ui.painter().galley(rect.min + AROUND, galley, color);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Label, true, text));
    response
}

/// Draws the catalogue's entry.
fn page(ui: &mut Ui, id: &str) {
    ui.set_max_width(320.0);
    let Some(entry) = law::cause(id) else {
        ui.label(words::WHAT_IS_LEFT);
        return;
    };
    ui.label(theme::strong(entry.title));
    ui.label(RichText::new(entry.equation).monospace());
    ui.label(entry.what);
    ui.label(theme::caption(ui, format!("It shows: {}", small(entry.shows))));
    ui.label(theme::caption(ui, entry.mimics));
    ui.label(theme::caption(ui, entry.reveals));
}
