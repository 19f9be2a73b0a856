//! *Record next*: the experiment that would resolve the open question, and three ways to perform it. It can be
//! simulated, performed by hand in Train, or loaded from a file.

use crate::experiment::rehearse::{Outcome, Rehearsal};
use crate::text::diagnosis_words::{listed, one, small, title};
use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::experiment;
use crate::ui::diagnose::experiment_state::{REHEARSE, ROUNDS, Stage};
use crate::ui::diagnose::panels::motion_plan;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::diagnose::state::is_mechanism;
use crate::ui::document::files;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{bar, compact, icon_button, plain_card, primary_button, remark};
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::message_list::Messages;
use crate::ui::train::trainer::live::Trainer;
use egui::{Align, Layout, RichText, TextEdit, Ui};
use estimator::diagnose::{Findings, NextExperiment};
use haptics::law::Coordinate;
use std::path::PathBuf;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const REHEARSE: &str = "Rehearse it";
    pub const PLAN_MORE: &str = "The motion over time, to follow on the real machine. A mechanism that is driven directly has \
        no handle for the fingers of Train.";
    pub const PLAN: &str = "Plan of the motion";
    pub const CANCEL: &str = "Cancel";
    pub const IN_TRAIN: &str = "Do it in Train …";
    pub const ON_WHICH: &str = "On which object?";
    pub const AS_IT_STANDS: &str = "The world that stands in Train";
    pub const IN_TRAIN_MORE: &str = "With the device that moves the fingers: a target to follow, in words and in the picture; \
        it is recorded";
    pub const SIMULATED: &str = "Rehearsed on SIMULATED objects: what would come out, no measurement.";
    pub const ADD_MORE: &str =
        "Saves the simulated recording and diagnoses it with the others, to see what it would settle";
    pub const DID_IT: &str = "Did it on the real object? Add its recording:";
    pub const PATH: &str = "Path, then Enter";
    pub const RECORDING: &str = "Recording of the experiment";
    pub const CHOOSE: &str = "Choose a file";
    pub const RECORD_NEXT: &str = "Record next";
    pub const ADD: &str = "Add";
    pub const SETTLED: &str = "Settled";
    pub const NOT_MEASURED: &str = "Not measured";
}

/// Card below the causes.
pub fn card(ui: &mut Ui, session: &mut Session, diagnosis: &Findings) {
    let Some(next) = &diagnosis.next_experiment else { return };
    plain_card(ui, words::RECORD_NEXT, |ui| {
        ui.add(egui::Label::new(sentence(&next.motion)).wrap());
        let names: Vec<String> = next.separates.iter().map(|id| title(id)).collect();
        let power = format::number(100.0 * next.expected_power, 0);
        let text = format!("Tells {} apart with a probability of {power}\u{a0}%.", listed(&names));
        ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
        bar(ui, next.expected_power, 1.0, None, palette(ui).accent);
        ui.add_space(space::XS);
        if let Some(asked) = &next.experiment {
            let coordinate = driven(&session.document, &session.calibration, diagnosis);
            perform(ui, session, next, coordinate.is_some());
            if let Some(coordinate) = coordinate.filter(|_| session.experiments.shows_plan) {
                motion_plan::show(ui, session, asked, coordinate);
            }
        }
        rehearsal(ui, &session.diagnosing, &session.training.trainer, &mut session.messages, &mut session.jobs, next);
        load(ui, session);
    });
}

/// Coordinate of a directly driven mechanism; `None` for objects that the hand of Train can hold.
fn driven(document: &Document, calibration: &Calibration, diagnosis: &Findings) -> Option<Coordinate> {
    let task = calibration.choice.task;
    let is_mechanism = document.prepared().is_some_and(|p| is_mechanism(&p.recording, task));
    is_mechanism.then_some(if diagnosis.course.is_angular { Coordinate::Angular } else { Coordinate::Linear })
}

/// Draws the buttons: simulated by the scripted operator, or performed by hand, in Train or after a plan on the real
/// mechanism.
fn perform(ui: &mut Ui, session: &mut Session, next: &NextExperiment, is_driven: bool) {
    let ctx = ui.ctx().clone();
    ui.horizontal_wrapped(|ui| {
        let busy = session.jobs.is_running(REHEARSE);
        let hint = format!(
            "The scripted operator does it {ROUNDS} times on each object that is not excluded, and the question is asked again. The \
             objects are simulated: it shows what would come out, and is no measurement."
        );
        if primary_button(ui, !busy, (Icon::Rehearse, words::REHEARSE)).on_hover_text(hint).clicked() {
            experiment::rehearse(&session.document, &session.calibration, &mut session.diagnosing, &mut session.jobs, &ctx);
        }
        if is_driven {
            let hint = words::PLAN_MORE;
            ui.toggle_value(&mut session.experiments.shows_plan, words::PLAN).on_hover_text(hint);
        } else {
            in_train(ui, session, next);
        }
    });
    if session.jobs.is_running(REHEARSE) {
        ui.horizontal(|ui| {
            ui.add(egui::Spinner::new().size(16.0));
            if ui.link(words::CANCEL).clicked() {
                session.give_up(ui.ctx(), REHEARSE);
            }
        });
    }
}

