//! One plot with its gutter: title, unit, curves with their values at the cursor.

use super::axes::{AXIS_WIDTH, still_plot, time_axis};
use super::doubts::shade;
use super::{Levels, decimate};
use crate::ui::format;
use crate::ui::prepare::{Group, Prepared, Trace};
use crate::ui::theme::{self, palette, space};
use egui::{Align, Color32, Layout, Pos2, Rangef, Rect, RichText, Sense, Stroke, Ui, UiBuilder, vec2};
use egui_plot::{Line, PlotBounds, PlotPoint, PlotPoints, PlotTransform, Span};
use estimator::segment::Segmentation;
use render::ColorRole;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Width of the column left of the plots.
pub const GUTTER: f32 = 196.0;
/// Height of the labels of the time axis.
const AXIS_HEIGHT: f32 = 20.0;

/// What a row shows.
pub struct RowInput<'a> {
    /// Which plot it is.
    pub index: usize,
    /// The curves.
    pub group: &'a Group,
    /// Their recording.
    pub prepared: &'a Arc<Prepared>,
    /// Predicted curves by channel name.
    pub predicted: &'a [(String, Levels)],
    /// States, as a faint tint.
    pub segmentation: Option<&'a Segmentation>,
    /// Visible time.
    pub view_s: (f64, f64),
    /// The cursor.
    pub cursor_s: f64,
    /// Whether the time axis is labelled here.
    pub time_axis: bool,
    /// Height, points.
    pub height: f32,
}

/// What the user did in a row.
pub struct RowOutcome {
    /// The cursor was put here.
    pub seek: Option<f64>,
    /// The visible time was changed.
    pub view_s: Option<(f64, f64)>,
    /// Where the plot's area lies horizontally.
    pub area: Rangef,
}

/// Thinned curves, kept while the view stays, and the curves that the user has hidden.
#[derive(Default)]
pub struct PlotCache {
    curves: HashMap<(usize, usize, bool), Cached>,
    hidden: HashSet<String>,
}

struct Cached {
    /// Recording, curve, visible time and columns that the points were made for.
    key: (usize, usize, u64, u64, usize),
    points: Vec<PlotPoint>,
}

impl PlotCache {
    fn update(&mut self, input: &RowInput<'_>, columns: usize) {
        for (t, trace) in input.group.traces.iter().enumerate() {
            self.thin((input.index, t, false), input, &trace.levels, columns);
            match predicted(input, trace) {
                Some(levels) => self.thin((input.index, t, true), input, levels, columns),
                None => drop(self.curves.remove(&(input.index, t, true))),
            }
        }
    }

    fn thin(&mut self, slot: (usize, usize, bool), input: &RowInput<'_>, levels: &Levels, columns: usize) {
        let (from, to) = input.view_s;
        let at = |p: *const u8| p as usize;
        let key = (
            at(Arc::as_ptr(input.prepared).cast()),
            at(std::ptr::from_ref(levels).cast()),
            from.to_bits(),
            to.to_bits(),
            columns,
        );
        if self.curves.get(&slot).is_none_or(|cached| cached.key != key) {
            let samples = levels.samples(&input.prepared.recording);
            let points = decimate(&input.prepared.times, samples, from, to, columns);
            self.curves.insert(slot, Cached { key, points });
        }
    }

    fn is_shown(&self, group: &Group, trace: &Trace) -> bool {
        !self.hidden.contains(&key_of(group, trace))
    }
}

fn key_of(group: &Group, trace: &Trace) -> String {
    format!("{}/{}", group.title, trace.name)
}

fn predicted<'a>(input: &RowInput<'a>, trace: &Trace) -> Option<&'a Levels> {
    input.predicted.iter().find(|(name, _)| *name == trace.name).map(|(_, levels)| levels)
}

/// Draws the row.
pub fn row(ui: &mut Ui, cache: &mut PlotCache, input: &RowInput<'_>) -> RowOutcome {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), input.height), Sense::hover());
    let (gutter, plot) = rect.split_left_right_at_x(rect.left() + GUTTER);
    ui.scope_builder(UiBuilder::new().max_rect(gutter).id_salt(("gutter", input.index)), |ui| {
        draw_gutter(ui, cache, input);
    });
    ui.scope_builder(UiBuilder::new().max_rect(plot).id_salt(("plot", input.index)), |ui| draw_plot(ui, cache, input))
        .inner
}

