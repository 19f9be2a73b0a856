//! The two tables of the rules: states with their signs, and subtasks with their states.

use crate::text::format;
use crate::text::states::state_name;
use crate::ui::calibrate::rules::Rules;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space, state_color};
use crate::ui::kit::widgets::{call, quiet_icon_button, swatch};
use egui::{Align, Button, Color32, ComboBox, Layout, RichText, Stroke, TextEdit, Ui, vec2};
use egui_extras::{Column, TableBuilder, TableRow};
use estimator::segment::definition::{Step, Subtasks, signals};
use estimator::segment::{SystemState, shows};
use haptics::recording::Task;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const FORCE_BIAS: &str = "Force bias";
    pub const TOUCH: &str = "Touch";
    pub const TOUCH_MORE: &str = "Any force of a finger";
    pub const PINCH: &str = "Pinch";
    pub const PINCH_MORE: &str = "The force that pinches: the smaller of the two opposing ones";
    pub const LIFT: &str = "Lift";
    pub const LIFT_MORE: &str = "The force that lifts: the sum of the vertical forces";
    pub const SIDEWAYS: &str = "Sideways";
    pub const SIDEWAYS_MORE: &str = "Horizontal velocity of the grasp";
    pub const UP_DOWN: &str = "Up, down";
    pub const UP_DOWN_MORE: &str = "Vertical velocity of the grasp";
    pub const LOAD: &str = "Load";
    pub const LOAD_MORE: &str = "Grip, force of the tool, or push of a finger";
    pub const SPEED: &str = "Speed";
    pub const SPEED_MORE: &str = "Speed without its sign";
    pub const PHASE: &str = "Phase";
    pub const PHASE_MORE: &str = "The phase of the stroke";
    pub const STATE: &str = "State";
    pub const SHOWS: &str = "Shows";
    pub const MOVE_UP: &str = "Move up: rules are tried from the top";
    pub const REMOVE: &str = "Remove";
    pub const ONCE_AT_FIRST: &str = "Once, at first";
    pub const FOR_EVERY_OBJECT: &str = "For every object";
    pub const EACH: &str = "Each";
    pub const MAY_FAIL: &str = "May fail";
    pub const ADD_A_SUBTASK: &str = "Add a subtask";
    pub const IN_ORDER: &str = "Subtasks in their expected order; {n} is the number of the object. “May fail”: one may have to \
        begin the object again.";
    pub const IN_ANY_ORDER: &str = "Subtasks: whenever the state lasts a while; {n} counts them.";
}

/// Height of a line, points.
const LINE: f32 = 30.0;
/// Width below which the table of states is drawn compactly, points.
const ROOMY: f32 = 740.0;

/// Column widths of the table of states, points.
struct Widths {
    state: f32,
    phase: f32,
    chip: f32,
    buttons: f32,
    gap: f32,
}

impl Widths {
    fn of(room: f32) -> Self {
        if room < ROOMY {
            Self { state: 152.0, phase: 104.0, chip: 18.0, buttons: 44.0, gap: 4.0 }
        } else {
            Self { state: 188.0, phase: 120.0, chip: 20.0, buttons: 60.0, gap: space::S }
        }
    }

    /// Width of three adjacent chips, points.
    fn signs(&self) -> f32 {
        3.0 * self.chip + 2.0 * CHIP_GAP + 4.0
    }
}

/// Gap between the signs of a signal, points.
const CHIP_GAP: f32 = 1.0;

/// Operation on a line.
enum Done {
    Up(usize),
    Gone(usize),
}

/// Label and description of a signal.
fn signal(name: &str) -> (&str, &str) {
    match name {
        "contact" => (words::TOUCH, words::TOUCH_MORE),
        "grip" => (words::PINCH, words::PINCH_MORE),
        "net_force_y" => (words::LIFT, words::LIFT_MORE),
        "velocity_x" => (words::SIDEWAYS, words::SIDEWAYS_MORE),
        "velocity_y" => (words::UP_DOWN, words::UP_DOWN_MORE),
        "load" => (words::LOAD, words::LOAD_MORE),
        "speed" => (words::SPEED, words::SPEED_MORE),
        "phase" => (words::PHASE, words::PHASE_MORE),
        other => (other, ""),
    }
}

