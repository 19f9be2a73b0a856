//! Estimates so far and missing information: beside the servo, and for a loaded recording.

use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::calibrate::state::Calibration;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{bar, card, compact, plain_card, remark, segmented};
use crate::ui::train::assistant::readings::{NEEDLE, only_thing};
use crate::ui::train::trainer::live::Trainer;
use crate::ui::train::trainer::watch::{Watch, task_of as watched_task};
use egui::{Align, Layout, RichText, Ui};
use estimator::estimate::Parameter;
use estimator::online::information::Enough;
use estimator::online::leak::Verdict;
use estimator::online::{Event, Report};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const ON: &str = "On";
    pub const ON_MORE: &str = "Measure the object while it is handled";
    pub const WHAT_THE_HAND: &str = "What the hand has measured so far";
    pub const SWITCHED_OFF: &str = "Switched off.";
    pub const BLOCKS_BARRELS_AND_CRANKS: &str =
        "Blocks, barrels and cranks are measured while they are handled; this world has none.";
    pub const NOTHING_YET_PICK: &str = "Nothing yet: pick something up.";
    pub const NOTHING_YET_PICK_IT_UP: &str = "Nothing yet: pick it up, carry it, let go; or turn the handle.";
    pub const ACCURACY: &str = "Accuracy";
    pub const FORGET: &str = "Forget";
    pub const FORGET_MORE: &str = "Begins to measure anew";
    pub const COARSE: &str = "Coarse";
    pub const COARSE_MORE: &str = "Three times the usual standard errors will do";
    pub const USUAL: &str = "Usual";
    pub const USUAL_MORE: &str = "1 % of weights, 0.5 % of widths, 5 % of frictions";
    pub const FINE: &str = "Fine";
    pub const FINE_MORE: &str = "A third of the usual standard errors";
    pub const IT_LEAKS: &str = "It leaks";
    pub const THE_SENSORS_DRIFT: &str = "The sensors drift";
    pub const IT_LEAKS_AND_THE_SENSORS: &str = "It leaks, and the sensors drift";
    pub const LEAK_OR_SENSOR: &str = "Leak or sensor drift: it cannot be told yet";
    pub const NOT_SHOWN_YET: &str = "not shown yet";
    pub const NO_WISH_YET: &str = "How well it must be known can be said once there is a value.";
    pub const ENOUGH_DATA: &str = "Enough data?";
}

/// Display time of a change, s.
const TOLD_S: f64 = 20.0;

/// The card beside the trainer's picture.
pub fn beside(ui: &mut Ui, trainer: &mut Trainer) {
    let Some((_, world)) = trainer.scene() else { return };
    let (task, called) = (watched_task(world), only_thing(world));
    let watch = &mut trainer.watch;
    let mut on = watch.on;
    let switch = |ui: &mut Ui| {
        ui.checkbox(&mut on, words::ON).on_hover_text(words::ON_MORE);
    };
    let mut again = false;
    card(ui, words::WHAT_THE_HAND, switch, |ui| match (task, watch.report()) {
        _ if !watch.on => drop(ui.label(theme::caption(ui, words::SWITCHED_OFF))),
        (None, _) => {
            drop(ui.label(theme::caption(ui, words::BLOCKS_BARRELS_AND_CRANKS)));
        }
        (_, None) => drop(ui.label(theme::caption(ui, words::NOTHING_YET_PICK))),
        (_, Some(report)) => again = told(ui, watch, &report, called),
    });
    if again {
        watch.forget();
    }
    watch.on = on;
}

/// Draws the report; true if the estimation should restart.
fn told(ui: &mut Ui, watch: &mut Watch, report: &Report, called: Option<&str>) -> bool {
    if report.enough.is_empty() {
        ui.label(theme::caption(ui, words::NOTHING_YET_PICK_IT_UP));
        return false;
    }
    rows(ui, &report.parameters, &report.enough, called);
    notices(ui, report, called);
    ui.add_space(space::XS);
    let mut again = false;
    compact(ui, |ui| {
        ui.label(theme::caption(ui, words::ACCURACY));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            again = ui.link(words::FORGET).on_hover_text(words::FORGET_MORE).clicked();
        });
    });
    let choices = [
        (3.0, words::COARSE, words::COARSE_MORE),
        (1.0, words::USUAL, words::USUAL_MORE),
        (1.0 / 3.0, words::FINE, words::FINE_MORE),
    ];
    segmented(ui, &mut watch.coarser, &choices);
    again
}

