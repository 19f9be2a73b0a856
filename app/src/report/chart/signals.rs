//! Measured curves, and measured curves over simulated ones.

use super::bad;
use crate::report::chart::frame::{Frame, WIDE, key, range_of};
use crate::report::collect::Drawn;
use crate::report::style::{role_name, state_variable};
use crate::text::format;
use crate::ui::document::prepared::{Group, Prepared, Trace};
use crate::ui::plots::levels::Levels;
use egui_plot::PlotPoint;
use estimator::segment::{Segmentation, SystemState};
use haptics::recording::Channel;
use maud::{Markup, html};

/// Number of columns to which a long curve is thinned: each keeps its minimum and maximum.
const COLUMNS: usize = 900;
/// Height of a chart.
const HEIGHT: f64 = 150.0;
/// Maximum number of curves of one recording: a table may have thousands of columns.
const MOST_CURVES: usize = 24;

/// All measured curves of a recording, a chart for each quantity.
pub fn signals(drawn: &Drawn) -> Markup {
    let groups = &drawn.prepared.groups;
    let all: usize = groups.iter().map(|g| g.traces.len()).sum();
    let mut left = MOST_CURVES;
    let mut charts = Vec::new();
    for group in groups {
        let shown = &group.traces[..group.traces.len().min(left)];
        left -= shown.len();
        if !shown.is_empty() {
            charts.push(quantity(drawn, group, shown));
        }
    }
    html! {
        @for chart in &charts { (chart) }
        @if all > MOST_CURVES {
            p class="muted small" { (MOST_CURVES) " of " (all) " channels are drawn." }
        }
    }
}

fn quantity(drawn: &Drawn, group: &Group, traces: &[Trace]) -> Markup {
    let prepared = &drawn.prepared;
    let span_s = prepared.span();
    let points: Vec<Vec<PlotPoint>> = traces
        .iter()
        .map(|t| bad::thinned(prepared, t.levels.samples(&prepared.recording), &prepared.times, COLUMNS))
        .collect();
    let frame = Frame {
        size: (WIDE, HEIGHT),
        x: span_s,
        y: range_of(points.iter().flatten().map(|p| p.y), 0.06),
        x_unit: Some(time_unit(prepared)),
    };
    let holes = bad::holes(prepared);
    let inside = html! {
        (bad::gaps_in(&frame, &holes))
        (tints(drawn.segmentation.as_ref(), &frame, &holes))
        @for (trace, points) in traces.iter().zip(&points) {
            (curve(&frame, points, "line", &role_name(trace.role, trace.second)))
        }
        (bad::marks(&frame, prepared, &bad::names(traces)))
    };
    let says = format!("{} over time: {}", group.title, names(traces));
    html! {
        figure {
            figcaption {
                b { (group.title) @if !group.unit.is_empty() { ", " (group.unit) } }
                span class="keys" {
                    @for trace in traces { (key(&role_name(trace.role, trace.second), &trace.label)) }
                    (bad::keys(prepared, &bad::names(traces)))
                }
            }
            (frame.draw(&says, &inside))
        }
    }
}

fn names(traces: &[Trace]) -> String {
    traces.iter().map(|t| t.label.as_str()).collect::<Vec<_>>().join(", ")
}

fn time_unit(prepared: &Prepared) -> &'static str {
    if prepared.clockless() { "" } else { " s" }
}

/// Faint stripes in the colours of the states, none in a gap.
fn tints(segmentation: Option<&Segmentation>, frame: &Frame, holes: &[(f64, f64)]) -> Markup {
    let states = segmentation.iter().flat_map(|s| &s.states).filter(|i| i.state != SystemState::FreeMotion);
    let (_, height) = frame.inner();
    html! {
        @for interval in states {
            @for (t0, t1) in bad::outside(holes, (interval.t0, interval.t1)) {
                @let (from, to) = (frame.right(t0), frame.right(t1));
                @if to - from > 0.5 {
                    rect class="tint" x=(crate::report::chart::frame::short(from)) y="0" width=(crate::report::chart::frame::short(to - from)) height=(crate::report::chart::frame::short(height))
                        style=(format!("fill:var(--{})", state_variable(interval.state))) {}
                }
            }
        }
    }
}

fn curve(frame: &Frame, points: &[PlotPoint], class: &str, color: &str) -> Markup {
    let data = frame.line(points.iter().map(|p| (p.x, p.y)));
    html! { path class=(class) style=(format!("stroke:var(--{color})")) d=(data) {} }
}

/// Simulated channel with the measured one over it, and the residual below, in one unit; `width` in units of the page.
pub fn against_virtual(
    prepared: &Prepared,
    predicted: &Channel,
    times: &[f64],
    rms: Option<f64>,
    width: f64,
) -> Markup {
    let (unit, factor) = format::channel_unit(&predicted.unit);
    let span_s = prepared.span();
    let scaled = |values: &[f64]| values.iter().map(|v| v * factor).collect::<Vec<f64>>();
    let simulated = scaled(&predicted.values);
    let measured = prepared.recording.channel(&predicted.name).map(scaled);
    let left: Option<Vec<f64>> =
        measured.as_ref().map(|m| m.iter().zip(&simulated).map(|(m, s)| m - s).collect::<Vec<_>>());
    let thin = |values: Vec<f64>| {
        let levels = Levels::new(values);
        let columns = (width / WIDE * COLUMNS as f64) as usize;
        bad::thinned(prepared, levels.samples(&prepared.recording), times, columns)
    };
    let (simulated, measured, left) = (thin(simulated), measured.map(thin), left.map(thin));
    let size = |height: f64| (width, height);
    let y = range_of(simulated.iter().chain(measured.iter().flatten()).map(|p| p.y), 0.06);
    let above = Frame { size: size(130.0), x: span_s, y, x_unit: None };
    let holes = bad::holes(prepared);
    let names = [predicted.name.as_str()];
    let curves = html! {
        (bad::gaps_in(&above, &holes))
        (curve(&above, &simulated, "line broad", "simulated"))
        @if let Some(measured) = &measured { (curve(&above, measured, "line", "measured")) }
        (bad::marks(&above, prepared, &names))
    };
    html! {
        figure {
            figcaption {
                b { (predicted.name) ", " (unit) }
                @if let Some(rms) = rms {
                    span class="muted" { "left over " (format::significant(rms * factor, 3)) " " (unit) " RMS" }
                }
            }
            (above.draw(&format!("{} measured and simulated", predicted.name), &curves))
            @if let Some(left) = &left {
                // The same scale as above: a small residual looks small.
                @let half = 0.5 * (y.1 - y.0);
                @let below = Frame { size: size(88.0), x: span_s, y: (-half, half), x_unit: Some(time_unit(prepared)) };
                @let inside = html! {
                    (bad::gaps_in(&below, &holes))
                    line class="zero" x1="0" x2=(below.inner().0) y1=(below.down(0.0)) y2=(below.down(0.0)) {}
                    (curve(&below, left, "line thin", "measured"))
                };
                (below.draw(&format!("{} measured less simulated", predicted.name), &inside))
            }
        }
    }
}
