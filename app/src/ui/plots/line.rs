//! A thinned curve as a plot item: the same shapes as [`egui_plot::Line`], for a third of the time.
//!
//! Long logs put tens of thousands of points into every frame. The general item computes each screen position twice,
//! with a division; this one computes each once, with a multiplication.

use egui::epaint::{BandPoint, BandShape};
use egui::{Color32, Pos2, Rect, Shape, Stroke, Ui, pos2};
use egui_plot::{PlotBounds, PlotGeometry, PlotItem, PlotItemBase, PlotPoint, PlotTransform};
use std::ops::RangeInclusive;

/// Points closer together than this form one column of a band, points.
const COLUMN: f32 = 1.0;

/// Points in the order of time, joined by lines.
pub struct ThinnedLine<'a> {
    base: PlotItemBase,
    points: &'a [PlotPoint],
    stroke: Stroke,
}

impl<'a> ThinnedLine<'a> {
    /// Line through points whose times never decrease.
    pub fn new(points: &'a [PlotPoint], width: f32, color: Color32) -> Self {
        Self { base: PlotItemBase::new(String::new()), points, stroke: Stroke::new(width, color) }
    }
}

impl PlotItem for ThinnedLine<'_> {
    fn shapes(&self, ui: &Ui, transform: &PlotTransform, shapes: &mut Vec<Shape>) {
        let screen = Screen::of(transform);
        let places: Vec<Pos2> = self.points.iter().map(|p| screen.place(p)).collect();
        for run in visible(&places, ui.clip_rect()) {
            match run {
                [] => {}
                [one] => shapes.push(Shape::circle_filled(*one, 0.5 * self.stroke.width, self.stroke.color)),
                _ => shapes.push(shape(run, self.stroke)),
            }
        }
    }

    fn initialize(&mut self, _: RangeInclusive<f64>) {}

    fn color(&self) -> Color32 {
        self.stroke.color
    }

    fn allow_hover(&self) -> bool {
        false
    }

    fn geometry(&self) -> PlotGeometry<'_> {
        PlotGeometry::None
    }

    fn bounds(&self) -> PlotBounds {
        // The rows set their bounds themselves.
        PlotBounds::NOTHING
    }

    fn base(&self) -> &PlotItemBase {
        &self.base
    }

    fn base_mut(&mut self) -> &mut PlotItemBase {
        &mut self.base
    }
}

/// Map from values to the screen: position = edge + (value − lowest) × scale, so that a value on an edge stays there.
struct Screen {
    edge: [f64; 2],
    lowest: [f64; 2],
    scale: [f64; 2],
}

impl Screen {
    fn of(transform: &PlotTransform) -> Self {
        let (frame, bounds) = (transform.frame(), transform.bounds());
        let (lowest, highest) = (bounds.min(), bounds.max());
        let ends = [[frame.left(), frame.right()], [frame.bottom(), frame.top()]].map(|ends| ends.map(f64::from));
        let scale = [0, 1].map(|k| (ends[k][1] - ends[k][0]) / (highest[k] - lowest[k]));
        Self { edge: ends.map(|ends| ends[0]), lowest, scale }
    }

    fn place(&self, point: &PlotPoint) -> Pos2 {
        let at = |k: usize, value: f64| (self.edge[k] + (value - self.lowest[k]) * self.scale[k]) as f32;
        pos2(at(0, point.x), at(1, point.y))
    }
}

/// Runs of points whose line segments reach the visible area. A non-finite point interrupts the line.
fn visible(places: &[Pos2], clip: Rect) -> impl Iterator<Item = &[Pos2]> {
    let alone = (places.len() == 1 && clip.contains(places[0])).then_some(places);
    let mut at = 0;
    let runs = std::iter::from_fn(move || {
        let is_seen = |k: usize| {
            let (a, b) = (places[k], places[k + 1]);
            // Nearly all have one end inside.
            (clip.contains(a) && b.is_finite())
                || (a.is_finite() && b.is_finite() && clip.intersects(Rect::from_two_pos(a, b)))
        };
        let lines = places.len().saturating_sub(1);
        let first = (at..lines).find(|k| is_seen(*k))?;
        let end = (first..lines).find(|k| !is_seen(*k)).unwrap_or(lines);
        at = end;
        Some(&places[first..=end])
    });
    alone.into_iter().chain(runs)
}

