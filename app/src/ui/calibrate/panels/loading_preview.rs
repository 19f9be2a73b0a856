//! A long log while it is being read: every column so far, drawn from the reader's preview.

use crate::text::format;
use crate::ui::background::jobs::Progress;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use egui::{Align2, FontId, Pos2, Rect, Sense, Shape, Stroke, Ui, pos2, vec2};
use estimator::log::preview::{Curve, Preview};
use estimator::log::pyramid::Band;
use render::ColorRole;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const LOG: &str = "Log";
}

/// Minimum height of a curve, points; columns beyond the available space are counted in a text.
const LEAST_HEIGHT: f32 = 34.0;
/// Width of the names on the left, points.
const NAMES: f32 = 150.0;

/// Draws the part read so far. The curves grow from left to right with the progress.
pub fn incoming(ui: &mut Ui, preview: &Preview, progress: &Progress) {
    let share = progress.share.unwrap_or(1.0).clamp(1e-3, 1.0);
    let pixels = (ui.available_width() * ui.pixels_per_point()) as usize;
    let curves = preview.curves(((pixels as f64 * share) as usize).max(16));
    let samples = curves.iter().map(|c| c.samples).max().unwrap_or(0);
    ui.horizontal(|ui| {
        ui.label(theme::heading(words::LOG));
        ui.add_space(space::S);
        let so_far = format!("{} samples so far; columns and units as in the file", format::grouped(samples));
        ui.label(theme::caption(ui, so_far));
    });
    ui.add_space(space::S);
    let room = ui.available_height();
    let rows = curves.len().min((room / LEAST_HEIGHT) as usize).max(1);
    let more = curves.len().saturating_sub(rows);
    let height = ((room - if more > 0 { 20.0 } else { 4.0 }) / rows as f32).clamp(LEAST_HEIGHT * 0.8, 120.0);
    ui.spacing_mut().item_spacing.y = 0.0;
    for (index, curve) in curves.iter().take(rows).enumerate() {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        draw(ui, rect, curve, share, index);
    }
    if more > 0 {
        ui.label(theme::caption(ui, format!("and {more} more")));
    }
}

fn draw(ui: &Ui, rect: Rect, curve: &Curve, share: f64, index: usize) {
    let p = palette(ui);
    let (names, area) = rect.split_left_right_at_x(rect.left() + NAMES);
    let painter = ui.painter().with_clip_rect(names.with_max_x(names.right() - space::S));
    painter.text(names.left_center(), Align2::LEFT_CENTER, &curve.name, FontId::proportional(12.5), p.text);
    ui.painter().hline(rect.x_range(), rect.bottom(), Stroke::new(1.0, p.border));
    let Some(map) = Map::of(curve, area.shrink2(vec2(0.0, 3.0)), share) else { return };
    let color = theme::role(ui.visuals().dark_mode, ColorRole::Block(index));
    ui.painter().add(Shape::line(map.line(&curve.points), Stroke::new(1.2, color)));
}

/// Map from the curve's times and values to the screen.
struct Map {
    area: Rect,
    /// First time, and points per unit of time.
    time: (f64, f64),
    /// Minimum value, and points per unit of value.
    value: (f64, f64),
}

impl Map {
    fn of(curve: &Curve, area: Rect, share: f64) -> Option<Self> {
        let (first, last) = (curve.points.first()?.0, curve.points.last()?.0);
        let all = |pick: fn(&Band) -> f64, join: fn(f64, f64) -> f64| {
            curve.points.iter().map(|(_, band)| pick(band)).reduce(join).unwrap_or(0.0)
        };
        let (low, high) = (all(|b| b.low, f64::min), all(|b| b.high, f64::max));
        let per = |room: f32, length: f64| if length > 0.0 { f64::from(room) / length } else { 0.0 };
        Some(Self {
            area,
            time: (first, share * per(area.width(), last - first)),
            value: (low, per(area.height(), high - low)),
        })
    }

    fn at(&self, time: f64, value: f64) -> Pos2 {
        let x = f64::from(self.area.left()) + (time - self.time.0) * self.time.1;
        // A constant value is drawn through the middle.
        let up = if self.value.1 > 0.0 {
            (value - self.value.0) * self.value.1
        } else {
            0.5 * f64::from(self.area.height())
        };
        pos2(x as f32, self.area.bottom() - up as f32)
    }

    /// Line through the lower and upper end of every band, in the order that starts nearer to the line's current end.
    fn line(&self, points: &[(f64, Band)]) -> Vec<Pos2> {
        let mut line: Vec<Pos2> = Vec::with_capacity(2 * points.len());
        for (time, band) in points {
            let (low, high) = (self.at(*time, band.low), self.at(*time, band.high));
            let upward = line.last().is_none_or(|p| (p.y - low.y).abs() <= (p.y - high.y).abs());
            line.extend(if upward { [low, high] } else { [high, low] });
        }
        line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: Vec<(f64, Band)>) -> Curve {
        Curve { name: "x1_m".to_owned(), samples: 10, by_row: false, points }
    }

    #[test]
    fn curves_fill_their_share_of_the_width_and_all_of_the_height() {
        let area = Rect::from_min_max(pos2(100.0, 10.0), pos2(300.0, 60.0));
        let band = |low, high| Band { low, high };
        let curve = curve(vec![(2.0, band(-1.0, 0.0)), (3.0, band(0.0, 4.0)), (4.0, band(-2.0, 1.0))]);
        let map = Map::of(&curve, area, 0.5).expect("points");
        let line = map.line(&curve.points);
        assert_eq!((line.len(), line[0].x, line[5].x), (6, 100.0, 200.0));
        let (top, bottom) = line.iter().fold((f32::MAX, f32::MIN), |(t, b), p| (t.min(p.y), b.max(p.y)));
        assert_eq!((top, bottom), (10.0, 60.0));
        // From the first band's upper end into the second at its lower one, which is the same value.
        assert_eq!(line[1].y, line[2].y);
    }

    #[test]
    fn nothing_and_constants_are_harmless() {
        let area = Rect::from_min_max(pos2(0.0, 0.0), pos2(10.0, 10.0));
        assert!(Map::of(&curve(vec![]), area, 1.0).is_none());
        let flat = curve(vec![(0.0, Band { low: 3.0, high: 3.0 })]);
        let map = Map::of(&flat, area, 1.0).expect("a point");
        assert_eq!(map.line(&flat.points)[0], pos2(0.0, 5.0));
    }
}
