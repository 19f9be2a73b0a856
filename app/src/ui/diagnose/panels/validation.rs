//! *Check on other recordings*: the diagnosed causes on held-out recordings.

use crate::text::diagnosis_words::{listed, shown_unit, title};
use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::checked::{Checked, Holds, On, holds};
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::diagnose::validation;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{Palette, palette, space};
use crate::ui::kit::widgets::{bar, compact, icon_button, plain_card, remark};
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use egui::{Align, Color32, Layout, RichText, TextEdit, Ui};
use estimator::diagnose::{Findings, Validation};
use std::path::PathBuf;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const CHECK_ON_OTHER_RECORDINGS: &str = "Check on other recordings";
    pub const CHECK_ON_OTHER_RECORDINGS_MORE: &str =
        "What was found is put to recordings of the same object that took no part; nothing is fitted to them.";
    pub const PATH_OF_A_LOG: &str = "Path, then Enter";
    pub const RECORDING_TO_CHECK_ON: &str = "Recording to check on";
    pub const CHOOSE_FILES: &str = "Choose files";
    pub const CHOOSE_FILES_MORE: &str = "Choose one or several files";
    pub const LEAVE_ONE_OUT: &str = "Leave an open one out …";
    pub const LEAVE_ONE_OUT_MORE: &str =
        "The others are diagnosed without it, and it is checked whether their answer holds for it";
    pub const SHARE_MORE: &str = "Share of the left-over power that goes, with its 95 % interval from a bootstrap \
        over pieces of the recording";
    pub const HOLDS: &str = "It holds here, too.";
    pub const CANNOT_BE_TOLD: &str = "Whether it holds here cannot be told.";
    pub const DOES_NOT_HOLD: &str = "It does not hold here: the model alone does better.";
}

/// Card below the causes, if there is a recording to validate on.
pub fn card(
    ui: &mut Ui,
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
    diagnosis: &Findings,
) {
    if diagnosis.causes.is_empty() {
        return;
    }
    plain_card(ui, words::CHECK_ON_OTHER_RECORDINGS, |ui| {
        let text = words::CHECK_ON_OTHER_RECORDINGS_MORE;
        ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
        ask(ui, document, calibration, diagnosing, jobs);
        left_out(ui, document, calibration, diagnosing, jobs);
        for checked in &diagnosing.checked {
            ui.separator();
            result(ui, checked);
        }
    });
}

fn ask(
    ui: &mut Ui,
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
) {
    let ctx = ui.ctx().clone();
    ui.horizontal(|ui| {
        let busy = jobs.is_running(validation::CHECK);
        let width = (ui.available_width() - if busy { 68.0 } else { 44.0 }).max(60.0);
        let field = TextEdit::singleline(&mut diagnosing.check_field).hint_text(words::PATH_OF_A_LOG);
        let response = ui.add(field.desired_width(width));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, words::RECORDING_TO_CHECK_ON));
        let entered = response.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if icon_button(ui, Icon::More, true, words::CHOOSE_FILES).on_hover_text(words::CHOOSE_FILES_MORE).clicked() {
            dialogs::ask_for_recordings_to_check(&ctx, jobs);
        }
        if busy {
            ui.add(egui::Spinner::new().size(16.0));
        }
        let path = diagnosing.check_field.trim().to_owned();
        if entered && !path.is_empty() {
            validation::check(document, calibration, diagnosing, jobs, &ctx, On::Files(vec![PathBuf::from(path)]));
        }
    });
}

/// Leave-one-out validation: each of several open recordings can be checked with the causes from the others.
fn left_out(
    ui: &mut Ui,
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
) {
    if document.recordings.len() < 2 {
        return;
    }
    let names: Vec<String> = document.recordings.iter().map(|p| p.recording.name.clone()).collect();
    let mut chosen = None;
    ui.menu_button(words::LEAVE_ONE_OUT, |ui| {
        for (k, name) in names.iter().enumerate() {
            if ui.button(name).clicked() {
                chosen = Some(k);
            }
        }
    })
    .response
    .on_hover_text(words::LEAVE_ONE_OUT_MORE);
    if let Some(k) = chosen {
        let ctx = ui.ctx().clone();
        validation::check(document, calibration, diagnosing, jobs, &ctx, On::LeftOut(k));
    }
}

fn result(ui: &mut Ui, checked: &Checked) {
    match &checked.found {
        Err(problem) => {
            ui.add(egui::Label::new(theme::strong(&checked.name)).truncate());
            remark(ui, Icon::Doubt, problem);
        }
        Ok(validation) => figures(ui, checked, validation),
    }
}

fn figures(ui: &mut Ui, checked: &Checked, validation: &Validation) {
    let (p, verdict) = (palette(ui), holds(validation));
    compact(ui, |ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let rms = |value: f64| format::significant(value, 2);
            let unit = shown_unit(&checked.unit);
            let text = format!("{} → {} {unit} RMS", rms(validation.rms_before), rms(validation.rms_after));
            ui.label(RichText::new(text).size(12.0));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(egui::Label::new(theme::strong(&checked.name)).truncate());
            });
        });
    });
    bar(ui, validation.share.max(0.0), 1.0, None, color(p, verdict));
    let percent = |share: f64| format::number(100.0 * share, 0);
    let (share, [low, high]) = (validation.share, validation.interval);
    let text = if share >= 0.0 {
        format!("{} % [{}, {}] of the power that the model leaves goes.", percent(share), percent(low), percent(high))
    } else {
        format!("The power that is left grows by {} % [{}, {}].", percent(-share), percent(-high), percent(-low))
    };
    ui.add(egui::Label::new(theme::caption(ui, text)).wrap()).on_hover_text(words::SHARE_MORE);
    ui.add(egui::Label::new(RichText::new(words(verdict)).size(12.0).color(color(p, verdict))).wrap());
    if !validation.left_out.is_empty() {
        let names: Vec<String> = validation.left_out.iter().map(|id| title(id)).collect();
        ui.add(
            egui::Label::new(theme::caption(
                ui,
                format!("Left out, because it cannot be had here: {}.", listed(&names)),
            ))
            .wrap(),
        );
    }
    ui.add_space(space::XS);
}

fn color(p: &Palette, verdict: Holds) -> Color32 {
    match verdict {
        Holds::Yes => p.good,
        Holds::Unclear => p.caution,
        Holds::No => p.danger,
    }
}

fn words(verdict: Holds) -> &'static str {
    match verdict {
        Holds::Yes => words::HOLDS,
        Holds::Unclear => words::CANNOT_BE_TOLD,
        Holds::No => words::DOES_NOT_HOLD,
    }
}