fn draw_gutter(ui: &mut Ui, cache: &mut PlotCache, input: &RowInput<'_>) {
    ui.spacing_mut().item_spacing = vec2(6.0, 0.0);
    ui.add_space(2.0);
    ui.horizontal(|ui| {
        ui.label(theme::strong(&input.group.title));
        ui.label(theme::caption(ui, &input.group.unit));
    });
    let sample = input.prepared.sample_at(input.cursor_s);
    let room = ui.available_height();
    egui::ScrollArea::vertical().id_salt(("curves", input.index)).min_scrolled_height(0.0).max_height(room).show(
        ui,
        |ui| {
            ui.spacing_mut().interact_size.y = 15.0;
            let traces = &input.group.traces;
            // Two columns when one would not fit.
            let lines = traces.len() + usize::from(traces.iter().any(|t| predicted(input, t).is_some()));
            let columns = if lines as f32 * 15.0 > room { 2 } else { 1 };
            let width = (ui.available_width() - space::S) / columns as f32;
            for line in traces.chunks(columns) {
                ui.horizontal(|ui| {
                    for trace in line {
                        let size = vec2(width - 4.0, 15.0);
                        ui.allocate_ui(size, |ui| {
                            ui.set_min_size(size);
                            curve_entry(ui, cache, input, trace, sample, columns > 1);
                        });
                    }
                });
            }
            if input.group.traces.iter().any(|t| predicted(input, t).is_some()) {
                let color = theme::role(ui.visuals().dark_mode, ColorRole::Simulated);
                ui.horizontal(|ui| {
                    dash(ui, color.gamma_multiply(0.75), 5.0);
                    ui.label(RichText::new("simulated").size(11.5).color(color));
                });
            }
        },
    );
}

/// Swatch, name and value at the cursor; a click hides or shows the curve.
fn curve_entry(ui: &mut Ui, cache: &mut PlotCache, input: &RowInput<'_>, trace: &Trace, sample: usize, narrow: bool) {
    let shown = cache.is_shown(input.group, trace);
    let p = palette(ui);
    let color = if shown { theme::curve(ui.visuals().dark_mode, trace.role, trace.second) } else { p.faint };
    let entry = ui.scope_builder(UiBuilder::new().sense(Sense::click()).id_salt(&trace.name), |ui| {
        ui.horizontal(|ui| {
            dash(ui, if shown { color } else { p.border }, 2.5);
            let words = if shown { p.secondary } else { p.faint };
            ui.add(egui::Label::new(RichText::new(&trace.label).size(11.5).color(words)).truncate());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let value = trace.levels.samples(&input.prepared.recording).value(sample);
                let text = if shown && value.is_finite() {
                    value_text(value, &input.group.unit, narrow)
                } else {
                    String::new()
                };
                ui.label(RichText::new(text).size(11.5).color(p.text));
            });
        });
    });
    let response =
        entry.response.on_hover_text(format!("{}: click to {}", trace.name, if shown { "hide" } else { "show" }));
    if response.clicked() {
        let key = key_of(input.group, trace);
        if !cache.hidden.remove(&key) {
            cache.hidden.insert(key);
        }
    }
}

fn value_text(value: f64, unit: &str, narrow: bool) -> String {
    let decimals = match unit {
        "mm" if narrow => 1,
        "mm" | "N" | "N·m" => 2,
        "mm/s" | "°" | "°/s" => 1,
        _ => 3,
    };
    format::number(value, decimals)
}

fn dash(ui: &mut Ui, color: Color32, width: f32) {
    let (rect, _) = ui.allocate_exact_size(vec2(10.0, 15.0), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(width, color));
}

