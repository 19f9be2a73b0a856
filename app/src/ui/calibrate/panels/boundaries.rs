//! Manual editing of states: handles between the states of the band, and the context menu of a state.

use crate::text::format;
use crate::text::states::state_name;
use crate::ui::calibrate::manual_states::Change;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, state_color};
use crate::ui::kit::widgets::swatch;
use egui::{CursorIcon, Pos2, Rect, Response, Sense, Stroke, Ui, vec2};
use estimator::segment::{Segmentation, SystemState};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const SET_BY_HAND: &str = "Set by hand";
    pub const STATE: &str = "State";
    pub const SUBTASK: &str = "Subtask";
    pub const NONE: &str = "None";
    pub const SPLIT: &str = "Split at the time cursor";
    pub const SPLIT_NOT: &str = "Put the time cursor inside this state first";
    pub const JOIN: &str = "Join with the next";
    pub const NO_STATES_TAKEN: &str = "The fit of this task takes no states: it finds its phases by itself.";
    pub const ONLY_THIS: &str = "Fit only this stretch";
    pub const ONLY_THIS_MORE: &str = "Leaves out what is before and after it";
    pub const WHOLE: &str = "Fit the whole recording";
}

/// Distance within which a boundary can be grabbed, to either side, points.
const GRASP: f32 = 4.0;

/// Draws handles on the boundaries in the visible time range. Returns the change by a drag.
pub fn handles(ui: &Ui, view_s: (f64, f64), segmentation: &Segmentation, band: Rect) -> Option<Change> {
    let mut change = None;
    let (from, to) = view_s;
    let per_s = f64::from(band.width()) / (to - from).max(1e-12);
    let boundaries = segmentation.states.len().saturating_sub(1);
    for (index, interval) in segmentation.states.iter().enumerate().take(boundaries) {
        let x = band.left() + ((interval.t1 - from) * per_s) as f32;
        if !band.x_range().expand(1.0).contains(x) {
            continue;
        }
        let rect = Rect::from_center_size(Pos2::new(x, band.center().y), vec2(2.0 * GRASP, band.height() + 4.0));
        let response = ui.interact(rect, ui.scope_id().with(("boundary", index)), Sense::drag());
        let name = || format!("Boundary at {} s", format::number(interval.t1, 2));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Splitter, true, name()));
        if response.hovered() || response.dragged() {
            ui.set_cursor_icon(CursorIcon::ResizeHorizontal);
            mark(ui, x, band, response.is_pointer_button_down_on());
        }
        if response.dragged()
            && let Some(at) = response.interact_pointer_pos()
        {
            let to_s = from + f64::from(at.x - band.left()) / per_s;
            change = Some(Change::Move { interval: index, to_s });
        }
        if response.hovered() && !response.dragged() {
            let name = name();
            response.on_hover_text(format!("{name}\nDrag to move it; the fit follows"));
        }
    }
    change
}

/// Draws a grip at the boundary, in another colour while it is dragged.
fn mark(ui: &Ui, x: f32, band: Rect, held: bool) {
    let p = palette(ui);
    let ink = if held { p.accent } else { p.text };
    let painter = ui.painter();
    painter.vline(x, band.y_range().expand(3.0), Stroke::new(2.0, ink));
    painter.circle(Pos2::new(x, band.center().y), 4.5, p.card, Stroke::new(2.0, ink));
}

/// Context menu of a state where the fit uses no states: restricts the fit to this time range.
pub fn stretch_menu(response: &Response, stretch_s: (f64, f64), calibration: &mut Calibration) {
    response.context_menu(|ui| {
        ui.set_max_width(230.0);
        ui.label(theme::caption(ui, words::NO_STATES_TAKEN));
        if ui.button(words::ONLY_THIS).on_hover_text(words::ONLY_THIS_MORE).clicked() {
            calibration.choice.only_s = Some(stretch_s);
            ui.close();
        }
        if calibration.choice.only_s.is_some() && ui.button(words::WHOLE).clicked() {
            calibration.choice.only_s = None;
            ui.close();
        }
    });
}

/// Context menu of a state; `at_s` is the time under the pointer.
pub fn menu(response: &Response, segmentation: &Segmentation, index: usize, document: &Document) -> Option<Change> {
    let mut change = None;
    let cursor_s = document.cursor_s;
    response.context_menu(|ui| {
        let interval = &segmentation.states[index];
        ui.label(theme::caption(ui, words::SET_BY_HAND));
        ui.menu_button(words::STATE, |ui| {
            for state in states(segmentation) {
                let picked = ui
                    .horizontal(|ui| {
                        swatch(ui, state_color(ui.visuals().dark_mode, state));
                        ui.selectable_label(state == interval.state, state_name(state)).clicked()
                    })
                    .inner;
                if picked {
                    change = Some(Change::State { interval: index, state });
                    ui.close();
                }
            }
        });
        ui.menu_button(words::SUBTASK, |ui| {
            for subtask in subtasks(segmentation) {
                let words = subtask.as_deref().map_or(words::NONE.to_owned(), format::object);
                if ui.selectable_label(subtask == interval.subtask, words).clicked() {
                    change = Some(Change::Subtask { interval: index, subtask });
                    ui.close();
                }
            }
        });
        let inside = cursor_s > interval.t0 && cursor_s < interval.t1;
        let split = ui.add_enabled(inside, egui::Button::new(words::SPLIT));
        if split.on_disabled_hover_text(words::SPLIT_NOT).clicked() {
            change = Some(Change::Split { interval: index, at_s: cursor_s });
            ui.close();
        }
        let last = index + 1 >= segmentation.states.len();
        if ui.add_enabled(!last, egui::Button::new(words::JOIN)).clicked() {
            change = Some(Change::Join { interval: index });
            ui.close();
        }
    });
    change
}

/// States of the task, and none.
fn states(segmentation: &Segmentation) -> Vec<SystemState> {
    let mut states: Vec<SystemState> =
        segmentation.definition.iter().flat_map(|d| d.states.iter().map(|rule| rule.state)).collect();
    states.extend(segmentation.states.iter().map(|i| i.state));
    states.push(SystemState::NoState);
    let mut seen = Vec::new();
    states.retain(|state| {
        !seen.contains(state) && {
            seen.push(*state);
            true
        }
    });
    states
}

/// Subtasks of the recording in their order, and none.
fn subtasks(segmentation: &Segmentation) -> Vec<Option<String>> {
    let mut names: Vec<Option<String>> = vec![None];
    for interval in &segmentation.states {
        if !names.contains(&interval.subtask) {
            names.push(interval.subtask.clone());
        }
    }
    names
}
