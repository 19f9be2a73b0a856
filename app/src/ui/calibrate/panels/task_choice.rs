//! The drop-down of tasks: the built-in ones and those of the user.

use crate::tasks::Chosen;
use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::calibrate::rule_editing;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::widgets::call;
use crate::ui::shell::message_list::Messages;
use egui::{ComboBox, Ui};
use estimator::segment::definition::{Definition, SIDECAR_KEY};
use estimator::segment::library;
use haptics::recording::{Recording, Task};
use std::sync::Arc;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const TASK: &str = "Task";
    pub const YOURS: &str = "Yours";
    pub const RULES_MORE: &str = "States, when they hold, their thresholds and what they show: look at them, \
        change them, save them as a task of yours";
    pub const CLOSE_RULES: &str = "Close rules";
    pub const RULES: &str = "Rules …";
}

/// Offered tasks.
const TASKS: [Task; 6] = [Task::BlockStack, Task::Crank, Task::Needle, Task::Switch, Task::Mechanism, Task::Payload];

/// Selection of the user.
enum Picked {
    Automatic,
    BuiltIn(Task),
    Own(String),
}

/// Draws the drop-down, and the button to the task's rules.
pub fn task_choice(ui: &mut Ui, document: &Document, calibration: &mut Calibration, messages: &mut Messages) {
    let mut picked = None;
    ui.horizontal(|ui| {
        ui.label(theme::caption(ui, words::TASK));
        let prepared = document.prepared().cloned();
        let told = prepared.as_ref().map_or("unknown".to_owned(), |p| told(&p.recording, p.task));
        let automatic = format!("Automatic ({told})");
        let choice = &calibration.choice;
        let text = match (&choice.own, choice.task) {
            (Some(own), _) => own.name.clone(),
            (None, Some(task)) => format::object(task.name()),
            // Short enough for the narrow card.
            (None, None) => format!("Auto: {told}"),
        };
        let list = ComboBox::from_id_salt("task")
            .width(ui.available_width() - 2.0 * ui.spacing().button_padding.x)
            .selected_text(text)
            .truncate()
            .show_ui(ui, |ui| {
                let plain = choice.own.is_none();
                if ui.selectable_label(plain && choice.task.is_none(), automatic).clicked() {
                    picked = Some(Picked::Automatic);
                }
                for task in TASKS {
                    if ui.selectable_label(plain && choice.task == Some(task), format::object(task.name())).clicked() {
                        picked = Some(Picked::BuiltIn(task));
                    }
                }
                let own = library::folder().map(library::names).unwrap_or_default();
                if !own.is_empty() {
                    ui.separator();
                    ui.label(theme::caption(ui, words::YOURS));
                }
                for name in own {
                    let on = choice.own.as_ref().is_some_and(|task| task.name == name);
                    if ui.selectable_label(on, &name).clicked() {
                        picked = Some(Picked::Own(name));
                    }
                }
            });
        call(&list.response, words::TASK);
    });
    match picked {
        Some(Picked::Automatic) => set(document, calibration, messages, None, None),
        Some(Picked::BuiltIn(task)) => set(document, calibration, messages, Some(task), None),
        Some(Picked::Own(name)) => match Chosen::find(&name) {
            Ok(task) => set(document, calibration, messages, Some(task.like()), task.own().cloned().map(Arc::new)),
            Err(error) => messages.fail(sentence(&error.to_string())),
        },
        None => {}
    }
    edit(ui, document, calibration, messages);
}

/// Name of the task as which a recording is read.
fn told(recording: &Recording, task: Option<Task>) -> String {
    let own = recording.meta.other.get(SIDECAR_KEY).and_then(|own| own.get("name")?.as_str());
    own.or(task.map(Task::name)).unwrap_or("unknown").replace('-', " ")
}

fn set(
    document: &Document,
    calibration: &mut Calibration,
    messages: &mut Messages,
    task: Option<Task>,
    own: Option<Arc<Definition>>,
) {
    (calibration.choice.task, calibration.choice.own) = (task, own);
    if calibration.rules.take().is_some() {
        calibration.rules = rule_editing::open(document, calibration, messages);
    }
}

/// Opens and closes the rules.
fn edit(ui: &mut Ui, document: &Document, calibration: &mut Calibration, messages: &mut Messages) {
    let open = calibration.rules.is_some();
    let hint = words::RULES_MORE;
    if ui.button((Icon::Rules, if open { words::CLOSE_RULES } else { words::RULES })).on_hover_text(hint).clicked() {
        calibration.rules = if open { None } else { rule_editing::open(document, calibration, messages) };
    }
}
