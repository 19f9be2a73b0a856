//! All results: parameters, constraints, warnings, and the actions on them.

use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::panels::parameters;
use crate::ui::calibrate::panels::parameters::ParametersPanel;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::actions;
use crate::ui::document::correction;
use crate::ui::document::state::Document;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{card, plain_card, primary_button, remark};
use crate::ui::plots::data_warnings::places;
use crate::ui::session::Session;
use crate::ui::shell::panel::{COLUMN, Framing, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::lessons::practising;
use crate::ui::train::state::Training;
use egui::{RichText, ScrollArea, Ui};
use egui_tiles::ContainerKind;
use estimator::estimate::{Constraint, ConstraintKind};
use haptics::recording::Suggested;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const CONSTRAINTS: &str = "Constraints";
    pub const TURNS_ABOUT_A_CENTRE: &str = "Turns about a centre";
    pub const SLIDES_ALONG_A_LINE: &str = "Slides along a line";
    pub const MOVES_FREELY: &str = "Moves freely";
    pub const MEMBRANE: &str = "Membrane";
    pub const HOLDS_ONE_WAY_ONLY: &str = "Holds one way only";
    pub const FOLLOWS_A_PATH: &str = "Follows a path that is neither line nor circle";
    pub const TURNS_AND_SLIDES: &str = "Turns and slides along its axis";
    pub const UNDECIDED: &str = "Undecided";
    pub const AS_RIGID_AS_HAND: &str = "As rigid as hand and sensors can tell";
    pub const GIVES_WAY_MEASURABLY: &str = "Gives way measurably";
    pub const WARNINGS: &str = "Warnings";
    pub const CORRECT: &str = "Correct it in the sidecar";
    pub const NOTHING_DOUBTFUL_WAS_FOUND: &str = "Nothing doubtful was found.";
    pub const WHAT_IT_GETS_WRONG: &str = "What it gets wrong";
    pub const WHAT_IT_GETS_WRONG_MORE: &str =
        "A diagnosis names what the model misses, and measures what mending it gains.";
    pub const DIAGNOSE: &str = "Diagnose …";
    pub const CTRL_3: &str = "Ctrl+3";
    pub const CALIBRATED_WORLD: &str = "Calibrated world";
    pub const CALIBRATED_WORLD_MORE: &str = "The virtual objects now have the measured properties.";
    pub const TRAIN_IN_THIS_WORLD: &str = "Train in this world";
    pub const PRACTISE_ON_THIS_MORE: &str =
        "A lesson in this world: shown, practised and tested, with experts of its own";
    pub const PRACTISE_ON_THIS: &str = "Practise on this";
}

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Calibrate, 3), (Workspace::Diagnose, 5)],
    neighbours: &[(PanelId::DIAGNOSIS, ContainerKind::Tabs, false)],
    pictures: &[&parameters::PARAMETERS, &RESULTS],
    ..Registration::new(PanelId::RESULTS, "Results", Icon::Panel, || Box::new(ResultsPanel::default()))
};

/// Parameters, constraints and warnings.
pub static RESULTS: Picture = Picture {
    name: "results",
    place: 60,
    help: "Parameters, constraints and warnings",
    line: "Results: constraints, warnings, what is still missing",
    size: COLUMN,
    sample: Sample::Crank,
    session: stage::fitted,
    framing: Framing::Panel(|| Box::new(ResultsPanel::default())),
};

/// The right column of the calibration.
#[derive(Default)]
pub struct ResultsPanel {
    parameters: ParametersPanel,
}

impl Panel for ResultsPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        ScrollArea::vertical().id_salt("results").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            self.parameters.ui(ui, session);
            crate::ui::calibrate::panels::parameter_editor::selected(ui, &mut session.calibration);
            crate::ui::calibrate::panels::measured::of_recording(ui, &session.calibration);
            constraints(ui, &session.calibration);
            warnings(ui, &mut session.document, &session.calibration, &mut session.jobs);
            train_with_it(ui, &mut session.workspace, &session.calibration, &mut session.training, &mut session.jobs);
            diagnose(ui, session);
        });
    }
}

