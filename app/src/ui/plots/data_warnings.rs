//! Doubtful spans of a recording: shaded where they are, explained under the pointer.

use crate::ui::document::prepared::{Group, Prepared};
use crate::ui::kit::theme::palette;
use egui::{Pos2, Rect, Ui, pos2};
use egui_plot::{PlotPoint, PlotTransform};
use haptics::recording::Warning;

/// Minimum width of a shade, points, so that one sample in a million is still visible.
const LEAST_WIDTH: f32 = 3.0;
/// Height of the mark along the upper edge, points.
const MARK_HEIGHT: f32 = 4.0;

/// Intervals of a warning, from and to, s (or samples of a clockless log).
pub fn places(prepared: &Prepared, warning: &Warning) -> Vec<(f64, f64)> {
    let time = |sample: usize| prepared.times.get(sample).copied();
    let place =
        |span: &haptics::recording::Span| Some((time(span.first)?, time(span.end.saturating_sub(1).max(span.first))?));
    warning.spans.iter().filter_map(place).collect()
}

/// True if a warning belongs in the plot of a group: it is about one of its channels, or about the clock.
fn concerns(prepared: &Prepared, group: &Group, warning: &Warning) -> bool {
    let Some(column) = &warning.column else { return true };
    let is_channel = prepared.recording.channels.iter().any(|c| c.name == *column);
    !is_channel || group.traces.iter().any(|t| t.name == *column)
}

/// Shades the doubtful spans of a plot. Returns the explanation of the one under the pointer.
pub fn shade(ui: &Ui, transform: &PlotTransform, prepared: &Prepared, group: &Group) -> Option<String> {
    let p = palette(ui);
    let area: Rect = *transform.frame();
    let painter = ui.painter().with_clip_rect(area);
    let pointer: Option<Pos2> = ui.input(|i| i.pointer.hover_pos()).filter(|at| area.contains(*at));
    let x_of = |time: f64| transform.position_from_point(&PlotPoint::new(time, 0.0)).x;
    let mut said: Vec<&str> = Vec::new();
    for warning in prepared.recording.warnings.iter().filter(|w| concerns(prepared, group, w)) {
        for (from, to) in places(prepared, warning) {
            let (left, right) = (x_of(from), x_of(to));
            let wider = 0.5 * (LEAST_WIDTH - (right - left)).max(0.0);
            let (left, right) = (left - wider, right + wider);
            if right < area.left() || left > area.right() {
                continue;
            }
            let all = Rect::from_min_max(pos2(left, area.top()), pos2(right, area.bottom()));
            painter.rect_filled(all, 0, p.caution.gamma_multiply(0.16));
            painter.rect_filled(all.with_max_y(area.top() + MARK_HEIGHT), 0, p.caution);
            if pointer.is_some_and(|at| all.expand(2.0).contains(at)) && !said.contains(&warning.text.as_str()) {
                said.push(&warning.text);
            }
        }
    }
    let sentences: Vec<String> = said.into_iter().map(crate::text::sentence::sentence).collect();
    (!sentences.is_empty()).then(|| sentences.join("\n"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::{Channel, Recording, Span};

    #[test]
    fn a_warning_is_shown_where_it_belongs() {
        let warning = |column: &str| Warning {
            kind: "stuck-channel".to_owned(),
            column: Some(column.to_owned()),
            spans: vec![Span { first: 1, end: 3 }, Span { first: 4, end: 5 }, Span { first: 90, end: 99 }],
            text: "it is stuck".to_owned(),
            ..Warning::default()
        };
        let channel = |name: &str, unit: &str| Channel { name: name.into(), unit: unit.into(), values: vec![0.0; 6] };
        let recording = Recording {
            time_s: Some((0..6).map(f64::from).collect()),
            channels: vec![channel("q_m", "m"), channel("f_N", "N")],
            ..Recording::default()
        };
        let prepared = Prepared::new(recording);
        // A span outside the recording is omitted.
        assert_eq!(places(&prepared, &warning("f_N")), [(1.0, 2.0), (4.0, 4.0)]);
        let shown = |column: &str| -> Vec<bool> {
            prepared.groups.iter().map(|g| concerns(&prepared, g, &warning(column))).collect()
        };
        assert_eq!(
            (shown("q_m"), shown("f_N"), shown("t_s")),
            (vec![true, false], vec![false, true], vec![true, true])
        );
    }
}
