//! The fitted parameters: value ± standard error in readable units. Unidentifiable ones are greyed, with the reason.

use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::refits::{FIT, SIMULATE};
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::fit_choice::Stated;
use crate::ui::document::state::Document;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::tooltips;
use crate::ui::kit::widgets::{card, remark};
use crate::ui::session::Session;
use crate::ui::shell::panel::{COLUMN, Framing, Panel, Picture};
use egui::{Align, Layout, RichText, Ui};
use egui_extras::{Column, TableBody, TableBuilder};
use estimator::estimate::{Fit, Parameter};
use estimator::simulate::Simulation;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const PARAMETERS: &str = "Parameters";
    pub const FITTING: &str = "Fitting …";
    pub const FITTING_MORE: &str = "Segmenting the recording and estimating its parameters.";
    pub const NO_FIT: &str = "No fit";
    pub const NOTHING_MEASURED_YET: &str = "Nothing measured yet";
    pub const NOTHING_MEASURED_YET_MORE: &str = "Weights, sizes and frictions with their errors appear here.";
    pub const VALUE: &str = "Value";
    pub const UNIT: &str = "Unit";
    pub const NOT_SHOWN: &str = "not shown";
    pub const HOW_IT_WAS_FOUND: &str = "How it was found";
    pub const WHY_NO_VALUE: &str = "Why there is no value";
    pub const CLICK_TO_TRY: &str = "Click to try another value or to state one.";
    pub const REPLAYING_THE_MOTION: &str = "Replaying the motion through the fitted world …";
}

/// Height of a line, points.
const LINE: f32 = 21.0;

/// The parameter table.
pub static PARAMETERS: Picture = Picture {
    name: "parameters",
    place: 50,
    help: "The parameter table",
    line: "Parameters: values with errors, and how each was found",
    size: COLUMN,
    sample: Sample::Stack,
    session: stage::fitted,
    framing: Framing::Panel(|| Box::new(ParametersPanel)),
};

/// The parameter table.
#[derive(Default)]
pub struct ParametersPanel;

impl Panel for ParametersPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let busy = session.jobs.is_running(FIT);
        let analysis = session.calibration.analysis.clone();
        let task = analysis.as_ref().map(|a| format::object(a.task.name()));
        card(
            ui,
            words::PARAMETERS,
            |ui| {
                if busy {
                    ui.add(egui::Spinner::new().size(14.0));
                } else if let Some(task) = &task {
                    ui.label(theme::caption(ui, task));
                }
            },
            |ui| match &analysis {
                Some(analysis) => {
                    table(ui, &mut session.calibration, &analysis.fit);
                    quality(ui, &session.document, &session.calibration, &session.jobs, &analysis.fit);
                }
                None => nothing(ui, &session.calibration, busy),
            },
        );
    }
}

/// Explains why there is no table yet.
fn nothing(ui: &mut Ui, calibration: &Calibration, busy: bool) {
    let (title, text) = match (&calibration.fit_problem, busy) {
        (_, true) => (words::FITTING, words::FITTING_MORE),
        (Some(problem), _) => (words::NO_FIT, problem.as_str()),
        _ => (words::NOTHING_MEASURED_YET, words::NOTHING_MEASURED_YET_MORE),
    };
    ui.label(theme::strong(title));
    ui.label(theme::caption(ui, text));
}

fn table(ui: &mut Ui, calibration: &mut Calibration, fit: &Fit) {
    let mut objects: Vec<&str> = Vec::new();
    for parameter in &fit.parameters {
        if !objects.contains(&parameter.object.as_str()) {
            objects.push(&parameter.object);
        }
    }
    ui.spacing_mut().item_spacing.y = 0.0;
    let right = Layout::right_to_left(Align::Center);
    TableBuilder::new(ui)
        .id_salt("parameters")
        .vscroll(false)
        .sense(egui::Sense::click())
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::remainder().clip(true).at_least(96.0))
        .column(Column::exact(76.0))
        .column(Column::exact(58.0))
        .column(Column::exact(42.0))
        .header(16.0, |mut header| {
            header.col(|_| {});
            for text in [words::VALUE, "± 1 σ"] {
                header.col(|ui| {
                    ui.with_layout(right, |ui| ui.label(theme::caption(ui, text)));
                });
            }
            header.col(|ui| {
                ui.label(theme::caption(ui, words::UNIT));
            });
        })
        .body(|mut body| {
            for object in objects {
                heading(&mut body, object);
                for parameter in fit.parameters.iter().filter(|p| p.object == object) {
                    line(&mut body, calibration, parameter);
                }
            }
        });
}

fn heading(body: &mut TableBody<'_>, object: &str) {
    body.row(LINE + 5.0, |mut row| {
        row.col(|ui| {
            ui.with_layout(Layout::left_to_right(Align::Max), |ui| {
                ui.label(theme::strong(format::object(object)));
            });
        });
        for _ in 0..3 {
            row.col(|_| {});
        }
    });
}