fn constraints(ui: &mut Ui, calibration: &Calibration) {
    let Some(analysis) = calibration.analysis.as_ref().filter(|a| !a.fit.constraints.is_empty()) else {
        return;
    };
    plain_card(ui, words::CONSTRAINTS, |ui| {
        for (index, constraint) in analysis.fit.constraints.iter().enumerate() {
            if index > 0 {
                ui.separator();
            }
            let name = if analysis.fit.constraints.len() > 1 { constraint.recording.as_deref() } else { None };
            ui.horizontal(|ui| {
                ui.label(theme::strong(heading(constraint)));
                ui.add(egui::Label::new(theme::caption(ui, name.unwrap_or_default())).truncate());
            });
            for fact in facts(constraint) {
                ui.label(fact);
            }
            ui.label(theme::caption(ui, sentence(&constraint.evidence)));
        }
    });
}

/// Kind of the constraint, with its object if there are several.
fn heading(constraint: &Constraint) -> String {
    let kind = kind(constraint.kind);
    constraint.object.as_deref().map_or(kind.to_owned(), |object| {
        let mut letters = kind.chars();
        let lower: String = letters.next().into_iter().flat_map(char::to_lowercase).chain(letters).collect();
        format!("{}: {lower}", format::object(object))
    })
}

fn kind(kind: ConstraintKind) -> &'static str {
    match kind {
        ConstraintKind::Revolute => words::TURNS_ABOUT_A_CENTRE,
        ConstraintKind::Prismatic => words::SLIDES_ALONG_A_LINE,
        ConstraintKind::Free => words::MOVES_FREELY,
        ConstraintKind::Membrane => words::MEMBRANE,
        ConstraintKind::Unilateral => words::HOLDS_ONE_WAY_ONLY,
        ConstraintKind::Spline => words::FOLLOWS_A_PATH,
        ConstraintKind::Screw => words::TURNS_AND_SLIDES,
        ConstraintKind::Undecided => words::UNDECIDED,
    }
}

/// Values of a constraint as short lines.
fn facts(constraint: &Constraint) -> Vec<String> {
    let mut facts = Vec::new();
    let millimetres = |value: f64, error: Option<&f64>| {
        let (value, error) = format::with_error(value * 1e3, error.map(|e| e * 1e3));
        error.map_or_else(|| format!("{value} mm"), |e| format!("{value} ± {e} mm"))
    };
    if let Some(radius) = constraint.radius_m {
        facts.push(format!("Radius {}", millimetres(radius, constraint.std_error.get("radius_m"))));
    }
    if let Some(center) = &constraint.center_m {
        let at: Vec<String> = center.iter().map(|v| format::number(v * 1e3, 2)).collect();
        let error = constraint.std_error.get("center_m").map(|e| format!(" ± {}", format::significant(e * 1e3, 2)));
        facts.push(format!("Centre ({}){} mm", at.join(", "), error.unwrap_or_default()));
    }
    if constraint.kind == ConstraintKind::Prismatic
        && let Some(direction) = &constraint.direction
    {
        let along: Vec<String> = direction.iter().map(|v| format::number(*v, 3)).collect();
        facts.push(format!("Direction ({})", along.join(", ")));
    }
    if let Some(turned) = constraint.coverage_rad {
        facts.push(format!("Turned {}° in all", format::number(turned.to_degrees(), 0)));
    }
    if let Some(covered) = constraint.coverage_m {
        facts.push(format!("Path of {} mm", format::number(covered * 1e3, 1)));
    }
    if let Some(force) = constraint.constraint_force_n {
        facts.push(format!("Mean constraint force {} N outwards", format::number(force, 3)));
    }
    match constraint.rigid {
        Some(true) => facts.push(words::AS_RIGID_AS_HAND.to_owned()),
        Some(false) => facts.push(words::GIVES_WAY_MEASURABLY.to_owned()),
        None => {}
    }
    facts.extend(crate::text::constraint_words::constraint_words(constraint).iter().map(|w| sentence(w)));
    facts
}

/// A warning: its text, its intervals, and entries of the sidecar that settle it.
type Remark = (String, Vec<(f64, f64)>, Option<Suggested>);

