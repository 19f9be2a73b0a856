//! Deficits of the base model as curves: measured and modelled force, and the residual against each candidate variable.

use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::actions;
use crate::ui::diagnose::atlas_sheet::Sheet;
use crate::ui::diagnose::state::{Answer, DIAGNOSE, Diagnosing, StartFrom};
use crate::ui::document::files;
use crate::ui::document::state::Document;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{compact, empty_state, primary_button, segmented, sheet};
use crate::ui::plots::residual_plot::{cloud_plot, force_plot, has_directions, inks};
use crate::ui::plots::residuals::{Cloud, Residuals};
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::panel::{Framing, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{Align, Color32, ComboBox, Layout, RichText, Sense, Stroke, Ui, vec2};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const NOTHING_YET: &str = "Nothing to diagnose yet";
    pub const NOTHING_YET_MORE: &str = "Open a log, for example of a crank that was turned. What the simulation gets wrong \
        about it, why, and what mending it gains appear here.";
    pub const OPEN: &str = "Open a log …";
    pub const OPEN_KEYS: &str = "Ctrl+O";
    pub const RECORD_ONE: &str = "or record one in Train";
    pub const BUSY: &str = "Diagnosing …";
    pub const BUSY_MORE: &str = "The measured motion goes through the model; what is left of the force is compared with what \
        every known cause would leave there.";
    pub const CANCEL: &str = "Cancel";
    pub const CANNOT: &str = "This recording cannot be diagnosed";
    pub const OPEN_ANOTHER: &str = "Open another log …";
    pub const AGAIN: &str = "Try again";
    pub const NO_CURVES: &str = "No curves here";
    pub const NO_CURVES_MORE: &str =
        "This recording has no force along one coordinate to draw. The answer stands beside.";
    pub const ASK: &str = "What does the simulation get wrong?";
    pub const ASK_MORE: &str = "The model is compared with what was measured. What it gets wrong is named, with its size, what \
        mending it gains on data that took no part, and what else it could be.";
    pub const BEGIN: &str = "Diagnose";
    pub const INERTIA: &str = "Inertia";
    pub const INERTIA_MORE: &str = "Start from inertia alone: even friction must be found";
    pub const VISCOUS: &str = "+ viscous";
    pub const VISCOUS_MORE: &str = "Start from inertia and friction in proportion to speed";
    pub const DRY: &str = "+ dry";
    pub const DRY_MORE: &str = "Start from inertia, viscous and dry friction";
    pub const ATLAS_HEADING: &str = "Left over against every suspect";
    pub const ATLAS_MORE: &str = "Means of what the model leaves, over the variable of each suspect, and what the suspect \
        alone would take of it. The number is its evidence: twice the log of how much likelier it makes the force, less what \
        its parameters cost.";
    pub const NAMED: &str = "named";
    pub const SUSPECT_ALONE: &str = "suspect alone";
    pub const LEFT_OVER: &str = "left over";
    pub const TO_CURVES: &str = "Curves";
    pub const TO_ATLAS: &str = "Atlas";
    pub const SWITCH_MORE: &str = "Switches between the curves and what is left over against every suspect";
    pub const FORCE_HEADING: &str = "Force along the motion";
    pub const FREE_HEADING: &str = "Force that the free motion needs";
    pub const NOISE: &str = "± 2 σ of the noise";
    pub const WITH_FOUND: &str = "with what was found";
    pub const MODEL: &str = "model";
    pub const MEASURED: &str = "measured";
    pub const WAYS: &str = "— forwards  - - back";
    pub const WAYS_MORE: &str = "Means over small ranges, by the direction of motion; points: before";
    pub const WHICH: &str = "Recording of the curves";
}

/// Share of the height that the curve over time takes.
const TIME_SHARE: f32 = 0.36;
/// Width of the chooser of the three base models, points.
const CHOICES: f32 = 216.0;
/// Height of a plot's heading, points.
const HEAD: f32 = 20.0;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Diagnose, 0)],
    at_the_left: true,
    pictures: &[&ATLAS],
    ..Registration::new(PanelId::DIAGNOSE, "Measured and modelled", Icon::Panel, || Box::new(DiagnosePanel))
};

/// The residual atlas.
pub static ATLAS: Picture = Picture {
    name: "atlas",
    place: 180,
    help: "The residual atlas",
    line: "The residual atlas: what is left over against every suspect",
    size: [720, 540],
    sample: Sample::Askew,
    session: stage::atlas,
    framing: Framing::LargePanel(|| Box::new(DiagnosePanel)),
};

/// Panel of the diagnosis curves.
#[derive(Default)]
pub struct DiagnosePanel;

