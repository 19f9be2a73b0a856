//! The editor of a task's rules: its states, their conditions, the parameters that they identify, and the subtasks that
//! they form. A change is applied at once to the recording below.

use crate::ui::calibrate::panels::rules_table::{states, subtasks};
use crate::ui::calibrate::rule_editing;
use crate::ui::calibrate::rules::Rules;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::space;
use crate::ui::kit::widgets::{card_with_head, primary_button, remark};
use crate::ui::session::Session;
use crate::ui::shell::panel::Panel;
use egui::{DragValue, ScrollArea, TextEdit, Ui};
use estimator::segment::definition::Definition;
use haptics::recording::Task;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const ADD_A_STATE: &str = "Add a state";
    pub const CLOSE: &str = "Close";
    pub const CLOSE_MORE: &str = "The rules stay as they are for this recording";
    pub const RESET: &str = "Reset";
    pub const RESET_MORE: &str = "Back to the rules as they were";
    pub const BUILT_IN: &str = "built in";
    pub const A_NEEDLES_PHASES: &str = "A needle's phases are told from its strokes; no threshold is needed.";
    pub const WITHOUT_THE_TICK: &str = "Without the tick it is learned above the noise of every recording";
    pub const FORCE: &str = "Force ±";
    pub const VELOCITY: &str = "Velocity ±";
    pub const ZERO_AGAIN_BELOW: &str = "zero again below";
    pub const HYSTERESIS_MORE: &str = "Hysteresis: a signal counts as 0 again below this share of its threshold";
    pub const NAME_OF_YOUR_TASK: &str = "Name of your task";
    pub const SAVE_AS_MY_TASK: &str = "Save as my task";
    pub const FIRST_RULE_COUNTS: &str = "The first rule that holds names the state.";
    pub const SIGNS_MORE: &str = "+ above, 0 within, − below. The first that holds counts.";
    pub const CHANGED_THE_STATES: &str = "Changed; the states below follow. Refit for new numbers.";
}

/// Height of the part below the tables, points: thresholds, name, and problems.
const FOOT: f32 = 94.0;

/// Panel of the rules editor.
#[derive(Default)]
pub struct RulesPanel;

/// Request of the head's buttons.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Asked {
    Nothing,
    Close,
    Reset,
    Add,
}

impl Panel for RulesPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        rule_editing::follow(ui.ctx(), &session.document, &mut session.calibration, &mut session.jobs);
        let Some(mut open) = session.calibration.rules.take() else { return };
        let (seen, before) = (open.draft.clone(), open.before.clone());
        let mut asked = Asked::Nothing;
        let heading = format!("Rules of the task “{}”", open.draft.title);
        let save = card_with_head(
            ui,
            &heading,
            22.0,
            |ui| asked = head(ui, &seen, &before),
            |ui| {
                let height = (ui.available_height() - FOOT).max(60.0);
                ScrollArea::vertical().id_salt("rules").max_height(height).auto_shrink([false, true]).show(ui, |ui| {
                    states(ui, &mut open);
                    ui.add_space(space::S);
                    subtasks(ui, &mut open);
                });
                ui.separator();
                thresholds(ui, &mut open, &session.document, &session.calibration);
                foot(ui, &mut open)
            },
        );
        if asked == Asked::Add {
            open.add_state();
        }
        open.untried |= open.draft != seen;
        session.calibration.rules = Some(open);
        match asked {
            Asked::Close => session.calibration.rules = None,
            Asked::Reset => reset(&mut session.calibration),
            Asked::Nothing if save => rule_editing::save(
                ui.ctx(),
                &session.document,
                &mut session.calibration,
                &mut session.messages,
                &mut session.jobs,
            ),
            Asked::Nothing | Asked::Add => {}
        }
    }
}