/// A line, or a band where columns have several points.
fn shape(run: &[Pos2], stroke: Stroke) -> Shape {
    if run.is_sorted_by(|a, b| a.x <= b.x) {
        let columns = columns(run, stroke.width);
        if columns.len() > 1 && columns.len() < run.len() {
            return BandShape::filled(columns, stroke.color).into();
        }
    }
    Shape::line(run.to_vec(), stroke)
}

/// Band from the lowest to the highest point of each column, widened by half the line width to either side. All points
/// must be finite.
fn columns(run: &[Pos2], width: f32) -> Vec<BandPoint> {
    let mut columns: Vec<BandPoint> = Vec::with_capacity(run.len());
    let Some((first, others)) = run.split_first() else { return columns };
    let reach = 0.5 * width;
    let band = |x: f32, low: f32, high: f32| BandPoint::new(x, low - reach..=high + reach);
    // The first column is drawn at its start, the others at their centre.
    let (mut x, mut low, mut high, mut middle) = (first.x, first.y, first.y, 0.0);
    for place in others {
        if place.x - x <= COLUMN {
            low = if place.y < low { place.y } else { low };
            high = if place.y > high { place.y } else { high };
        } else {
            columns.push(band(x + middle, low, high));
            (x, low, high, middle) = (place.x, place.y, place.y, 0.5 * COLUMN);
        }
    }
    // The last column is drawn at its end.
    columns.push(band(run[run.len() - 1].x, low, high));
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::epaint::{ClippedShape, Primitive};
    use egui_plot::{Line, Plot, PlotPoints};

    fn picture(points: &[PlotPoint], x: (f64, f64), ours: bool) -> Vec<ClippedShape> {
        let ctx = egui::Context::default();
        let input = egui::RawInput {
            screen_rect: Some(Rect::from_min_size(Pos2::ZERO, egui::vec2(600.0, 400.0))),
            ..egui::RawInput::default()
        };
        let draw = || {
            ctx.run_ui(input.clone(), |ui| {
                Plot::new("plot").show_axes(false).show_grid(false).show(ui, |plot| {
                    plot.set_plot_bounds(PlotBounds::from_min_max([x.0, -1.5], [x.1, 1.0]));
                    if ours {
                        plot.add(ThinnedLine::new(points, 1.5, Color32::RED));
                    } else {
                        let line = Line::new("", PlotPoints::Borrowed(points)).width(1.5).color(Color32::RED);
                        plot.line(line.allow_hover(false));
                    }
                });
            })
        };
        // The first frame settles the layout. There is no GPU to receive the font texture.
        draw().textures_delta.clear();
        let mut output = draw();
        output.textures_delta.clear();
        output.shapes
    }

    fn vertices(shapes: Vec<ClippedShape>) -> Vec<(Pos2, Color32)> {
        let mut tessellator =
            egui::epaint::Tessellator::new(1.0, egui::epaint::TessellationOptions::default(), [1, 1], Vec::new());
        let all = tessellator.tessellate_shapes(shapes);
        all.into_iter()
            .flat_map(|clipped| match clipped.primitive {
                Primitive::Mesh(mesh) => mesh.vertices,
                Primitive::Callback(_) => Vec::new(),
            })
            .map(|vertex| (vertex.pos, vertex.color))
            .collect()
    }

    fn dense(n: usize) -> Vec<PlotPoint> {
        let wave = |t: f64, i: usize| (40.0 * t).sin() * 1.7 + 0.2 * (i as f64 * 2.1).sin();
        (0..n).map(|i| (i as f64 / n as f64, i)).map(|(t, i)| PlotPoint::new(t, wave(t, i))).collect()
    }

    #[test]
    fn it_draws_what_the_general_line_draws() {
        for points in [dense(4000), dense(50), dense(1), dense(0)] {
            // Wider than the curve, a part of it, and beside it.
            for x in [(-0.2, 1.3), (0.31, 0.37), (0.0, 0.9), (2.0, 3.0)] {
                let [ours, general] = [true, false].map(|ours| vertices(picture(&points, x, ours)));
                assert_eq!(ours.len(), general.len(), "{} points, {x:?}", points.len());
                for ((a, one), (b, other)) in ours.iter().zip(&general) {
                    assert!(one == other && (*a - *b).length() < 1e-2, "{a:?} {b:?}, {x:?}");
                }
            }
        }
    }

    #[test]
    fn a_gap_breaks_the_line() {
        let mut points = dense(300);
        points[120].y = f64::NAN;
        let drawn = vertices(picture(&points, (0.0, 1.0), true));
        assert!(drawn.len() > 300 && drawn.iter().all(|(place, _)| place.is_finite()));
    }
}