/// Draws the states, their conditions and the parameters that they identify.
pub fn states(ui: &mut Ui, open: &mut Rules) {
    let known = signals(open.draft.like);
    let needle = open.draft.like == Task::Needle;
    let mut done = None;
    let widths = Widths::of(ui.available_width());
    ui.spacing_mut().item_spacing = vec2(widths.gap, 0.0);
    let mut table = TableBuilder::new(ui)
        .id_salt("states")
        .vscroll(false)
        .cell_layout(Layout::left_to_right(Align::Center))
        .column(Column::exact(widths.state));
    for _ in known {
        table = table.column(Column::exact(if needle { widths.phase } else { widths.signs() }));
    }
    table
        .column(Column::remainder().clip(true).at_least(80.0))
        .column(Column::exact(widths.buttons))
        .header(18.0, |mut header| {
            header.col(|ui| drop(ui.label(theme::caption(ui, words::STATE))));
            for (name, _) in known {
                let (label, hint) = signal(name);
                header.col(|ui| drop(ui.label(theme::caption(ui, label)).on_hover_text(hint)));
            }
            header.col(|ui| drop(ui.label(theme::caption(ui, words::SHOWS))));
            header.col(|_| {});
        })
        .body(|mut body| {
            for rule in 0..open.draft.states.len() {
                body.row(LINE, |mut row| {
                    row.col(|ui| {
                        state(ui, open, ("rule", rule), |open| &mut open.draft.states[rule].state);
                        if open.added.take_if(|added| *added == rule).is_some() {
                            ui.scroll_to_rect(ui.max_rect(), None);
                        }
                    });
                    for (name, values) in known {
                        row.col(|ui| {
                            if needle {
                                phase(ui, open, rule, values);
                            } else {
                                signs(ui, open, rule, (name, values), widths.chip);
                            }
                        });
                    }
                    row.col(|ui| shown(ui, open, rule));
                    buttons(&mut row, rule, open.draft.states.len() > 1, &mut done);
                });
            }
        });
    match done {
        Some(Done::Up(rule)) => open.draft.states.swap(rule - 1, rule),
        Some(Done::Gone(rule)) => drop(open.draft.states.remove(rule)),
        None => {}
    }
}

/// Draws the buttons to move a line up and to remove it.
fn buttons(row: &mut TableRow<'_, '_>, index: usize, removable: bool, done: &mut Option<Done>) {
    row.col(|ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.spacing_mut().button_padding.x = 4.0;
        ui.spacing_mut().interact_size.y = 20.0;
        let up = format!("Move rule {} up", index + 1);
        if quiet_icon_button(ui, Icon::Up, index > 0, &up).on_hover_text(words::MOVE_UP).clicked() {
            *done = Some(Done::Up(index));
        }
        let away = format!("Remove rule {}", index + 1);
        if quiet_icon_button(ui, Icon::Close, removable, &away).on_hover_text(words::REMOVE).clicked() {
            *done = Some(Done::Gone(index));
        }
    });
}

/// Draws a chooser among the states allowed for the task.
fn state(ui: &mut Ui, open: &mut Rules, id: (&str, usize), place: impl Fn(&mut Rules) -> &mut SystemState) {
    let all: Vec<SystemState> = open.states().collect();
    let chosen = place(open);
    swatch(ui, state_color(ui.visuals().dark_mode, *chosen));
    let width = (ui.available_width() - 2.0 * space::S).min(164.0);
    let list = ComboBox::from_id_salt(id).width(width).selected_text(state_name(*chosen)).truncate();
    let list = list.show_ui(ui, |ui| {
        for state in all {
            ui.selectable_value(chosen, state, state_name(state));
        }
    });
    call(&list.response, &format!("State of {} {}", id.0, id.1 + 1));
}

/// Draws the allowed signs of a signal: three chips, none of them lit for any sign.
fn signs(ui: &mut Ui, open: &mut Rules, rule: usize, (name, values): (&str, &[&str]), chip_width: f32) {
    ui.spacing_mut().item_spacing.x = CHIP_GAP;
    ui.spacing_mut().button_padding = vec2(0.0, 0.0);
    let p = palette(ui);
    let lit = open.draft.states[rule].when.get(name).cloned().unwrap_or_default();
    for value in values.iter().filter_map(|v| v.chars().next()) {
        let on = lit.contains(value);
        let text = if value == '-' { "−".to_owned() } else { value.to_string() };
        let (ink, fill, edge) = if on {
            (p.on_accent, p.accent, Stroke::NONE)
        } else {
            (p.faint, Color32::TRANSPARENT, Stroke::new(1.0, p.border))
        };
        let chip = Button::new(RichText::new(text).size(12.0).color(ink)).fill(fill).stroke(edge).corner_radius(4);
        let response = ui.add(chip.min_size(vec2(chip_width, 20.0)));
        let label = format!("{} {} {value}", state_name(open.draft.states[rule].state), signal(name).0);
        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, on, label.clone()));
        if response.clicked() {
            open.switch(rule, name, value);
        }
    }
}

/// Draws the chooser of a needle's phase.
fn phase(ui: &mut Ui, open: &mut Rules, rule: usize, values: &[&str]) {
    let when = &mut open.draft.states[rule].when;
    let mut chosen = when.get("phase").cloned().unwrap_or_default();
    let text = if chosen.is_empty() { "any" } else { chosen.as_str() };
    let list = ComboBox::from_id_salt(("phase", rule))
        .width(ui.available_width() - 2.0 * space::S)
        .selected_text(text.to_owned())
        .show_ui(ui, |ui| {
            ui.selectable_value(&mut chosen, String::new(), "any");
            for value in values {
                ui.selectable_value(&mut chosen, (*value).to_owned(), *value);
            }
        });
    call(&list.response, &format!("Phase of rule {}", rule + 1));
    if chosen.is_empty() {
        when.remove("phase");
    } else {
        when.insert("phase".to_owned(), chosen);
    }
}

