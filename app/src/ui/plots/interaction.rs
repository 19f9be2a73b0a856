//! Pointer interaction of a plot over time.

use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::plots::plot_cache::PlotCache;
use crate::ui::plots::plot_input::{RowInput, RowOutcome};
use crate::ui::plots::shift::{Grasp, under};
use egui::{Align2, CursorIcon, PointerButton, Pos2, Rect, Response, Ui, vec2};
use egui_plot::PlotTransform;

/// Width from which a marked part is no click, points.
const LEAST_PART: f32 = 3.0;

/// Handles the pointer. Left drag on the curve of another recording shifts it; left drag elsewhere moves the cursor.
/// With Shift, left drag marks a part. The wheel zooms about the pointer, right or middle drag pans, and a double click shows everything.
pub fn react(
    ui: &mut Ui,
    response: &Response,
    transform: &PlotTransform,
    cache: &PlotCache,
    input: &RowInput<'_>,
) -> RowOutcome {
    let mut outcome = RowOutcome::at(transform.frame().x_range());
    let (first, last) = input.prepared.span();
    let (from, to) = input.view_s;
    let pointer = response.interact_pointer_pos().or(response.hover_pos());
    let time = pointer.map(|at| transform.value_from_position(at).x);
    if let Some(from_s) = mark_start(ui, response, time) {
        let x = |t: f64| transform.position_from_point_x(t);
        let part_s = time.map_or((from_s, from_s), |t| (t.min(from_s).max(first), t.max(from_s).min(last)));
        let band = Rect::from_x_y_ranges(x(part_s.0)..=x(part_s.1), transform.frame().y_range());
        ui.painter().rect_filled(band, 0.0, palette(ui).accent.gamma_multiply(0.18));
        outcome.part_s = Some(part_s).filter(|_| response.drag_stopped() && band.width() > LEAST_PART);
        return outcome;
    }
    outcome.grasp = pointer.and_then(|at| grasp(ui, response, transform, cache, input, at));
    if let Some(grasp) = outcome.grasp {
        show_grasp(ui, response, transform, input, grasp);
    } else if response.double_clicked() {
        outcome.view_s = Some((first, last));
        return outcome;
    } else if response.is_pointer_button_down_on() && ui.input(|i| i.pointer.primary_down()) {
        outcome.seek = time;
    }
    let drag = response.drag_delta().x;
    let moved = [PointerButton::Secondary, PointerButton::Middle].iter().any(|b| response.dragged_by(*b));
    if moved && drag != 0.0 {
        let shift = -f64::from(drag) * (to - from) / f64::from(transform.frame().width().max(1.0));
        let shift = shift.clamp(first - from, (last - to).max(first - from));
        outcome.view_s = Some((from + shift, to + shift));
    }
    let scroll = if response.hovered() { ui.input(|i| i.smooth_scroll_delta().y) } else { 0.0 };
    if let (Some(center), true) = (time, scroll != 0.0) {
        let factor = (-f64::from(scroll) * 0.004).exp();
        let width = ((to - from) * factor).clamp((last - first) * 1e-5, last - first);
        let start = center - (center - from) / (to - from) * width;
        let start = start.clamp(first, (last - width).max(first));
        outcome.view_s = Some((start, start + width));
    }
    outcome
}

/// Time at which the part begins that is being marked, s; `None` without Shift at the start of the drag.
fn mark_start(ui: &Ui, response: &Response, time: Option<f64>) -> Option<f64> {
    let id = response.id.with("part");
    if response.drag_started_by(PointerButton::Primary)
        && ui.input(|i| i.modifiers.shift)
        && let Some(time) = time
    {
        ui.data_mut(|data| data.insert_temp(id, time));
    }
    let start = ui.data(|data| data.get_temp(id))?;
    if response.dragged() {
        return Some(start);
    }
    ui.data_mut(|data| data.remove::<f64>(id));
    response.drag_stopped().then_some(start)
}

/// Interaction of the pointer with the curve of another recording, if any.
fn grasp(
    ui: &Ui,
    response: &Response,
    transform: &PlotTransform,
    cache: &PlotCache,
    input: &RowInput<'_>,
    pointer: Pos2,
) -> Option<Grasp> {
    let down_here = response.is_pointer_button_down_on();
    let (down, pressed, alt) = ui.input(|i| (i.pointer.primary_down(), i.pointer.primary_pressed(), i.modifiers.alt));
    let at_s = transform.value_from_position(pointer).x;
    if input.held.is_some() {
        let s_per_point = (input.view_s.1 - input.view_s.0) / f64::from(transform.frame().width().max(1.0));
        return (down_here && down).then_some(Grasp::Moves { to_s: at_s, s_per_point, freely: alt });
    }
    if down && !pressed || !(response.hovered() || down_here) || !transform.frame().contains(pointer) {
        return None;
    }
    let curves = input.drawn.curves.iter().enumerate().map(|(place, curve)| (curve, cache.points(input, place)));
    let place = under(curves, transform, pointer)?;
    Some(if pressed && down_here { Grasp::Takes(place, at_s) } else { Grasp::Over(place) })
}

/// Draws the hand cursor and the shift of the dragged recording.
fn show_grasp(ui: &mut Ui, response: &Response, transform: &PlotTransform, input: &RowInput<'_>, grasp: Grasp) {
    if let Grasp::Over(_) = grasp {
        ui.set_cursor_icon(CursorIcon::Grab);
        let hint = "Drag to shift this recording. It comes to rest where both are most alike; not with Alt held. Esc takes it back.";
        response.clone().on_hover_text_at_pointer(hint);
        return;
    }
    ui.set_cursor_icon(CursorIcon::Grabbing);
    let Some((words, snapped)) = input.held.as_ref() else { return };
    let p = palette(ui);
    let ink = if *snapped { p.good } else { p.text };
    let galley = ui.painter().layout_no_wrap(words.clone(), egui::FontId::proportional(11.5), ink);
    let at = transform.frame().right_top() + vec2(-space::S - galley.size().x, space::S);
    let card = Rect::from_min_size(at, galley.size()).expand2(vec2(6.0, 3.0));
    ui.painter().rect(card, theme::CONTROL_RADIUS, p.card, egui::Stroke::new(1.0, p.border), egui::StrokeKind::Inside);
    ui.painter().galley(Align2::LEFT_TOP.anchor_size(at, galley.size()).min, galley, ink);
}
