//! The left column of the calibration: choice of the recording, its task, refit, save.

use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::fitting;
use crate::ui::calibrate::manual_states;
use crate::ui::calibrate::panels::part::{fitted_part, read_part};
use crate::ui::calibrate::refits::FIT;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::files;
use crate::ui::document::files::Dialog;
use crate::ui::document::fit_choice::Stated;
use crate::ui::document::opening;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{call, fact, icon_button, plain_card, primary_button};
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel::{Panel, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{ComboBox, DragValue, ScrollArea, TextEdit, Ui};
use estimator::segment::{Method, Thresholds};
use std::path::PathBuf;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const OPEN: &str = "Open …";
    pub const OPEN_MORE: &str = "Open a log (Ctrl+O)";
    pub const PATH: &str = "Path, then Enter";
    pub const MAP: &str = "Map columns …";
    pub const MAP_MORE: &str = "Say what the columns of this table mean; a sidecar remembers it";
    pub const DROP: &str = "Drop a log, a world or a sidecar anywhere on the window; its columns can be mapped.";
    pub const WHICH: &str = "Which recording";
    pub const FITTING: &str = "Fitting …";
    pub const CHANGED: &str = "settings changed";
    pub const FOLLOW_SLOW: &str = "Fits of these recordings take too long for that: press Refit";
    pub const FOLLOW_MORE: &str = "Every change is fitted at once; Ctrl+Z takes it back";
    pub const FOLLOW: &str = "Follow every change";
    pub const BY_HAND: &str = "States set by hand";
    pub const FIND_AGAIN: &str = "Find them again";
    pub const FORGET: &str = "Forget";
    pub const STATES_BY: &str = "States by";
    pub const RULES: &str = "Rules";
    pub const HMM: &str = "Hidden Markov model";
    pub const RULES_MORE: &str = "Thresholds above the noise, and the rules of the task";
    pub const HMM_MORE: &str = "Starts from the rules and learns from the recording; every sample has a probability";
    pub const THRESHOLDS: &str = "Thresholds by hand";
    pub const THRESHOLDS_MORE: &str = "Automatic thresholds lie above the noise of this recording.";
    pub const FORCE: &str = "Force ±";
    pub const VELOCITY: &str = "Velocity ±";
    pub const SAVE_LOG: &str = "Recording, with its sidecar";
    pub const SAVE_WORLD: &str = "Calibrated world";
    pub const SAVE_REPORT: &str = "Report of everything, one page";
    pub const WHERE_REPORT: &str = "Where the report goes";
    pub const WRITE_REPORT: &str = "Write report";
    pub const WHERE_WORLD: &str = "Where the world goes";
    pub const WRITE_WORLD: &str = "Save world";
    pub const WHERE_LOG: &str = "Where the recording goes";
    pub const WRITE_LOG: &str = "Save recording";
    pub const CHOOSE: &str = "Choose a place";
    pub const RECORDING: &str = "Recording";
    pub const FIT: &str = "Fit";
    pub const SAVE: &str = "Save";
    pub const NAME: &str = "Name";
    pub const LENGTH: &str = "Length";
    pub const NO_CLOCK: &str = "no clock";
    pub const SAMPLES: &str = "Samples";
    pub const RATE: &str = "Rate";
    pub const CHANNELS: &str = "Channels";
    pub const VELOCITIES: &str = "Velocities";
    pub const REFIT: &str = "Refit";
}

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Calibrate, 0)],
    at_the_left: true,
    ..Registration::new(PanelId::RECORDING, "Recording and fit", Icon::Fit, || Box::new(RecordingPanel::default()))
};

/// The recording panel.
#[derive(Default)]
pub struct RecordingPanel {
    log: String,
    world: String,
    report: String,
}

impl Panel for RecordingPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        ScrollArea::vertical().id_salt("recording").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            plain_card(ui, words::RECORDING, |ui| {
                source(ui, &mut session.document, &mut session.wanted_pane, &mut session.messages, &mut session.jobs);
            });
            if session.document.prepared().is_some() {
                plain_card(ui, words::FIT, |ui| {
                    fit(ui, &session.document, &mut session.calibration, &mut session.messages, &mut session.jobs);
                });
                plain_card(ui, words::SAVE, |ui| {
                    self.save(ui, &session.document, &session.calibration, &mut session.jobs);
                });
            }
        });
    }
}

