//! Options of the whole recording: task, axis, rate, selection, known values.

use crate::ui::column_mapping::draft::{Draft, UP, task_words};
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::space;
use crate::ui::kit::widgets::{quiet_icon_button, remark};
use egui::{ComboBox, DragValue, Role as Accessible, Ui, WidgetInfo};
use haptics::recording::Task;
use serde_json::Value;

/// Parameters whose value can be known in advance (`spec/logs.md`, "known").
const KNOWN: [&str; 20] = [
    "mass_kg",
    "inertia_kg_m2",
    "com_m",
    "radius_m",
    "width_m",
    "height_m",
    "weight_N",
    "friction_mu",
    "viscous_N_s_m",
    "viscous_Nm_s",
    "coulomb_N",
    "coulomb_Nm",
    "offset_N",
    "offset_Nm",
    "gravity_moment_Nm",
    "gravity_phase_rad",
    "center_x_m",
    "center_y_m",
    "stiffness_N_m",
    "puncture_force_N",
];
/// Default rate, Hz.
const USUAL_RATE_HZ: f64 = 1_000.0;

/// Draws the options.
pub fn options(ui: &mut Ui, draft: &mut Draft) {
    ui.horizontal_wrapped(|ui| {
        task(ui, draft);
        ui.add_space(space::S);
        up(ui, draft);
        if !draft.has_time() || draft.meta.rate_hz.is_some() {
            ui.add_space(space::S);
            rate(ui, draft);
        }
    });
    ui.horizontal_wrapped(|ui| {
        known(ui, draft);
        select(ui, draft);
    });
    let strays = draft.strays();
    for (name, source) in strays {
        ui.horizontal(|ui| {
            let text = format!("The sidecar takes {name} from {source}, which the file does not have.");
            remark(ui, Icon::Doubt, text);
            if ui.small_button("Forget it").clicked() {
                draft.meta.columns.remove(&name);
            }
        });
    }
}

/// Draws a labelled drop-down. Returns the new choice.
fn choice<T: PartialEq + Clone>(ui: &mut Ui, label: &str, value: &T, shown: &str, all: &[(T, String)]) -> Option<T> {
    let mut chosen = value.clone();
    ui.label(theme::caption(ui, label));
    let response = ComboBox::from_id_salt(("option", label))
        .selected_text(shown)
        .show_ui(ui, |ui| {
            for (value, words) in all {
                ui.selectable_value(&mut chosen, value.clone(), words);
            }
        })
        .response;
    response.widget_info(|| WidgetInfo::labeled(Accessible::ComboBox, true, label));
    (chosen != *value).then_some(chosen)
}

fn task(ui: &mut Ui, draft: &mut Draft) {
    let all: Vec<(Option<Task>, String)> =
        std::iter::once(None).chain(Task::ALL.map(Some)).map(|t| (t, task_words(t))).collect();
    if let Some(task) = choice(ui, "Task", &draft.meta.task, &task_words(draft.meta.task), &all) {
        draft.meta.task = task;
    }
}

fn up(ui: &mut Ui, draft: &mut Draft) {
    let all: Vec<(String, String)> = UP.iter().map(|(k, w)| ((*k).to_owned(), (*w).to_owned())).collect();
    let now = draft.meta.up.clone().unwrap_or_else(|| "y".to_owned());
    let shown = all.iter().find(|(k, _)| *k == now).map_or(now.clone(), |(_, w)| w.clone());
    if let Some(up) = choice(ui, "Up is", &now, &shown, &all) {
        draft.meta.up = Some(up);
    }
}

fn rate(ui: &mut Ui, draft: &mut Draft) {
    let mut given = draft.meta.rate_hz.is_some();
    let hint = "Where no column is the time: samples a second";
    if ui.checkbox(&mut given, "Rate").on_hover_text(hint).changed() {
        draft.meta.rate_hz = given.then_some(USUAL_RATE_HZ);
    }
    if let Some(rate) = &mut draft.meta.rate_hz {
        let speed = 0.01 * rate.abs().max(1.0);
        ui.add(DragValue::new(rate).range(1e-3..=1e6).speed(speed).suffix(" Hz").max_decimals(3));
    } else {
        ui.label(theme::caption(ui, "no time yet: only paths and forces can be used"));
    }
}

fn select(ui: &mut Ui, draft: &mut Draft) {
    let mut removed = None;
    let entries: Vec<(String, Value)> = draft.meta.select.iter().map(|(k, v)| (k.clone(), v.clone())).collect();
    for (column, value) in &entries {
        let text = |v: &Value| v.as_str().map_or_else(|| v.to_string(), str::to_owned);
        let all: Vec<(Value, String)> =
            draft.values_of(column).iter().map(|v| (Value::String(v.clone()), v.clone())).collect();
        let label = format!("Only {column} =");
        // Text and number are the same choice.
        let now = Value::String(text(value));
        if let Some(chosen) = choice(ui, &label, &now, &text(value), &all) {
            draft.meta.select.insert(column.clone(), chosen);
        }
        if quiet_icon_button(ui, Icon::Close, true, "Take every row").on_hover_text("Take every row").clicked() {
            removed = Some(column.clone());
        }
    }
    if let Some(column) = removed {
        draft.meta.select.remove(&column);
    }
    let free: Vec<(String, String)> = draft
        .rows
        .iter()
        .filter(|r| r.facts.distinct.as_ref().is_some_and(|d| d.len() > 1) && (r.facts.whole || !r.facts.numeric))
        .map(|r| r.facts.header.clone())
        .filter(|h| !draft.meta.select.contains_key(h))
        .map(|h| (h.clone(), h))
        .collect();
    if free.is_empty() {
        return;
    }
    ui.menu_button("Choose rows …", |ui| {
        for (column, words) in free {
            if ui.button(words).clicked() {
                let first = draft.values_of(&column).first().cloned().unwrap_or_default();
                draft.meta.select.insert(column, Value::String(first));
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("Keep only the rows in which a column has one value");
}

fn known(ui: &mut Ui, draft: &mut Draft) {
    let mut removed = None;
    for (name, value) in &mut draft.meta.known {
        ui.label(theme::caption(ui, name.as_str()));
        let speed = 0.01 * value.abs().max(1e-3);
        ui.add(DragValue::new(value).speed(speed).max_decimals(9));
        if quiet_icon_button(ui, Icon::Close, true, "Estimate it").on_hover_text("Estimate it").clicked() {
            removed = Some(name.clone());
        }
    }
    if let Some(name) = removed {
        draft.meta.known.remove(&name);
    }
    ui.menu_button("Known value …", |ui| {
        for name in KNOWN.iter().filter(|n| !draft.meta.known.contains_key(**n)).copied().collect::<Vec<_>>() {
            if ui.button(name).clicked() {
                draft.meta.known.insert(name.to_owned(), 1.0);
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("What is known beforehand is not estimated");
}
