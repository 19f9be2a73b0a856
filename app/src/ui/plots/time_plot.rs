//! One plot over time: its curves, those of the models, the noise band, the states behind them, and the cursor.

use crate::ui::kit::theme;
use crate::ui::kit::theme::palette;
use crate::ui::plots::axes::{AXIS_WIDTH, still_plot, time_axis};
use crate::ui::plots::choices::GroupChoice;
use crate::ui::plots::curves::{Curve, Layer, NOISE_SWITCH};
use crate::ui::plots::data_warnings::shade;
use crate::ui::plots::interaction::react;
use crate::ui::plots::line::ThinnedLine;
use crate::ui::plots::plot_cache::PlotCache;
use crate::ui::plots::plot_header::gutter;
use crate::ui::plots::plot_input::{RowInput, RowKind, RowOutcome, curve_color};
use crate::ui::plots::residual_plot::{BAND_SIGMAS, inks};
use egui::{Color32, Pos2, Rect, Sense, Stroke, Ui, UiBuilder, vec2};
use egui_plot::{FilledArea, PlotBounds, PlotPoint, PlotTransform, PlotUi, Span};

/// Width of the column left of the plots.
pub const GUTTER: f32 = 196.0;
/// Height of the labels of the time axis.
const AXIS_HEIGHT: f32 = 20.0;
/// Additional width of curves under the pointer, points.
const GRASPED: f32 = 1.2;

/// Draws the row.
pub fn row(ui: &mut Ui, cache: &mut PlotCache, choice: &mut GroupChoice, input: &RowInput<'_>) -> RowOutcome {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), input.height), Sense::hover());
    let (left, plot) = rect.split_left_right_at_x(rect.left() + GUTTER);
    ui.scope_builder(UiBuilder::new().max_rect(left).id_salt(("gutter", input.index)), |ui| {
        gutter(ui, choice, input);
    });
    let show_noise = choice.shows(NOISE_SWITCH);
    ui.scope_builder(UiBuilder::new().max_rect(plot).id_salt(("plot", input.index)), |ui| {
        draw_plot(ui, cache, input, show_noise)
    })
    .inner
}

fn width(layer: Layer) -> f32 {
    match layer {
        // A broad line under the measured curve shows agreement and deviation.
        Layer::Simulated => 4.5,
        Layer::Extended => 2.8,
        Layer::Measured => 1.4,
        Layer::Other(_) | Layer::LeftSimulated | Layer::LeftExtended => 1.2,
    }
}

fn draw_plot(ui: &mut Ui, cache: &mut PlotCache, input: &RowInput<'_>, show_noise: bool) -> RowOutcome {
    cache.update(input, ((ui.available_width() - AXIS_WIDTH) * ui.pixels_per_point()) as usize);
    let (p, dark, inks) = (palette(ui), ui.visuals().dark_mode, inks(ui));
    let noise = show_noise.then_some(inks.noise);
    let y_range = y_range(cache, input, show_noise);
    let plot = still_plot(("row", input.index), p, input.height, 10.0, 130.0)
        .width(ui.available_width())
        .show_axes([input.time_axis, true])
        .sense(Sense::click_and_drag())
        .custom_x_axes(vec![time_axis(p, input.prepared.clockless())]);
    let response = plot.show(ui, |plot| {
        plot.set_plot_bounds(PlotBounds::from_min_max([input.view_s.0, y_range.0], [input.view_s.1, y_range.1]));
        let (from, to) = input.view_s;
        let visible = input.segmentation.iter().flat_map(|s| &s.states).filter(|i| i.t1 >= from && i.t0 <= to);
        for interval in visible {
            let tint = theme::state_color(dark, interval.state).gamma_multiply(if dark { 0.16 } else { 0.22 });
            plot.span(Span::new("", interval.t0..=interval.t1).fill(tint).border_width(0.0));
        }
        if let Some(ink) = noise {
            bands(plot, cache, input, ink);
        }
        for (place, curve) in input.drawn.curves.iter().enumerate() {
            let color = curve_color(input, curve, dark, p);
            let more = if input.grasped.is_some_and(|g| curve.layer == Layer::Other(g)) { GRASPED } else { 0.0 };
            plot.add(ThinnedLine::new(cache.points(input, place), width(curve.layer) + more, color));
        }
    });
    let doubt = shade(ui, &response.transform, input.prepared, input.group);
    draw_cursor(ui, &response.transform, input);
    if let Some(doubt) = doubt {
        response.response.clone().on_hover_text_at_pointer(doubt);
    }
    react(ui, &response.response, &response.transform, cache, input)
}

