//! States over time, and the subtask of each.

use super::bad;
use crate::report::chart::frame::{LEFT, RIGHT, WIDE, key, short};
use crate::report::style::state_variable;
use crate::text::format;
use crate::text::states::{state_of_task, state_short};
use estimator::segment::{Interval, Segmentation, SystemState};
use maud::{Markup, html};

/// Heights of the band and of the subtasks under it.
const BAND: f64 = 24.0;
const SUBTASKS: f64 = 18.0;
/// Approximate width of a letter of a label.
const LETTER: f64 = 6.4;
/// Minimum width of a separately drawn part.
const LEAST: f64 = 0.3;

/// Band over the same time as the curves below it; a gap contains no states, so only the gap is drawn there.
pub fn band(segmentation: &Segmentation, span_s: (f64, f64), holes: &[(f64, f64)]) -> Markup {
    let width = WIDE - LEFT - RIGHT;
    let x = |t: f64| LEFT + (t - span_s.0) / (span_s.1 - span_s.0) * width;
    let says = format!("States over time: {} intervals", segmentation.states.len());
    html! {
        svg class="chart" viewBox=(format!("0 0 {WIDE} {}", BAND + SUBTASKS + 4.0)) role="img" aria-label=(says) {
            @for interval in &segmentation.states {
                @for (t0, t1) in bad::outside(holes, (interval.t0, interval.t1)) {
                    @let (from, to) = (x(t0).max(LEFT), x(t1).min(LEFT + width));
                    @if to - from > LEAST { (piece(segmentation, interval, (from, to))) }
                }
            }
            @for hole in holes { (bad::gap(x(hole.0), x(hole.1), BAND, hole)) }
            @for (name, t0, t1) in subtasks(segmentation, holes) {
                @let (from, to) = (x(t0) + 1.0, x(t1) - 1.0);
                @if to - from > 3.0 {
                    path class="line zero" d=(format!("M{} {}V{}H{}V{}", short(from), BAND + 1.0, BAND + 4.0, short(to), BAND + 1.0)) {}
                    @if to - from > LETTER * 0.9 * name.chars().count() as f64 {
                        text class="tick" x=(short(0.5 * (from + to))) y=(BAND + 16.0) text-anchor="middle" { (name) }
                    }
                }
            }
        }
    }
}

fn piece(segmentation: &Segmentation, interval: &Interval, (from, to): (f64, f64)) -> Markup {
    let variable = state_variable(interval.state);
    let (name, width) = (state_of_task(segmentation, interval.state), to - from);
    let fits = |text: &str| width > LETTER * text.chars().count() as f64 + 6.0;
    let label = [name, state_short(interval.state)].into_iter().find(|text| fits(text));
    html! {
        g {
            title {
                (name) ", " (format::number(interval.t0, 2)) " … " (format::number(interval.t1, 2)) " s"
                @if let Some(subtask) = &interval.subtask { ", " (subtask) }
            }
            rect x=(short(from)) y="0" width=(format!("{:.2}", (width - 0.6).max(LEAST))) height=(BAND)
                rx=[(width > 8.0).then_some("3")] style=(format!("fill:var(--{variable})")) {}
            @if let Some(label) = label {
                text class="label" x=(short(from + 0.5 * width)) y=(0.5 * BAND + 4.0) text-anchor="middle"
                    style=(format!("fill:var(--{variable}-ink)")) { (label) }
            }
        }
    }
}

/// Runs of intervals of one subtask, split at gaps.
fn subtasks(segmentation: &Segmentation, holes: &[(f64, f64)]) -> Vec<(String, f64, f64)> {
    let mut runs: Vec<(String, f64, f64)> = Vec::new();
    for interval in &segmentation.states {
        let Some(subtask) = &interval.subtask else { continue };
        match runs.last_mut() {
            Some((name, _, end)) if name == subtask => *end = interval.t1,
            _ => runs.push((subtask.clone(), interval.t0, interval.t1)),
        }
    }
    let pieces = |(name, t0, t1): (String, f64, f64)| {
        bad::outside(holes, (t0, t1)).into_iter().map(move |(from, to)| (name.clone(), from, to)).collect::<Vec<_>>()
    };
    runs.into_iter().flat_map(pieces).collect()
}

/// Legend of the states' colours, with the share of the recorded time of each.
pub fn legend(segmentation: &Segmentation, holes: &[(f64, f64)]) -> Markup {
    let recorded = |i: &Interval| bad::outside(holes, (i.t0, i.t1)).iter().map(|(from, to)| to - from).sum::<f64>();
    let whole: f64 = segmentation.states.iter().map(recorded).sum();
    let mut shares: Vec<(SystemState, f64)> = Vec::new();
    for interval in &segmentation.states {
        let length = recorded(interval);
        match shares.iter_mut().find(|(state, _)| *state == interval.state) {
            Some((_, share)) => *share += length,
            None => shares.push((interval.state, length)),
        }
    }
    html! {
        span class="keys block" {
            @for (state, time) in &shares {
                @let share = format::number(100.0 * time / whole.max(1e-12), 0);
                (key(&state_variable(*state), &format!("{} {share} %", state_of_task(segmentation, *state))))
            }
            @if !holes.is_empty() { (key("faint", "gap")) }
        }
    }
}