fn draw_plot(ui: &mut Ui, cache: &mut PlotCache, input: &RowInput<'_>) -> RowOutcome {
    cache.update(input, ((ui.available_width() - AXIS_WIDTH) * ui.pixels_per_point()) as usize);
    let (p, dark) = (palette(ui), ui.visuals().dark_mode);
    let shown: Vec<(usize, &Trace)> =
        input.group.traces.iter().enumerate().filter(|(_, t)| cache.is_shown(input.group, t)).collect();
    let y_range = y_range(cache, input, &shown);
    let plot = still_plot(("row", input.index), p, input.height, 10.0, 130.0)
        .width(ui.available_width())
        .show_axes([input.time_axis, true])
        .sense(Sense::click_and_drag())
        .custom_x_axes(vec![time_axis(p, input.prepared.clockless())]);
    let response = plot.show(ui, |plot| {
        let bounds = PlotBounds::from_min_max([input.view_s.0, y_range.0], [input.view_s.1, y_range.1]);
        plot.set_plot_bounds(bounds);
        for interval in input.segmentation.iter().flat_map(|s| &s.states) {
            let tint = theme::state_color(dark, interval.state).gamma_multiply(if dark { 0.16 } else { 0.22 });
            plot.span(Span::new("", interval.t0..=interval.t1).fill(tint).border_width(0.0));
        }
        for (t, _) in &shown {
            // A broad band under the measured curve: seen where they agree and where they part.
            if let Some(cached) = cache.curves.get(&(input.index, *t, true)) {
                let line = Line::new("", PlotPoints::Borrowed(&cached.points));
                let color = theme::role(dark, ColorRole::Simulated).gamma_multiply(0.75);
                plot.line(line.color(color).width(4.0).allow_hover(false));
            }
        }
        for (t, trace) in &shown {
            if let Some(cached) = cache.curves.get(&(input.index, *t, false)) {
                let line = Line::new("", PlotPoints::Borrowed(&cached.points));
                plot.line(line.color(theme::curve(dark, trace.role, trace.second)).width(1.4).allow_hover(false));
            }
        }
    });
    let doubt = shade(ui, &response.transform, input.prepared, input.group);
    draw_cursor(ui, &response.transform, input, &shown);
    if let Some(doubt) = doubt {
        response.response.clone().on_hover_text_at_pointer(doubt);
    }
    react(ui, &response.response, &response.transform, input)
}

/// The visible curves with a little air; never an empty range.
fn y_range(cache: &PlotCache, input: &RowInput<'_>, shown: &[(usize, &Trace)]) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for (t, _) in shown {
        if let Some(cached) = cache.curves.get(&(input.index, *t, false)) {
            for point in cached.points.iter().filter(|p| p.y.is_finite()) {
                (low, high) = (low.min(point.y), high.max(point.y));
            }
        }
    }
    if low > high {
        return (-1.0, 1.0);
    }
    let air = (0.08 * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-9);
    (low - air, high + air)
}

fn draw_cursor(ui: &Ui, transform: &PlotTransform, input: &RowInput<'_>, shown: &[(usize, &Trace)]) {
    let (p, dark) = (palette(ui), ui.visuals().dark_mode);
    let area: Rect = *transform.frame();
    let painter = ui.painter().with_clip_rect(area.expand(1.0));
    let x = transform.position_from_point(&PlotPoint::new(input.cursor_s, 0.0)).x;
    painter.vline(x, area.y_range(), Stroke::new(1.2, p.accent));
    let sample = input.prepared.sample_at(input.cursor_s);
    for (_, trace) in shown {
        let value = trace.levels.samples(&input.prepared.recording).value(sample);
        if value.is_finite() {
            let y = transform.position_from_point(&PlotPoint::new(input.cursor_s, value)).y;
            painter.circle(
                Pos2::new(x, y),
                3.0,
                theme::curve(dark, trace.role, trace.second),
                Stroke::new(1.0, p.card),
            );
        }
    }
}

/// Left: cursor. Wheel: zoom about the pointer. Right or middle: move. Double click: everything.
fn react(ui: &Ui, response: &egui::Response, transform: &PlotTransform, input: &RowInput<'_>) -> RowOutcome {
    let mut outcome = RowOutcome { area: transform.frame().x_range(), seek: None, view_s: None };
    let (first, last) = input.prepared.span();
    let (from, to) = input.view_s;
    let pointer = response.interact_pointer_pos().or(response.hover_pos());
    let time = pointer.map(|at| transform.value_from_position(at).x);
    if response.double_clicked() {
        outcome.view_s = Some((first, last));
        return outcome;
    }
    if response.is_pointer_button_down_on() && ui.input(|i| i.pointer.primary_down()) {
        outcome.seek = time;
    }
    let drag = response.drag_delta().x;
    let moved = [egui::PointerButton::Secondary, egui::PointerButton::Middle].iter().any(|b| response.dragged_by(*b));
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

/// Height that a row of plots adds for the time axis.
pub const fn axis_height() -> f32 {
    AXIS_HEIGHT
}
