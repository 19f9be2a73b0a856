//! *False alarms here*: how often a diagnosis of replays without any cause names one.

use crate::text::diagnosis_words::{listed, title};
use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::replays;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::widgets::{plain_card, remark};
use crate::ui::session::Session;
use egui::Ui;
use estimator::diagnose::{Findings, Twins};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const FALSE_ALARMS: &str = "False alarms here";
    pub const FALSE_ALARMS_MORE: &str = "Replays have the recorded motion and no cause. Their structured errors and their \
        noise are as large as in these recordings. A cause that is certain in a replay is a false alarm.";
    pub const COUNT: &str = "Diagnose 20 replays";
    pub const NONE: &str = "None";
    pub const IS_ONE: &str = "is a false alarm";
    pub const ARE_SOME: &str = "are false alarms";
}

/// Card below the causes, if one is certain.
pub fn card(
    ui: &mut Ui,
    document: &Document,
    calibration: &Calibration,
    diagnosing: &Diagnosing,
    jobs: &mut Jobs<Session>,
    diagnosis: &Findings,
) {
    if diagnosis.certain().is_empty() {
        return;
    }
    plain_card(ui, words::FALSE_ALARMS, |ui| {
        ui.add(egui::Label::new(theme::caption(ui, words::FALSE_ALARMS_MORE)).wrap());
        match &diagnosing.twins {
            Some(Ok(twins)) => {
                ui.add(egui::Label::new(theme::strong(counted(twins))).wrap());
                ui.add(egui::Label::new(theme::caption(ui, interval(twins))).wrap());
            }
            Some(Err(problem)) => drop(remark(ui, Icon::Doubt, problem)),
            None => ask(ui, document, calibration, diagnosing, jobs),
        }
    });
}

fn ask(ui: &mut Ui, document: &Document, calibration: &Calibration, diagnosing: &Diagnosing, jobs: &mut Jobs<Session>) {
    let is_busy = jobs.is_running(replays::REPLAY);
    ui.horizontal(|ui| {
        if ui.add_enabled(!is_busy, egui::Button::new(words::COUNT)).clicked() {
            let ctx = ui.ctx().clone();
            replays::count(document, calibration, diagnosing, jobs, &ctx);
        }
        if is_busy {
            ui.add(egui::Spinner::new().size(16.0));
        }
    });
}

fn counted(twins: &Twins) -> String {
    let names: Vec<String> = twins.by_cause.iter().map(|named| title(&named.id)).collect();
    let which = if names.is_empty() { String::new() } else { format!(": {}", listed(&names)) };
    let number = if twins.named == 0 { words::NONE.to_owned() } else { twins.named.to_string() };
    let are = if twins.named > 1 { words::ARE_SOME } else { words::IS_ONE };
    format!("{number} of {} replays {are}{which}.", twins.runs)
}

fn interval(twins: &Twins) -> String {
    let [low, high] = twins.interval.map(|share| format::number(100.0 * share, 0));
    format!("Their share is {low} to {high}\u{a0}% (95\u{a0}% confidence interval).")
}
