//! The frame of a chart: axes, scales and SVG.

use crate::text::format;
use crate::ui::plots::axes::{decimals, marks};
use maud::{Markup, html};
use std::fmt::Write as _;

/// Width of a chart over the full page width, in its own units.
pub const WIDE: f64 = 960.0;
/// Margin for the numbers on the left, and at the other edges.
pub(crate) const LEFT: f64 = 50.0;
pub(crate) const RIGHT: f64 = 8.0;
const TOP: f64 = 6.0;
const BOTTOM: f64 = 20.0;

/// Size and ranges of a chart.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Whole size.
    pub size: (f64, f64),
    /// Horizontal range.
    pub x: (f64, f64),
    /// Vertical range.
    pub y: (f64, f64),
    /// Unit behind the numbers at the bottom; no numbers if `None`.
    pub x_unit: Option<&'static str>,
}

impl Frame {
    /// Size of the area inside the axes.
    pub fn inner(&self) -> (f64, f64) {
        let bottom = if self.x_unit.is_some() { BOTTOM } else { TOP };
        (self.size.0 - LEFT - RIGHT, self.size.1 - TOP - bottom)
    }

    /// Horizontal position of a value, in the inner area.
    pub fn right(&self, x: f64) -> f64 {
        (x - self.x.0) / (self.x.1 - self.x.0) * self.inner().0
    }

    /// Vertical position of a value from the top, in the inner area.
    pub fn down(&self, y: f64) -> f64 {
        (self.y.1 - y) / (self.y.1 - self.y.0) * self.inner().1
    }

    /// Path of a line through points, interrupted at non-finite ones.
    pub fn line(&self, points: impl Iterator<Item = (f64, f64)>) -> String {
        let (mut text, mut drawing) = (String::new(), false);
        for (x, y) in points {
            let (right, down) = (self.right(x), self.down(y));
            if !(right.is_finite() && down.is_finite()) {
                drawing = false;
                continue;
            }
            // Far-off points are clamped; such large numbers would only make the page long.
            let (right, down) = (right.clamp(-1e4, 1e4), down.clamp(-1e4, 1e4));
            let _ = write!(text, "{}{right:.1} {down:.1}", if drawing { 'L' } else { 'M' });
            drawing = true;
        }
        text
    }

    /// Chart: grid and numbers, with `inside` clipped at the edges. `says` is the text for screen readers.
    pub fn draw(&self, says: &str, inside: &Markup) -> Markup {
        let (width, height) = self.inner();
        let across = marks(self.x, (self.size.0 / 90.0).max(3.0));
        let up = marks(self.y, if self.size.1 > 140.0 { 5.0 } else { 4.0 });
        let number = |value: f64, step: f64| format::number(value, decimals(step));
        html! {
            svg class="chart" viewBox=(format!("0 0 {} {}", self.size.0, self.size.1)) role="img" aria-label=(says) {
                @for mark in &up {
                    @let y = TOP + self.down(mark.value);
                    line class="grid" x1=(LEFT) x2=(LEFT + width) y1=(short(y)) y2=(short(y)) {}
                    text class="tick" x=(LEFT - 6.0) y=(short(y + 3.5)) text-anchor="end" { (number(mark.value, mark.step_size)) }
                }
                @for mark in &across {
                    @let x = LEFT + self.right(mark.value);
                    line class="grid" x1=(short(x)) x2=(short(x)) y1=(TOP) y2=(short(TOP + height)) {}
                    @if let Some(unit) = self.x_unit {
                        // The last number stays within the picture.
                        @let x = x.clamp(LEFT + 4.0, LEFT + width - 12.0);
                        text class="tick" x=(short(x)) y=(short(TOP + height + 14.0)) text-anchor="middle" {
                            (number(mark.value, mark.step_size)) (unit)
                        }
                    }
                }
                svg x=(LEFT) y=(TOP) width=(short(width)) height=(short(height)) overflow="hidden" { (inside) }
            }
        }
    }
}

/// Coordinate as a short number, px.
pub(crate) fn short(value: f64) -> String {
    let text = format!("{value:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Range of all finite `values`, with a margin of `air` at both ends; never empty.
pub fn range_of(values: impl Iterator<Item = f64>, air: f64) -> (f64, f64) {
    let (low, high) = values
        .filter(|v| v.is_finite())
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return (-1.0, 1.0);
    }
    let air = (air * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-9);
    (low - air, high + air)
}

/// A swatch with its name.
pub(crate) fn key(color: &str, name: &str) -> Markup {
    html! { span class="key" { span class="swatch" style=(format!("background:var(--{color})")) {} (name) } }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame() -> Frame {
        Frame { size: (LEFT + RIGHT + 100.0, TOP + BOTTOM + 50.0), x: (0.0, 10.0), y: (-1.0, 1.0), x_unit: Some(" s") }
    }

    #[test]
    fn lines_go_where_their_points_are_and_break_at_holes() {
        let points = [(0.0, 1.0), (5.0, 0.0), (6.0, f64::NAN), (10.0, -1.0), (10.0, f64::INFINITY)];
        assert_eq!(frame().line(points.into_iter()), "M0.0 0.0L50.0 25.0M100.0 50.0");
    }

    #[test]
    fn a_chart_has_its_numbers_and_escapes_its_words() {
        let text = frame().draw("<b> & \"quotes\"", &html! {}).into_string();
        assert!(text.contains("−1.0") && text.contains("10 s") && text.contains("&lt;b&gt;"), "{text}");
    }

    #[test]
    fn ranges_are_never_empty() {
        assert_eq!(range_of([f64::NAN].into_iter(), 0.1), (-1.0, 1.0));
        let (low, high) = range_of([3.0, 3.0].into_iter(), 0.1);
        assert!(low < 3.0 && high > 3.0);
    }
}