/// Draws a menu of the objects available for it in Train.
fn in_train(ui: &mut Ui, session: &mut Session, next: &NextExperiment) {
    let ctx = ui.ctx().clone();
    let by_hand = egui::Button::new((Icon::Touch, words::IN_TRAIN));
    let menu = egui::containers::menu::MenuButton::from_button(by_hand);
    let (response, _) = menu.ui(ui, |ui| {
        ui.set_max_width(280.0);
        ui.label(theme::caption(ui, words::ON_WHICH));
        if ui.button(words::AS_IT_STANDS).clicked() {
            experiment::guide(session, &ctx, Stage::AsItStands);
        }
        for id in &next.separates {
            if ui.button(format!("This one as if it had {}", one(id))).clicked() {
                experiment::guide(session, &ctx, Stage::AsIf(id.clone()));
            }
        }
    });
    response.on_hover_text(words::IN_TRAIN_MORE);
}

/// Draws the result of the simulation.
fn rehearsal(
    ui: &mut Ui,
    diagnosing: &Diagnosing,
    trainer: &Trainer,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    next: &NextExperiment,
) {
    if let Some(problem) = &diagnosing.rehearsal_problem {
        remark(ui, Icon::Doubt, problem);
    }
    let Some(rehearsal) = diagnosing.rehearsal.clone() else { return };
    ui.add_space(space::XS);
    ui.separator();
    let note = words::SIMULATED;
    remark(ui, Icon::Doubt, note);
    let mut add = None;
    for (k, outcome) in rehearsal.outcomes.iter().enumerate() {
        if object(ui, outcome) {
            add = Some(k);
        }
    }
    ui.add(egui::Label::new(theme::caption(ui, summary(&rehearsal, next))).wrap());
    if let Some(k) = add {
        let ctx = ui.ctx().clone();
        experiment::add_rehearsed(diagnosing, trainer, messages, jobs, &ctx, k);
    }
}

/// Draws one object: the simulated truth, and how often it was diagnosed. True if its recording should be added.
fn object(ui: &mut Ui, outcome: &Outcome) -> bool {
    let mut add = false;
    let rounds = outcome.rounds.len();
    compact(ui, |ui| {
        ui.label(RichText::new(format!("If it is {}", one(&outcome.id))).size(12.0));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if rounds > 0 {
                let link = ui.link(words::ADD);
                link.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::Link, true, format!("Add simulated {}", outcome.id))
                });
                add = link.on_hover_text(words::ADD_MORE).clicked();
                let text = format!("{} of {rounds} settled", outcome.settled());
                ui.label(theme::strong(text)).on_hover_text(came_out(outcome));
            }
        });
    });
    if let Some(problem) = &outcome.problem {
        remark(ui, Icon::Doubt, problem);
    }
    if rounds > 0 {
        let p = palette(ui);
        let color = if outcome.settled() == rounds { p.good } else { p.caution };
        bar(ui, outcome.settled() as f64, rounds as f64, None, color);
    }
    add
}

/// Diagnosed causes of every round, as lines.
fn came_out(outcome: &Outcome) -> String {
    let names = |ids: &[String]| listed(&ids.iter().map(|id| title(id)).collect::<Vec<_>>());
    let round = |(k, round): (usize, &crate::experiment::rehearse::Round)| {
        let named = if round.named.is_empty() { "nothing".to_owned() } else { names(&round.named) };
        let open = if round.open.is_empty() { String::new() } else { format!("; or {}", names(&round.open)) };
        format!("{}: {named}{open}", k + 1)
    };
    outcome.rounds.iter().enumerate().map(round).collect::<Vec<_>>().join("\n")
}

fn summary(rehearsal: &Rehearsal, next: &NextExperiment) -> String {
    let (settled, all) = rehearsal.settled();
    let expected = format::number(100.0 * next.expected_power, 0);
    format!("{settled} of {all} settled the question rightly; {expected}\u{a0}% were expected.")
}

/// Loads a recording of the real object.
fn load(ui: &mut Ui, session: &mut Session) {
    ui.add_space(space::XS);
    ui.label(theme::caption(ui, words::DID_IT));
    let ctx = ui.ctx().clone();
    ui.horizontal(|ui| {
        let width = (ui.available_width() - 44.0).max(60.0);
        let field = TextEdit::singleline(&mut session.experiments.path_field).hint_text(words::PATH);
        let response = ui.add(field.desired_width(width));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, words::RECORDING));
        let entered = response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if icon_button(ui, Icon::More, true, words::CHOOSE).on_hover_text(words::CHOOSE).clicked() {
            files::ask(&ctx, &mut session.jobs, dialogs::ADD_EXPERIMENT);
        }
        let path = session.experiments.path_field.trim().to_owned();
        if entered && !path.is_empty() {
            experiment::add_experiment(session, &ctx, &PathBuf::from(path));
        }
    });
}

/// Questions resolved by a later recording, and simulated recordings: above the causes.
pub fn settled(ui: &mut Ui, document: &Document, diagnosis: &Findings) {
    if !diagnosis.settled.is_empty() {
        plain_card(ui, words::SETTLED, |ui| {
            for settled in &diagnosis.settled {
                let text = format!("{}, not {}.", title(&settled.kept), small(&title(&settled.excluded)));
                ui.add(egui::Label::new(theme::strong(text)).wrap());
                ui.add(egui::Label::new(theme::caption(ui, sentence(&settled.why))).wrap());
            }
        });
    }
    let simulated = experiment::simulated(document);
    if !simulated.is_empty() {
        plain_card(ui, words::NOT_MEASURED, |ui| {
            let text = format!(
                "{} simulated: this answer shows what the experiment would settle, and says nothing more about the real object.",
                match simulated.as_slice() {
                    [one] => format!("“{one}” is"),
                    several => format!("{} recordings are", several.len()),
                }
            );
            remark(ui, Icon::Doubt, text);
        });
    }
}
