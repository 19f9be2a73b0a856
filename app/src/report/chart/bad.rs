//! Unreliable parts of a recording: gaps, which no curve may cross, and spans in which a channel is constant or
//! saturated.

use crate::report::chart::frame::{Frame, key, short};
use crate::text::format;
use crate::ui::document::prepared::{Prepared, Trace};
use crate::ui::plots::decimate::{Columns, decimate_in};
use crate::ui::plots::levels::Samples;
use egui_plot::PlotPoint;
use estimator::log::gaps;
use haptics::recording::{Recording, Span};
use maud::{Markup, html};
use std::ops::Range;

/// Warnings whose samples are marked, with the class of the mark and its name.
const MARKED: [(&str, &str, &str); 3] = [
    ("stuck-channel", "stuck", "does not change"),
    ("saturation", "limit", "at its limit"),
    ("outlier", "limit", "outlier"),
];
/// Height of a mark, and its minimum width.
const HEIGHT: f64 = 5.0;
const LEAST: f64 = 1.5;
/// Minimum number of columns to which a short segment between gaps is thinned.
const LEAST_COLUMNS: usize = 8;

/// Segments of samples between gaps.
pub fn stretches(prepared: &Prepared) -> Vec<Range<usize>> {
    let times = if prepared.clockless() { &[][..] } else { &prepared.times };
    let mut first = 0;
    let mut runs: Vec<Range<usize>> = Vec::new();
    for last in gaps(times) {
        runs.push(first..last + 1);
        first = last + 1;
    }
    runs.push(first..prepared.times.len());
    runs
}

/// Gaps, from the last sample before to the first one after, s.
pub fn holes(prepared: &Prepared) -> Vec<(f64, f64)> {
    stretches(prepared).windows(2).map(|w| (prepared.times[w[0].end - 1], prepared.times[w[1].start])).collect()
}

/// Parts of a time span outside the gaps.
pub fn outside(holes: &[(f64, f64)], (from, to): (f64, f64)) -> Vec<(f64, f64)> {
    let mut parts = Vec::new();
    let mut at = from;
    for (begin, end) in holes.iter().filter(|h| h.1 > from && h.0 < to) {
        if *begin > at {
            parts.push((at, *begin));
        }
        at = *end;
    }
    if to > at {
        parts.push((at, to));
    }
    parts
}

/// Curve thinned to extremes, with a NaN point at every gap so that it is interrupted.
pub fn thinned(prepared: &Prepared, samples: Samples<'_>, times: &[f64], columns: usize) -> Vec<PlotPoint> {
    let (from, to) = prepared.span();
    let mut points = Vec::new();
    for run in stretches(prepared).into_iter().filter(|r| r.end <= times.len() && !r.is_empty()) {
        let share = (times[run.end - 1] - times[run.start]) / (to - from);
        let count = ((columns as f64 * share) as usize).max(LEAST_COLUMNS);
        if !points.is_empty() {
            points.push(PlotPoint::new(f64::NAN, f64::NAN));
        }
        points.extend(decimate_in(times, samples, &Columns::within(times, run, count)));
    }
    points
}

/// Bands over the gaps.
pub fn gaps_in(frame: &Frame, holes: &[(f64, f64)]) -> Markup {
    let (_, height) = frame.inner();
    html! { @for hole in holes { (gap(frame.right(hole.0), frame.right(hole.1), height, hole)) } }
}

/// Band from one edge to the other, with its text.
pub fn gap(from: f64, to: f64, height: f64, hole: &(f64, f64)) -> Markup {
    html! {
        rect class="gap" x=(short(from)) y="0" width=(short((to - from).max(LEAST))) height=(short(height)) {
            title { "Gap: no samples from " (format::number(hole.0, 3)) " to " (format::number(hole.1, 3)) " s" }
        }
    }
}

/// Marks at the bottom of a chart, where one of its channels is constant or saturated.
pub fn marks(frame: &Frame, prepared: &Prepared, names: &[&str]) -> Markup {
    let recording = &prepared.recording;
    let time = |sample: usize| prepared.times.get(sample).copied().unwrap_or(prepared.span().1);
    let foot = frame.inner().1 - HEIGHT;
    html! {
        @for (span, class, words, column) in marked(recording, names) {
            @let (t0, t1) = (time(span.first), time(span.end.saturating_sub(1)));
            @let (from, to) = (frame.right(t0), frame.right(t1));
            rect class=(class) x=(short(from)) y=(short(foot)) width=(short((to - from).max(LEAST))) height=(HEIGHT) {
                title { (column) " " (words) ", " (format::number(t0, 3)) " … " (format::number(t1, 3)) " s" }
            }
        }
    }
}

/// Legend of the marks and bands in a chart, each once; empty without any.
pub fn keys(prepared: &Prepared, names: &[&str]) -> Markup {
    let shown = marked(&prepared.recording, names);
    html! {
        @for (class, words) in [("caution", "does not change"), ("danger", "at its limit"), ("danger", "outlier")] {
            @if shown.iter().any(|m| m.2 == words) { (key(class, words)) }
        }
        @if !holes(prepared).is_empty() { (key("faint", "gap")) }
    }
}

/// Names of curves' channels.
pub fn names(traces: &[Trace]) -> Vec<&str> {
    traces.iter().map(|t| t.name.as_str()).collect()
}

/// Marked spans of these channels; a span of the whole recording is omitted, since it does not locate anything.
fn marked<'a>(recording: &'a Recording, names: &'a [&str]) -> Vec<(Span, &'static str, &'static str, &'a str)> {
    let mut found = Vec::new();
    for warning in &recording.warnings {
        let Some((_, class, words)) = MARKED.iter().find(|m| m.0 == warning.kind) else { continue };
        let Some(column) = warning.column.as_deref().filter(|c| names.contains(c)) else { continue };
        found.extend(warning.spans.iter().map(|span| (*span, *class, *words, column)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_outside_gaps_is_what_is_left_of_a_stretch() {
        let holes = [(2.0, 3.0), (5.0, 6.0)];
        assert_eq!(outside(&holes, (0.0, 1.0)), [(0.0, 1.0)]);
        assert_eq!(outside(&holes, (1.0, 7.0)), [(1.0, 2.0), (3.0, 5.0), (6.0, 7.0)]);
        assert_eq!(outside(&holes, (2.2, 5.5)), [(3.0, 5.0)]);
        assert!(outside(&holes, (2.0, 3.0)).is_empty());
    }

    #[test]
    fn a_curve_is_broken_at_a_gap_and_keeps_its_ends() {
        use crate::ui::plots::levels::Levels;
        let times: Vec<f64> = (0..8000).map(|i| f64::from(i) * 1e-3 + if i < 5000 { 0.0 } else { 2.0 }).collect();
        let prepared = Prepared::new(Recording { time_s: Some(times.clone()), ..Recording::default() });
        let levels = Levels::new(times.clone());
        let points = thinned(&prepared, levels.samples(&prepared.recording), &times, 900);
        assert_eq!(holes(&prepared), [(times[4999], times[5000])]);
        let breaks: Vec<usize> = (0..points.len()).filter(|k| points[*k].x.is_nan()).collect();
        let [at] = breaks[..] else { panic!("one break: {breaks:?}") };
        assert!((points[at - 1].y - times[4999]).abs() < 1e-12 && (points[at + 1].y - times[5000]).abs() < 1e-12);
    }
}