fn head(ui: &mut Ui, draft: &Definition, before: &Definition) -> Asked {
    let mut asked = Asked::Nothing;
    if ui.button((Icon::Close, words::CLOSE)).on_hover_text(words::CLOSE_MORE).clicked() {
        asked = Asked::Close;
    }
    if ui
        .add_enabled(draft != before, egui::Button::new((Icon::Reset, words::RESET)))
        .on_hover_text(words::RESET_MORE)
        .clicked()
    {
        asked = Asked::Reset;
    }
    // Here and not under the list, which scrolls.
    if ui.button((Icon::Add, words::ADD_A_STATE)).clicked() {
        asked = Asked::Add;
    }
    let like = draft.like.name();
    let text = if draft.name == like { words::BUILT_IN.to_owned() } else { format!("{}, like {like}", draft.name) };
    ui.label(theme::caption(ui, text));
    asked
}

fn reset(calibration: &mut Calibration) {
    let Some(open) = calibration.rules.as_mut() else { return };
    open.draft = open.before.clone();
    (open.fault, open.untried) = (None, true);
}

/// Draws the thresholds with hysteresis. A needle has none.
fn thresholds(ui: &mut Ui, open: &mut Rules, document: &Document, calibration: &Calibration) {
    if open.draft.like == Task::Needle {
        ui.label(theme::caption(ui, words::A_NEEDLES_PHASES));
        return;
    }
    let used = calibration.segmentation(document.current).map(|s| s.thresholds);
    let policy = &mut open.draft.thresholds;
    ui.horizontal(|ui| {
        let one = |ui: &mut Ui, label: &str, value: &mut Option<f64>, learned: f64, factor: f64, unit: &str| {
            let mut own = value.is_some();
            ui.checkbox(&mut own, label).on_hover_text(words::WITHOUT_THE_TICK);
            let mut shown = factor * value.unwrap_or(learned);
            let speed = 0.005 * shown.max(1e-3);
            let drag = DragValue::new(&mut shown).range(1e-3..=1e4).speed(speed).max_decimals(3);
            ui.add_enabled(own, drag.suffix(format!(" {unit}")));
            *value = own.then_some(shown / factor);
        };
        let force = used.map_or(0.05, |t| t.force_n.max(1e-3));
        let velocity = used.map_or(0.05, |t| t.velocity_m_s.max(1e-6));
        one(ui, words::FORCE, &mut policy.force_n, force, 1.0, "N");
        ui.add_space(space::S);
        one(ui, words::VELOCITY, &mut policy.velocity_m_s, velocity, 1e3, "mm/s");
        ui.add_space(space::S);
        ui.label(words::ZERO_AGAIN_BELOW);
        let mut percent = 100.0 * policy.leave;
        let drag = DragValue::new(&mut percent).range(5.0..=100.0).speed(0.5).max_decimals(0).suffix(" %");
        ui.add(drag).on_hover_text(words::HYSTERESIS_MORE);
        // An untouched value stays as it is written.
        if (percent - 100.0 * policy.leave).abs() > 1e-9 {
            policy.leave = percent / 100.0;
        }
    });
}

/// Draws the name for saving, and the problems; true if it should be saved.
fn foot(ui: &mut Ui, open: &mut Rules) -> bool {
    let mut save = false;
    ui.add_space(space::XS);
    ui.horizontal(|ui| {
        let usable = open.fault.is_none() && !open.name.trim().is_empty();
        ui.add(TextEdit::singleline(&mut open.name).desired_width(150.0).hint_text(words::NAME_OF_YOUR_TASK));
        save = primary_button(ui, usable, (Icon::Save, words::SAVE_AS_MY_TASK)).clicked();
        if let Some(fault) = &open.fault {
            remark(ui, Icon::Wrong, fault);
        } else {
            let text = if open.draft == open.before && open.draft.like == Task::Needle {
                words::FIRST_RULE_COUNTS
            } else if open.draft == open.before {
                words::SIGNS_MORE
            } else {
                words::CHANGED_THE_STATES
            };
            ui.add(egui::Label::new(theme::caption(ui, text)).truncate()).on_hover_text(text);
        }
    });
    save
}