/// Draws noise bands around the last model of every trace; around zero in a residual row.
fn bands<'a>(plot: &mut PlotUi<'a>, cache: &'a PlotCache, input: &RowInput<'_>, ink: Color32) {
    if input.kind == RowKind::LeftOver {
        if let Some(sigma) = input.drawn.curves.iter().filter_map(|c| c.sigma).reduce(f64::max) {
            let (from, to) = input.view_s;
            let edge = BAND_SIGMAS * sigma;
            plot.add(FilledArea::new("", &[from, to], &[-edge; 2], &[edge; 2]).fill_color(ink).allow_hover(false));
        }
        return;
    }
    let of_model = if input.drawn.has(Layer::Extended) { Layer::Extended } else { Layer::Simulated };
    for (place, _) in input.drawn.curves.iter().enumerate().filter(|(_, c)| c.layer == of_model) {
        if let Some(band) = cache.band(input, place) {
            plot.add(FilledArea::new("", &band.times, &band.low, &band.high).fill_color(ink).allow_hover(false));
        }
    }
}

/// Range of the visible curves with a margin; never empty. A diverging model must not compress the measured curves.
fn y_range(cache: &PlotCache, input: &RowInput<'_>, show_noise: bool) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let counts = |curve: &&Curve| !matches!(curve.layer, Layer::Simulated | Layer::Extended);
    for (place, _) in input.drawn.curves.iter().enumerate().filter(|(_, c)| counts(c)) {
        // Explicit comparison instead of `min` and `max`: there are tens of thousands of points.
        for point in cache.points(input, place).iter().filter(|p| p.y.is_finite()) {
            low = if point.y < low { point.y } else { low };
            high = if point.y > high { point.y } else { high };
        }
    }
    if input.kind == RowKind::LeftOver && show_noise {
        let edge = BAND_SIGMAS * input.drawn.curves.iter().filter_map(|c| c.sigma).fold(0.0, f64::max);
        (low, high) = (low.min(-edge), high.max(edge));
    }
    if low > high {
        return (-1.0, 1.0);
    }
    let air = (0.08 * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-9);
    (low - air, high + air)
}

fn draw_cursor(ui: &Ui, transform: &PlotTransform, input: &RowInput<'_>) {
    let (p, dark) = (palette(ui), ui.visuals().dark_mode);
    let area: Rect = *transform.frame();
    let painter = ui.painter().with_clip_rect(area.expand(1.0));
    let x = transform.position_from_point(&PlotPoint::new(input.cursor_s, 0.0)).x;
    painter.vline(x, area.y_range(), Stroke::new(1.2, p.accent));
    let sample = input.prepared.sample_at(input.cursor_s);
    let marked = |layer| matches!(layer, Layer::Measured | Layer::LeftSimulated | Layer::LeftExtended);
    for curve in input.drawn.curves.iter().filter(|c| marked(c.layer)) {
        let value = curve.levels.samples(&curve.prepared.recording).value(sample);
        if value.is_finite() {
            let y = transform.position_from_point(&PlotPoint::new(input.cursor_s, value)).y;
            let color = curve_color(input, curve, dark, p);
            painter.circle(Pos2::new(x, y), 3.0, color, Stroke::new(1.0, p.card));
        }
    }
}

/// Height that the time axis adds to a row of plots, points.
pub const fn axis_height() -> f32 {
    AXIS_HEIGHT
}