fn source(
    ui: &mut Ui,
    document: &mut Document,
    wanted_pane: &mut Option<PanelId>,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
) {
    let ctx = ui.ctx().clone();
    let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    let response = ui.allocate_ui_with_layout(size, layout, |ui| {
        if icon_button(ui, Icon::Open, true, words::OPEN).on_hover_text(words::OPEN_MORE).clicked() {
            files::ask(&ctx, jobs, dialogs::OPEN_LOG);
        }
        let field = TextEdit::singleline(&mut document.path_field).hint_text(words::PATH);
        ui.add(field.desired_width(ui.available_width()))
    });
    let enter = response.inner.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
    ui.horizontal_wrapped(|ui| {
        let named = !document.path_field.trim().is_empty();
        if enter && named {
            let path = PathBuf::from(document.path_field.trim());
            opening::open_any(document, wanted_pane, messages, jobs, &ctx, &path);
        }
        let named = named || document.path.is_some();
        let hint = words::MAP_MORE;
        if ui.add_enabled(named, egui::Button::new((Icon::Columns, words::MAP))).on_hover_text(hint).clicked() {
            opening::map_columns(document, jobs, &ctx, None);
        }
    });
    let Some(prepared) = document.prepared().cloned() else {
        ui.label(theme::caption(ui, words::DROP));
        return;
    };
    ui.add_space(space::XS);
    let recording = &prepared.recording;
    if document.recordings.len() > 1 {
        choose_trial(ui, document);
    } else {
        fact(ui, words::NAME, recording.name.clone()).on_hover_text(whole_path(document));
    }
    fact(ui, words::LENGTH, recording.duration_s().map_or_else(|| words::NO_CLOCK.to_owned(), |d| format!("{d:.1} s")));
    fact(ui, words::SAMPLES, format::grouped(recording.len()));
    if let Some(rate) = prepared.rate_hz {
        fact(ui, words::RATE, format!("{} Hz", format::significant(rate, 3)));
    }
    fact(ui, words::CHANNELS, recording.channels.len().to_string());
    if let Some(from) = &prepared.velocity_from {
        fact(ui, words::VELOCITIES, from.split(' ').next().unwrap_or_default().to_owned());
    }
}

fn whole_path(document: &Document) -> String {
    document.path.as_ref().map(|path| path.display().to_string()).unwrap_or_default()
}

fn choose_trial(ui: &mut Ui, document: &mut Document) {
    let names: Vec<String> = document.recordings.iter().map(|p| p.recording.name.clone()).collect();
    let mut chosen = document.current;
    let list = ComboBox::from_id_salt("trial")
        .width(ui.available_width() - 2.0 * ui.spacing().button_padding.x)
        .selected_text(&names[chosen])
        .truncate()
        .show_ui(ui, |ui| {
            for (index, name) in names.iter().enumerate() {
                ui.selectable_value(&mut chosen, index, name);
            }
        });
    call(&list.response, words::WHICH);
    if chosen != document.current {
        document.select(chosen);
    }
}

fn fit(
    ui: &mut Ui,
    document: &Document,
    calibration: &mut Calibration,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
) {
    crate::ui::calibrate::panels::task_choice::task_choice(ui, document, calibration, messages);
    method(ui, calibration);
    thresholds(ui, document, calibration);
    fitted_part(ui, document, calibration);
    read_part(ui, document, calibration, jobs);
    by_hand(ui, document, calibration, jobs);
    let running = jobs.is_running(FIT);
    ui.add_space(space::XS);
    ui.horizontal(|ui| {
        let text = if calibration.analysis.is_some() { words::REFIT } else { words::FIT };
        if primary_button(ui, !running, (Icon::Fit, text)).clicked() {
            let ctx = ui.ctx().clone();
            fitting::refit(document, calibration, jobs, &ctx);
        }
        if running {
            ui.add(egui::Spinner::new().size(18.0));
            ui.label(theme::caption(ui, words::FITTING));
        } else if calibration.stale {
            ui.label(egui::RichText::new(words::CHANGED).size(11.5).color(palette(ui).caution));
        } else if let Some(took) = calibration.refits.took() {
            let text = format!("took {}", format::short_time(took.as_secs_f64()));
            ui.label(theme::caption(ui, text));
        }
    });
    let hint = if calibration.analysis.is_some() && !calibration.refits.quick() {
        words::FOLLOW_SLOW
    } else {
        words::FOLLOW_MORE
    };
    ui.checkbox(&mut calibration.refits.live, words::FOLLOW).on_hover_text(hint);
}

/// Draws the manually set states and parameter values, with a button to clear them.
fn by_hand(ui: &mut Ui, document: &Document, calibration: &mut Calibration, jobs: &mut Jobs<Session>) {
    if calibration.choice.segments.contains_key(&document.current) {
        ui.horizontal_wrapped(|ui| {
            ui.label(theme::caption(ui, words::BY_HAND));
            if ui.link(words::FIND_AGAIN).clicked() {
                let ctx = ui.ctx().clone();
                manual_states::forget_states(document, calibration, jobs, &ctx);
            }
        });
    }
    let stated = calibration.choice.stated.len();
    if stated > 0 {
        ui.horizontal_wrapped(|ui| {
            let s = if stated == 1 { "" } else { "s" };
            ui.label(theme::caption(ui, format!("{stated} statement{s} about parameters")));
            if ui.link(words::FORGET).clicked() {
                calibration.choice.stated = Stated::default();
            }
        });
    }
}