/// Label of a parameter in the list of a state.
pub(crate) fn parameter(name: &str) -> String {
    if name == "force_bias" { words::FORCE_BIAS.to_owned() } else { format::parameter(name, None).label }
}

/// Draws the parameters that a state identifies: a menu with checkboxes.
fn shown(ui: &mut Ui, open: &mut Rules, rule: usize) {
    let all = shows::parameters(open.draft.like);
    let shown = &mut open.draft.states[rule].shows;
    let words: Vec<String> = shown.iter().map(|name| parameter(name)).collect();
    let text = if words.is_empty() { "nothing".to_owned() } else { words.join(", ") };
    let ink = if words.is_empty() { palette(ui).faint } else { palette(ui).text };
    let list = ComboBox::from_id_salt(("shows", rule))
        .width(ui.available_width() - space::S)
        .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
        .selected_text(RichText::new(&text).size(12.0).color(ink))
        .truncate()
        .show_ui(ui, |ui| {
            for name in all {
                let mut on = shown.iter().any(|s| s == name);
                if ui.checkbox(&mut on, parameter(name)).changed() {
                    shown.retain(|s| s != name);
                    if on {
                        shown.push((*name).to_owned());
                    }
                }
            }
        });
    call(&list.response, &format!("What the state of rule {} shows", rule + 1));
    list.response.on_hover_text(format!("Fits take their samples from the states that show a parameter.\n{text}"));
}

/// Draws the subtasks with their states: in an expected order, or each on its own.
pub fn subtasks(ui: &mut Ui, open: &mut Rules) {
    ui.separator();
    ui.add_space(space::XS);
    let ordered = matches!(open.draft.subtasks, Subtasks::Ordered(_));
    let text = if ordered { words::IN_ORDER } else { words::IN_ANY_ORDER };
    ui.label(theme::caption(ui, text));
    ui.add_space(space::XS);
    if ordered {
        group(ui, open, words::ONCE_AT_FIRST, |open| match &mut open.draft.subtasks {
            Subtasks::Ordered(ordered) => &mut ordered.first,
            Subtasks::Each(each) => &mut each.each,
        });
        ui.add_space(space::XS);
    }
    group(ui, open, if ordered { words::FOR_EVERY_OBJECT } else { words::EACH }, |open| {
        match &mut open.draft.subtasks {
            Subtasks::Ordered(ordered) => &mut ordered.repeat,
            Subtasks::Each(each) => &mut each.each,
        }
    });
}

/// Draws one list of subtasks.
fn group(ui: &mut Ui, open: &mut Rules, title: &str, steps: impl Fn(&mut Rules) -> &mut Vec<Step>) {
    let ordered = matches!(open.draft.subtasks, Subtasks::Ordered(_));
    let mut done = None;
    ui.push_id(title, |ui| {
        TableBuilder::new(ui)
            .id_salt(title)
            .vscroll(false)
            .cell_layout(Layout::left_to_right(Align::Center))
            .column(Column::exact(190.0))
            .column(Column::exact(188.0))
            .column(Column::exact(90.0))
            .column(Column::exact(60.0))
            .header(18.0, |mut header| {
                header.col(|ui| drop(ui.label(theme::caption(ui, title))));
                header.col(|ui| drop(ui.label(theme::caption(ui, words::STATE))));
                header.col(|_| {});
                header.col(|_| {});
            })
            .body(|mut body| {
                for index in 0..steps(open).len() {
                    body.row(LINE, |mut row| {
                        row.col(|ui| {
                            let name = &mut steps(open)[index].name;
                            let field = ui.add(TextEdit::singleline(name).desired_width(174.0));
                            call(&field, &format!("Name of step {}", index + 1));
                        });
                        row.col(|ui| state(ui, open, ("step", index), |open| &mut steps(open)[index].state));
                        row.col(|ui| {
                            if ordered {
                                ui.checkbox(&mut steps(open)[index].retry, words::MAY_FAIL);
                            }
                        });
                        buttons(&mut row, index, true, &mut done);
                    });
                }
            });
        match done {
            Some(Done::Up(index)) => steps(open).swap(index - 1, index),
            Some(Done::Gone(index)) => drop(steps(open).remove(index)),
            None => {}
        }
        if ui.button((Icon::Add, words::ADD_A_SUBTASK)).clicked() {
            let state = open.draft.states.first().map_or(SystemState::FreeMotion, |rule| rule.state);
            let list = steps(open);
            let mut number = list.len() + 1;
            while list.iter().any(|step| step.name == format!("step-{number}-{{n}}")) {
                number += 1;
            }
            list.push(Step { name: format!("step-{number}-{{n}}"), state, retry: false });
        }
    });
}