fn notices(ui: &mut Ui, report: &Report, called: Option<&str>) {
    let say = |ui: &mut Ui, text: String, mark| {
        ui.add_space(space::XS);
        remark(ui, mark, text);
    };
    if let Some(margin) = report.slip_margin {
        let share = format::number(100.0 * margin.max(0.0), 0);
        say(ui, format!("{share} % of the shear that surely held is still free."), Icon::Told);
    }
    for (object, answer) in report.leaks.iter().filter(|_| called != Some(NEEDLE)) {
        let word = match answer.verdict {
            Verdict::Leak => words::IT_LEAKS,
            Verdict::SensorDrift => words::THE_SENSORS_DRIFT,
            Verdict::Both => words::IT_LEAKS_AND_THE_SENSORS,
            Verdict::Steady | Verdict::CannotTell => words::LEAK_OR_SENSOR,
        };
        let advice = answer.motion.as_ref().map_or_else(String::new, |m| format!(" To tell: {m}."));
        say(ui, format!("{}. {word}: {}.{advice}", format::object(object), answer.why), Icon::Doubt);
    }
    for event in report.events.iter().rev().filter(|e| report.time_s - e.noticed_s < TOLD_S).take(2) {
        say(ui, event_words(event), Icon::Doubt);
    }
}

fn event_words(event: &Event) -> String {
    let at = format::number(event.began_s, 1);
    if event.parameter == "center_m" {
        return format!("At {at} s the circle jumped: the grasp slipped on the handle. It is measured anew.");
    }
    let quantity = format::parameter(event.parameter, Some(event.before));
    let before = format::significant(event.before * quantity.factor, 3);
    let way = if event.grows { "grew" } else { "fell" };
    format!(
        "At {at} s a change was noticed ({} {way}, before {before} {}); it is measured anew.",
        quantity.label, quantity.unit
    )
}

/// Draws one block of lines per object: value ± standard error, a bar to the target accuracy, and the missing motion.
/// `called` names the object where the estimator takes it for a block.
pub fn rows(ui: &mut Ui, parameters: &[Parameter], all: &[Enough], called: Option<&str>) {
    let mut object = "";
    // Mass is weight over gravity: one line is enough.
    let told = |e: &&Enough| e.name != "mass_kg" && !(called == Some(NEEDLE) && e.name == "weight_N");
    for enough in all.iter().filter(told) {
        if enough.object != object {
            object = &enough.object;
            ui.add_space(space::XS);
            ui.label(theme::strong(format::object(called.unwrap_or(object))));
        }
        let parameter = parameters.iter().find(|p| p.object == enough.object && p.name == enough.name);
        row(ui, enough, parameter);
    }
}

fn row(ui: &mut Ui, enough: &Enough, parameter: Option<&Parameter>) {
    let p = palette(ui);
    let value = parameter.filter(|q| q.identified).and_then(|q| q.value);
    let quantity = format::parameter(&enough.name, value);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let line = compact(ui, |ui| {
            ui.label(RichText::new(&quantity.label).size(12.0).color(p.secondary));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| match value {
                Some(value) => {
                    let (value, error) =
                        format::with_error(value * quantity.factor, enough.std_error.map(|e| e * quantity.factor));
                    let error = error.map_or_else(String::new, |e| format!(" ± {e}"));
                    ui.label(RichText::new(format!("{value}{error} {}", quantity.unit)).size(12.0))
                }
                None => ui.label(RichText::new(words::NOT_SHOWN_YET).size(12.0).italics().color(p.faint)),
            })
            .response
        });
        let color = if enough.share >= 1.0 { p.good } else { p.accent };
        bar(ui, enough.share, 1.0, None, color);
        let hover = parameter.map_or_else(String::new, |q| sentence(&q.how));
        line.on_hover_text(format!("{hover}\n{}", wish(enough, quantity.factor, quantity.unit)));
        if enough.share < 1.0 {
            ui.label(RichText::new(format::capitalised(&format::missing(enough))).size(11.0).color(p.secondary));
        }
    });
    ui.add_space(space::XS);
}

fn wish(enough: &Enough, factor: f64, unit: &str) -> String {
    let share = format::number(100.0 * enough.share, 0);
    match enough.wanted {
        Some(wanted) => {
            format!(
                "Wanted: ± {} {unit} (1 σ); {share} % of the information for it is there.",
                format::significant(wanted * factor, 2)
            )
        }
        None => words::NO_WISH_YET.to_owned(),
    }
}

/// The card under the parameters of a loaded recording.
pub fn of_recording(ui: &mut Ui, calibration: &Calibration) {
    let Some(analysis) = calibration.analysis.as_ref().filter(|_| !calibration.enough.is_empty()) else {
        return;
    };
    let done = calibration.enough.iter().filter(|e| e.share >= 1.0).count();
    plain_card(ui, words::ENOUGH_DATA, |ui| {
        ui.label(theme::caption(
            ui,
            format!("{done} of {} parameters are known as well as wanted.", calibration.enough.len()),
        ));
        let missing: Vec<Enough> = calibration.enough.iter().filter(|e| e.share < 1.0).cloned().collect();
        rows(ui, &analysis.fit.parameters, &missing, None);
    });
}