impl Panel for DiagnosePanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        sheet(ui).inner_margin(space::M).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            let answer = session.diagnosing.answer.clone();
            let of = session.document.current;
            let curves = answer.as_ref().and_then(|a| a.residuals.get(of).filter(|r| !r.is_empty()));
            let atlas = answer.as_ref().and_then(|a| Some((&**a, a.atlas.get(of).filter(|sheet| !sheet.is_empty())?)));
            match (curves, atlas) {
                (Some(curves), None) => draw(ui, &mut session.document, &mut session.diagnosing, curves, false),
                (Some(curves), Some(_)) if !session.diagnosing.shows_atlas => {
                    draw(ui, &mut session.document, &mut session.diagnosing, curves, true);
                }
                // Tasks without a single coordinate have no curves along it.
                (curves, Some((answer, sheet))) => {
                    suspects(ui, &mut session.document, &mut session.diagnosing, answer, sheet, curves.is_some());
                }
                (None, None) => nothing(ui, session),
            }
        });
    }
}

fn nothing(ui: &mut Ui, session: &mut Session) {
    if session.document.recordings.is_empty() {
        let text = words::NOTHING_YET_MORE;
        empty_state(ui, (Icon::Diagnose, words::NOTHING_YET), text, |ui| {
            if primary_button(ui, true, (Icon::Open, words::OPEN)).on_hover_text(words::OPEN_KEYS).clicked() {
                files::ask(ui.ctx(), &mut session.jobs, dialogs::OPEN_LOG);
            }
            if ui.link(words::RECORD_ONE).clicked() {
                session.workspace = Workspace::Train;
            }
        });
    } else if session.jobs.is_running(DIAGNOSE) {
        let text = words::BUSY_MORE;
        empty_state(ui, words::BUSY, text, |ui| {
            ui.add(egui::Spinner::new().size(20.0));
            ui.add_space(space::S);
            if ui.button((Icon::Close, words::CANCEL)).clicked() {
                session.give_up(ui.ctx(), DIAGNOSE);
            }
        });
    } else if let Some(problem) = session.diagnosing.problem.clone() {
        empty_state(ui, (Icon::Doubt, words::CANNOT), &problem, |ui| {
            if primary_button(ui, true, (Icon::Open, words::OPEN_ANOTHER)).on_hover_text(words::OPEN_KEYS).clicked() {
                files::ask(ui.ctx(), &mut session.jobs, dialogs::OPEN_LOG);
            }
            ui.add_space(space::XS);
            start_from(ui, &session.document, &session.calibration, &mut session.diagnosing);
            if ui.link(words::AGAIN).clicked() {
                let ctx = ui.ctx().clone();
                actions::diagnose(
                    &session.document,
                    &session.calibration,
                    &mut session.diagnosing,
                    &mut session.jobs,
                    &ctx,
                );
            }
        });
    } else if session.diagnosing.answer.is_some() {
        let text = words::NO_CURVES_MORE;
        empty_state(ui, (Icon::Curves, words::NO_CURVES), text, |_| {});
    } else {
        let text = words::ASK_MORE;
        empty_state(ui, (Icon::Diagnose, words::ASK), text, |ui| {
            begin(ui, &session.document, &session.calibration, &mut session.diagnosing, &mut session.jobs);
        });
    }
}

/// Draws the button, and the chooser of the base model where there is a choice.
fn begin(
    ui: &mut Ui,
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
) {
    start_from(ui, document, calibration, diagnosing);
    if primary_button(ui, true, (Icon::Diagnose, words::BEGIN)).clicked() {
        let ctx = ui.ctx().clone();
        actions::diagnose(document, calibration, diagnosing, jobs, &ctx);
    }
}

/// Draws the chooser of a mechanism's base model; true if the choice changed.
pub(crate) fn start_from(
    ui: &mut Ui,
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
) -> bool {
    let task = calibration.choice.task;
    let mechanism = document.prepared().is_some_and(|p| crate::ui::diagnose::state::is_mechanism(&p.recording, task));
    if !mechanism {
        return false;
    }
    let choices = [
        (StartFrom::Mass, words::INERTIA, words::INERTIA_MORE),
        (StartFrom::Viscous, words::VISCOUS, words::VISCOUS_MORE),
        (StartFrom::Coulomb, words::DRY, words::DRY_MORE),
    ];
    let changed = ui
        .scope(|ui| {
            ui.set_max_width(CHOICES);
            segmented(ui, &mut diagnosing.from, &choices)
        })
        .inner;
    ui.add_space(space::S);
    changed
}