fn method(ui: &mut Ui, calibration: &mut Calibration) {
    ui.horizontal(|ui| {
        ui.label(theme::caption(ui, words::STATES_BY));
        let name = |method: Method| match method {
            Method::Threshold => words::RULES,
            Method::Hmm => words::HMM,
        };
        let choice = &mut calibration.choice.method;
        let list = ComboBox::from_id_salt("method")
            .width(ui.available_width() - 2.0 * ui.spacing().button_padding.x)
            .selected_text(name(*choice))
            .truncate()
            .show_ui(ui, |ui| {
                ui.selectable_value(choice, Method::Threshold, name(Method::Threshold))
                    .on_hover_text(words::RULES_MORE);
                ui.selectable_value(choice, Method::Hmm, name(Method::Hmm)).on_hover_text(words::HMM_MORE);
            });
        call(&list.response, words::STATES_BY);
    });
}

fn thresholds(ui: &mut Ui, document: &Document, calibration: &mut Calibration) {
    let used = calibration.segmentation(document.current).map(|s| s.thresholds);
    let default = used.unwrap_or(Thresholds { velocity_m_s: 0.05, force_n: 0.05 });
    let mut given = calibration.choice.thresholds.is_some();
    let response = ui.checkbox(&mut given, words::THRESHOLDS);
    response.on_hover_text(words::THRESHOLDS_MORE);
    calibration.choice.thresholds = given.then(|| calibration.choice.thresholds.unwrap_or(default));
    if let Some(thresholds) = &mut calibration.choice.thresholds {
        ui.horizontal(|ui| {
            ui.label(theme::caption(ui, words::FORCE));
            ui.add(
                DragValue::new(&mut thresholds.force_n).range(0.001..=10.0).speed(0.002).suffix(" N").max_decimals(3),
            );
        });
        ui.horizontal(|ui| {
            ui.label(theme::caption(ui, words::VELOCITY));
            let mut shown = thresholds.velocity_m_s * 1e3;
            ui.add(DragValue::new(&mut shown).range(0.1..=5_000.0).speed(0.5).suffix(" mm/s").max_decimals(1));
            thresholds.velocity_m_s = shown * 1e-3;
        });
    } else if let Some(used) = used.filter(|used| used.velocity_m_s > 0.0) {
        let mut parts = Vec::new();
        if used.force_n > 0.0 {
            parts.push(format!("± {} N", format::number(used.force_n, 3)));
        }
        parts.push(format!("± {} mm/s", format::number(used.velocity_m_s * 1e3, 1)));
        ui.label(theme::caption(ui, format!("Automatic: {}", parts.join(", "))));
    }
}

impl RecordingPanel {
    fn save(&mut self, ui: &mut Ui, document: &Document, calibration: &Calibration, jobs: &mut Jobs<Session>) {
        if self.log.is_empty() {
            "recording.csv".clone_into(&mut self.log);
            "world.json".clone_into(&mut self.world);
            "report.html".clone_into(&mut self.report);
        }
        ui.label(theme::caption(ui, words::SAVE_LOG));
        if save_line(ui, jobs, &mut self.log, (dialogs::SAVE_LOG, words::WHERE_LOG, words::WRITE_LOG), true) {
            files::save_log(ui.ctx(), document, calibration, jobs, &self.log);
        }
        ui.label(theme::caption(ui, words::SAVE_WORLD));
        let fitted = calibration.analysis.is_some();
        if save_line(ui, jobs, &mut self.world, (dialogs::SAVE_WORLD, words::WHERE_WORLD, words::WRITE_WORLD), fitted) {
            files::save_world(ui.ctx(), calibration, jobs, &self.world);
        }
        ui.label(theme::caption(ui, words::SAVE_REPORT));
        let is_file = !document.sources.is_empty();
        if save_line(
            ui,
            jobs,
            &mut self.report,
            (dialogs::SAVE_REPORT, words::WHERE_REPORT, words::WRITE_REPORT),
            is_file,
        ) {
            files::save_report(ui.ctx(), document, calibration, jobs, PathBuf::from(self.report.trim()));
        }
    }
}

/// Draws a path field with `…` and `Save`; true if it should be saved there.
fn save_line(
    ui: &mut Ui,
    jobs: &mut Jobs<Session>,
    field: &mut String,
    (dialog, place, does): (Dialog, &str, &str),
    enabled: bool,
) -> bool {
    ui.add_enabled_ui(enabled, |ui| {
        let size = egui::vec2(ui.available_width(), ui.spacing().interact_size.y);
        ui.allocate_ui_with_layout(size, egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let save = icon_button(ui, Icon::Save, enabled, does).on_hover_text(does);
            if icon_button(ui, Icon::More, enabled, words::CHOOSE).on_hover_text(words::CHOOSE).clicked() {
                files::ask(ui.ctx(), jobs, dialog);
            }
            let edit = ui.add(TextEdit::singleline(field).desired_width(ui.available_width()));
            edit.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, enabled, place));
            save.clicked()
        })
        .inner
    })
    .inner
}