fn warnings(ui: &mut Ui, document: &mut Document, calibration: &Calibration, jobs: &mut Jobs<Session>) {
    let Some(prepared) = document.prepared().cloned() else { return };
    let mut texts: Vec<Remark> = Vec::new();
    for warning in &prepared.recording.warnings {
        texts.push((sentence(&warning.text), places(&prepared, warning), warning.suggested.clone()));
    }
    let analysis = calibration.analysis.clone();
    let fitted = analysis.iter().flat_map(|a| a.fit.warnings.iter());
    let segmented = calibration.segmentation(document.current).into_iter().flat_map(|s| s.warnings.iter());
    for text in fitted.chain(segmented).map(|w| sentence(w)) {
        if !texts.iter().any(|(t, ..)| *t == text) {
            texts.push((text, Vec::new(), None));
        }
    }
    let count = texts.len();
    let count = |ui: &mut Ui| {
        ui.label(RichText::new(count.to_string()).color(if count > 0 {
            palette(ui).caution
        } else {
            palette(ui).good
        }));
    };
    let mut jump = None;
    card(ui, words::WARNINGS, count, |ui| {
        if texts.is_empty() {
            ui.label(theme::caption(ui, words::NOTHING_DOUBTFUL_WAS_FOUND));
        }
        for (text, places, suggested) in texts {
            ui.scope(|ui| {
                ui.spacing_mut().item_spacing.y = 2.0;
                remark(ui, Icon::Doubt, text);
                if let Some(entries) = suggested.filter(|_| document.path.is_some()) {
                    corrected(ui, document, jobs, &entries);
                } else {
                    jump = jump.or(go_there(ui, &places, document.cursor_s, prepared.clockless()));
                }
            });
        }
    });
    if let Some((from, to)) = jump {
        document.look_at(from, to);
    }
}

/// Draws a link that puts suggested entries into the sidecar.
fn corrected(ui: &mut Ui, document: &Document, jobs: &mut Jobs<Session>, entries: &Suggested) {
    ui.horizontal(|ui| {
        ui.add_space(icons::SMALL + 6.0 - ui.spacing().item_spacing.x);
        let shown = serde_json::Value::Object(entries.clone()).to_string();
        if ui.link(RichText::new(words::CORRECT).size(11.5)).on_hover_text(shown).clicked() {
            correction::correct(document, jobs, &ui.ctx().clone(), entries);
        }
    });
}

/// Draws a link to the next of several intervals. Returns the requested one.
fn go_there(ui: &mut Ui, places: &[(f64, f64)], cursor_s: f64, clockless: bool) -> Option<(f64, f64)> {
    let next = places.iter().position(|(from, _)| *from > cursor_s + 1e-9).unwrap_or(0);
    let place = places.get(next)?;
    let at = if clockless { format!("sample {:.0}", place.0) } else { format!("{} s", format::number(place.0, 2)) };
    let text = match places.len() {
        1 => format!("Go to {at}"),
        n => format!("Go to {at} ({} of {n})", next + 1),
    };
    ui.horizontal(|ui| {
        // Below the text of the remark.
        ui.add_space(icons::SMALL + 6.0 - ui.spacing().item_spacing.x);
        ui.link(RichText::new(text).size(11.5)).clicked().then_some(*place)
    })
    .inner
}

fn diagnose(ui: &mut Ui, session: &mut Session) {
    if session.calibration.analysis.is_none() {
        return;
    }
    plain_card(ui, words::WHAT_IT_GETS_WRONG, |ui| {
        ui.label(theme::caption(ui, words::WHAT_IT_GETS_WRONG_MORE));
        ui.add_space(space::XS);
        if ui.button((Icon::Diagnose, words::DIAGNOSE)).on_hover_text(words::CTRL_3).clicked() {
            session.workspace = Workspace::Diagnose;
            if session.diagnosing.answer.is_none() && session.diagnosing.problem.is_none() {
                let ctx = ui.ctx().clone();
                actions::diagnose(
                    &session.document,
                    &session.calibration,
                    &mut session.diagnosing,
                    &mut session.jobs,
                    &ctx,
                );
            }
        }
    });
}

fn train_with_it(
    ui: &mut Ui,
    workspace: &mut Workspace,
    calibration: &Calibration,
    training: &mut Training,
    jobs: &mut Jobs<Session>,
) {
    let Some(analysis) = calibration.analysis.clone() else { return };
    if analysis.world.blocks.is_empty() && analysis.world.crank.is_none() {
        return;
    }
    plain_card(ui, words::CALIBRATED_WORLD, |ui| {
        ui.label(theme::caption(ui, words::CALIBRATED_WORLD_MORE));
        ui.add_space(space::XS);
        ui.horizontal(|ui| {
            if primary_button(ui, true, (Icon::Touch, words::TRAIN_IN_THIS_WORLD)).clicked() {
                training.train_calibrated = true;
                *workspace = Workspace::Train;
            }
            let hint = words::PRACTISE_ON_THIS_MORE;
            if ui.button((Icon::Lesson, words::PRACTISE_ON_THIS)).on_hover_text(hint).clicked() {
                let ctx = ui.ctx().clone();
                practising::practise_on_this(calibration, jobs, &ctx);
            }
        });
    });
}