fn line(body: &mut TableBody<'_>, calibration: &mut Calibration, parameter: &Parameter) {
    let full = parameter.full_name();
    let quantity = format::parameter(&parameter.name, parameter.value);
    let stated = is_stated(calibration, parameter);
    body.row(LINE, |mut row| {
        row.set_selected(calibration.selected_parameter.as_ref() == Some(&full));
        let name = quantity.label.clone();
        let shown = parameter.value.filter(|_| parameter.identified);
        row.col(|ui| {
            let p = palette(ui);
            let color = if shown.is_some() { p.secondary } else { p.faint };
            ui.add(egui::Label::new(RichText::new(name).color(color)).truncate());
            if let Some((icon, word)) = stated {
                icon.show(ui, icons::SMALL, p.accent);
                ui.label(RichText::new(word).size(10.5).color(p.accent));
            }
        });
        if let Some(value) = shown {
            let error = parameter.std_error.map(|e| e * quantity.factor);
            let (value, error) = format::with_error(value * quantity.factor, error);
            number(&mut row, &value, true);
            number(&mut row, &error.unwrap_or_default(), false);
            row.col(|ui| {
                ui.label(RichText::new(quantity.unit).size(12.0).color(palette(ui).secondary));
            });
        } else {
            row.col(|ui| {
                let text = RichText::new(words::NOT_SHOWN).size(12.0).italics().color(palette(ui).faint);
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    // Italics extend beyond their box.
                    ui.add_space(2.0);
                    ui.label(text);
                });
            });
            row.col(|_| {});
            row.col(|_| {});
        }
        let response = row.response();
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Row, true, &full));
        if response.clicked() {
            let again = calibration.selected_parameter.as_ref() == Some(&full);
            calibration.selected_parameter = (!again).then(|| full.clone());
        }
        response.on_hover_ui(|ui| explain(ui, parameter));
    });
}

fn number(row: &mut egui_extras::TableRow<'_, '_>, text: &str, strong: bool) {
    row.col(|ui| {
        let text = if strong { theme::strong(text) } else { RichText::new(text).color(palette(ui).secondary) };
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.label(text));
    });
}

/// Icon and word beside parameters with a user-defined prior, bound or value.
fn is_stated(calibration: &Calibration, parameter: &Parameter) -> Option<(Icon, &'static str)> {
    let (stated, name) = (&calibration.choice.stated, Stated::name_of(parameter));
    if stated.known.contains_key(&name) {
        Some((Icon::Lock, "frozen"))
    } else if stated.prior.contains_key(&name) {
        Some((Icon::Adjust, "prior"))
    } else {
        stated.bounds.contains_key(&name).then_some((Icon::Adjust, "bounded"))
    }
}

/// Tooltip: meaning, origin of the value, or the reason why there is none.
fn explain(ui: &mut Ui, parameter: &Parameter) {
    ui.set_max_width(320.0);
    if let Some(lesson) = tooltips::parameter(&parameter.name) {
        ui.label(lesson.what);
        if !lesson.formula.is_empty() {
            ui.label(RichText::new(lesson.formula).italics().color(palette(ui).secondary));
        }
        ui.add_space(space::XS);
    }
    ui.label(theme::strong(if parameter.identified { words::HOW_IT_WAS_FOUND } else { words::WHY_NO_VALUE }));
    ui.label(crate::text::sentence::sentence(&parameter.how));
    ui.label(theme::caption(ui, format!("{} · {} samples", parameter.name, parameter.samples)));
    ui.label(theme::caption(ui, words::CLICK_TO_TRY));
}

/// Draws how well the model reproduces the measurement.
fn quality(ui: &mut Ui, document: &Document, calibration: &Calibration, jobs: &Jobs<Session>, fit: &Fit) {
    ui.add_space(space::S);
    if let Some(quality) = &fit.quality {
        let text = format!(
            "The model leaves {} {} RMS of the force; {} on data it has not seen ({} %).",
            format::significant(quality.rms, 2),
            if quality.unit == "Nm" { "N·m" } else { &quality.unit },
            format::significant(quality.heldout_rms, 2),
            format::significant(100.0 * quality.heldout_relative, 2),
        );
        ui.label(theme::caption(ui, text));
    }
    if let Some(simulation) = calibration.replay(document.current).and_then(|r| r.simulation.as_ref()) {
        residual(ui, document, simulation);
    } else if jobs.is_running(SIMULATE) {
        ui.label(theme::caption(ui, words::REPLAYING_THE_MOTION));
    }
}

/// Share of the measured force above which the simulation counts as deviating.
const DEPARTS: f64 = 0.5;

/// Draws the force residual of the simulation in the fitted world.
fn residual(ui: &mut Ui, document: &Document, simulation: &Simulation) {
    let Some(prepared) = document.prepared() else { return };
    // Taken together: a channel that carries little force may be entirely wrong.
    let (mut worst, mut left, mut measured) = (0.0_f64, 0.0, 0.0);
    for (name, rms) in &simulation.residual_rms {
        measured += prepared.mean_square(name);
        left += rms * rms;
        worst = worst.max(*rms);
    }
    if worst <= 0.0 {
        return;
    }
    let unit = if simulation.predicted.iter().any(|c| c.unit == "Nm") { "N·m" } else { "N" };
    let number = format::significant(worst, 2);
    if left > DEPARTS * DEPARTS * measured {
        let text = format!(
            "The replay departs from the measured force by up to {number} {unit} RMS: this world does not hold all that was touched."
        );
        remark(ui, Icon::Doubt, text);
    } else {
        let text = format!("Measured minus simulated force: at most {number} {unit} RMS a channel.");
        ui.label(theme::caption(ui, text));
    }
}