/// Draws the atlas with its heading.
fn suspects(
    ui: &mut Ui,
    document: &mut Document,
    diagnosing: &mut Diagnosing,
    answer: &Answer,
    sheet: &Sheet,
    has_curves: bool,
) {
    ui.spacing_mut().item_spacing.y = space::XS;
    head(ui, words::ATLAS_HEADING, sheet.unit(), |ui| {
        let (p, inks) = (palette(ui), inks(ui));
        key(ui, inks.noise, 9.0, "± 2 σ");
        key(ui, p.good, 2.0, words::NAMED);
        key(ui, p.accent, 2.0, words::SUSPECT_ALONE);
        key(ui, inks.model, 2.0, words::LEFT_OVER);
        if has_curves {
            views(ui, diagnosing);
        }
        which(ui, document);
    });
    let text = words::ATLAS_MORE;
    ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
    ui.add_space(space::XS);
    crate::ui::diagnose::panels::atlas::show(ui, diagnosing, sheet, &answer.diagnosis);
}

/// Draws the switch between curves and atlas.
fn views(ui: &mut Ui, diagnosing: &mut Diagnosing) {
    let text = if diagnosing.shows_atlas { words::TO_CURVES } else { words::TO_ATLAS };
    let hint = words::SWITCH_MORE;
    if ui.link(text).on_hover_text(hint).clicked() {
        diagnosing.shows_atlas = !diagnosing.shows_atlas;
    }
    ui.add_space(space::S);
}

fn draw(ui: &mut Ui, document: &mut Document, diagnosing: &mut Diagnosing, curves: &Residuals, has_atlas: bool) {
    let height = ui.available_height();
    let gap = space::S;
    ui.spacing_mut().item_spacing.y = 0.0;
    let heading = if curves.is_free { words::FREE_HEADING } else { words::FORCE_HEADING };
    head(ui, heading, curves.unit, |ui| {
        let inks = inks(ui);
        key(ui, inks.noise, 9.0, words::NOISE);
        key(ui, inks.extended, 2.0, words::WITH_FOUND);
        key(ui, inks.model, 2.0, words::MODEL);
        key(ui, inks.measured, 2.0, words::MEASURED);
        if has_atlas {
            views(ui, diagnosing);
        }
        which(ui, document);
    });
    let upper = (TIME_SHARE * height).max(90.0);
    force_plot(ui, upper - HEAD, curves);
    ui.add_space(gap);
    let lines = curves.clouds.len().div_ceil(2).max(1);
    let each = ((height - upper - gap * lines as f32) / lines as f32 - HEAD).max(60.0);
    for (k, pair) in curves.clouds.chunks(2).enumerate() {
        if k > 0 {
            ui.add_space(gap);
        }
        ui.spacing_mut().item_spacing.x = space::L;
        ui.columns(pair.len(), |columns| {
            for (ui, cloud) in columns.iter_mut().zip(pair) {
                ui.spacing_mut().item_spacing.y = 0.0;
                residual(ui, each, cloud, curves);
            }
        });
    }
}

fn residual(ui: &mut Ui, height: f32, cloud: &Cloud, curves: &Residuals) {
    let units = format!("{} over {}", curves.unit, cloud.unit);
    head(ui, &format!("Left over against {}", cloud.title.to_lowercase()), &units, |ui| {
        if has_directions(cloud.suspect) && ui.available_width() > 90.0 {
            let note = RichText::new(words::WAYS).size(10.5).color(palette(ui).faint);
            ui.label(note).on_hover_text(words::WAYS_MORE);
        }
    });
    cloud_plot(ui, height, cloud, curves);
}

/// Draws the chooser of the shown recording, if there are several.
fn which(ui: &mut Ui, document: &mut Document) {
    if document.recordings.len() < 2 {
        return;
    }
    // As tall as the text beside it.
    ui.spacing_mut().button_padding = vec2(space::S, 0.0);
    let mut chosen = document.current;
    let name = |k: usize| document.recordings.get(k).map(|p| p.recording.name.clone()).unwrap_or_default();
    let list = ComboBox::from_id_salt("recording of the curves").selected_text(name(chosen)).width(120.0);
    let list = list.show_ui(ui, |ui| {
        for k in 0..document.recordings.len() {
            ui.selectable_value(&mut chosen, k, name(k));
        }
    });
    let label = || egui::WidgetInfo::labeled(egui::Role::ComboBox, true, words::WHICH);
    list.response.widget_info(label);
    if chosen != document.current {
        document.select(chosen);
    }
}

/// Draws a heading with its unit, and trailing content on the right.
fn head(ui: &mut Ui, title: &str, unit: &str, trailing: impl FnOnce(&mut Ui)) {
    compact(ui, |ui| {
        ui.set_min_height(HEAD);
        ui.label(theme::strong(title));
        ui.label(theme::caption(ui, unit));
        ui.with_layout(Layout::right_to_left(Align::Center), trailing);
    });
}

/// Draws a legend entry: a coloured line and its text.
fn key(ui: &mut Ui, color: Color32, width: f32, text: &str) {
    ui.spacing_mut().item_spacing.x = 6.0;
    ui.label(theme::caption(ui, text));
    let (rect, _) = ui.allocate_exact_size(vec2(14.0, 12.0), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(width, color));
    ui.add_space(space::S);
}
