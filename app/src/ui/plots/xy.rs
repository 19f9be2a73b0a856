//! One signal against another, coloured by state or time, with the cursor's point.

use super::axes::{AXIS_WIDTH, still_plot, variable_axis};
use super::choices::XyColor;
use super::levels::{Levels, Samples};
use crate::ui::document::prepared::Prepared;
use crate::ui::kit::theme;
use crate::ui::kit::theme::palette;
use crate::ui::plots::time_plot::axis_height;
use egui::{Color32, Pos2, Sense, Stroke, Ui, Vec2};
use egui_plot::{Line, PlotBounds, PlotPoint, PlotPoints, PlotTransform};
use estimator::segment::Segmentation;
use std::ops::Range;
use std::sync::Arc;

/// Maximum number of points of a curve, several per pixel.
const MOST_POINTS: usize = 8_000;
/// Maximum number of samples read for them; longer recordings are read at a stride. The first number applies while the
/// view changes with every frame, the second once it rests.
const MOST_SAMPLES: [usize; 2] = [120_000, 600_000];
/// Number of shades that encode time.
const SHADES: usize = 48;

/// Input of an XY plot.
pub struct XyInput<'a> {
    /// The shown recording.
    pub prepared: &'a Arc<Prepared>,
    /// Values of the horizontal axis.
    pub x: &'a Arc<Levels>,
    /// Unit of the horizontal axis.
    pub x_unit: &'a str,
    /// Values of the vertical axis.
    pub y: &'a Arc<Levels>,
    /// Unit of the vertical axis.
    pub y_unit: &'a str,
    /// Quantity that colour encodes.
    pub color: XyColor,
    /// States of the recording.
    pub segmentation: Option<&'a Segmentation>,
    /// Time range drawn in colour, s.
    pub view_s: (f64, f64),
    /// Time of the cursor, s.
    pub cursor_s: f64,
}

/// Thinned curves, kept while nothing changes.
#[derive(Default)]
pub struct XyCache {
    whole: Option<Whole>,
    view: Option<View>,
}

struct Whole {
    of: (Arc<Levels>, Arc<Levels>),
    points: Vec<PlotPoint>,
}

struct View {
    of: (Arc<Levels>, Arc<Levels>),
    shown_s: (f64, f64),
    samples: Vec<usize>,
    points: Vec<PlotPoint>,
    /// True if further refinement would show nothing more.
    is_settled: bool,
}

fn same(a: &(Arc<Levels>, Arc<Levels>), b: &(Arc<Levels>, Arc<Levels>)) -> bool {
    Arc::ptr_eq(&a.0, &b.0) && Arc::ptr_eq(&a.1, &b.1)
}

impl XyCache {
    /// Updates the cache. Returns true if the next frame will show more.
    fn update(&mut self, input: &XyInput<'_>) -> bool {
        let of = (Arc::clone(input.x), Arc::clone(input.y));
        let recording = &input.prepared.recording;
        let (x, y) = (input.x.samples(recording), input.y.samples(recording));
        let point = |i: usize| PlotPoint::new(x.value(i), y.value(i));
        let times = &input.prepared.times;
        if !self.whole.as_ref().is_some_and(|whole| same(&whole.of, &of)) {
            let samples = thin(&x, &y, 0..times.len(), MOST_SAMPLES[1]);
            self.whole = Some(Whole { of: of.clone(), points: samples.into_iter().map(point).collect() });
        }
        let is_same = |view: &&View| same(&view.of, &of) && view.shown_s == input.view_s;
        let stays = self.view.as_ref().filter(is_same);
        if stays.is_some_and(|view| view.is_settled) {
            return false;
        }
        let most = MOST_SAMPLES[usize::from(stays.is_some())];
        let (from, to) = input.view_s;
        let range = times.partition_point(|t| *t < from)..times.partition_point(|t| *t <= to);
        let is_settled = stays.is_some() || range.len() <= most;
        let samples = thin(&x, &y, range, most);
        let points = samples.iter().map(|i| point(*i)).collect();
        self.view = Some(View { of, shown_s: input.view_s, samples, points, is_settled });
        !is_settled
    }
}

/// Samples that a curve in the plane needs: the extremes of every segment in each direction.
fn thin(x: &Samples<'_>, y: &Samples<'_>, range: Range<usize>, most: usize) -> Vec<usize> {
    let range = range.start.min(x.len())..range.end.min(x.len()).min(y.len());
    let is_number = |i: &usize| x.value(*i).is_finite() && y.value(*i).is_finite();
    if range.len() <= MOST_POINTS {
        return range.filter(is_number).collect();
    }
    let step = range.len().div_ceil(most);
    let stretch = range.len().div_ceil(MOST_POINTS / 4);
    let mut kept = Vec::with_capacity(MOST_POINTS + 4);
    for first in range.clone().step_by(stretch) {
        let mut found: Option<[(usize, f64); 4]> = None;
        for i in (first..range.end.min(first + stretch)).step_by(step).filter(is_number) {
            let (a, b) = (x.value(i), y.value(i));
            let extremes = found.get_or_insert([(i, a), (i, a), (i, b), (i, b)]);
            for (extreme, (value, sign)) in extremes.iter_mut().zip([(a, -1.0), (a, 1.0), (b, -1.0), (b, 1.0)]) {
                if sign * value > sign * extreme.1 {
                    *extreme = (i, value);
                }
            }
        }
        let Some(found) = found else { continue };
        let mut samples = found.map(|(i, _)| i);
        samples.sort_unstable();
        kept.extend(samples.iter().enumerate().filter(|(k, i)| *k == 0 || samples[k - 1] != **i).map(|(_, i)| *i));
    }
    kept
}

/// Draws the plot at `size`. Returns the time to which the user moved the cursor, s.
pub fn xy_plot(ui: &mut Ui, cache: &mut XyCache, input: &XyInput<'_>, size: Vec2) -> Option<f64> {
    if cache.update(input) {
        ui.ctx().request_repaint();
    }
    let (p, dark) = (palette(ui), ui.visuals().dark_mode);
    let (Some(whole), Some(view)) = (&cache.whole, &cache.view) else { return None };
    let area = Vec2::new(size.x - AXIS_WIDTH, size.y - axis_height());
    let bounds = bounds(&whole.points, input.x_unit == input.y_unit && is_length(input.x_unit), area);
    let runs = runs(input, view, dark);
    let plot = still_plot("xy", p, size.y, 8.0, 130.0)
        .width(size.x)
        .show_axes([true, true])
        .sense(Sense::click_and_drag())
        .custom_x_axes(vec![variable_axis(p, "")]);
    let response = plot.show(ui, |plot| {
        plot.set_plot_bounds(bounds);
        let context = Line::new("", PlotPoints::Borrowed(&whole.points));
        plot.line(context.color(p.border).width(1.0).allow_hover(false));
        for (range, color) in &runs {
            let line = Line::new("", PlotPoints::Borrowed(&view.points[range.clone()]));
            plot.line(line.color(*color).width(1.6).allow_hover(false));
        }
    });
    let recording = &input.prepared.recording;
    let sample = input.prepared.sample_at(input.cursor_s);
    let at = PlotPoint::new(input.x.samples(recording).value(sample), input.y.samples(recording).value(sample));
    if at.x.is_finite() && at.y.is_finite() {
        let painter = ui.painter().with_clip_rect(*response.transform.frame());
        let place = response.transform.position_from_point(&at);
        painter.circle(place, 5.5, p.accent, Stroke::new(2.0, p.card));
    }
    let pointer = response.response.interact_pointer_pos()?;
    let pressed = response.response.is_pointer_button_down_on() && ui.input(|i| i.pointer.primary_down());
    pressed
        .then(|| nearest(&response.transform, view, pointer))
        .flatten()
        .and_then(|i| input.prepared.times.get(i).copied())
}

/// Drawn sample nearest to a screen position.
fn nearest(transform: &PlotTransform, view: &View, at: Pos2) -> Option<usize> {
    let far = |point: &PlotPoint| transform.position_from_point(point).distance_sq(at);
    let distances = view.points.iter().map(far).zip(&view.samples);
    distances.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, sample)| *sample)
}

/// True if the unit is a length, so that equal axes show a true shape.
fn is_length(unit: &str) -> bool {
    matches!(unit, "mm" | "m")
}

/// Bounds of all points with a margin, for an `area` in points; `equal` axes show a circle as a circle.
fn bounds(points: &[PlotPoint], equal: bool, area: Vec2) -> PlotBounds {
    let range = |of: fn(&PlotPoint) -> f64| {
        let (low, high) = points.iter().map(of).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return (-1.0, 1.0);
        }
        let air = (0.06 * (high - low)).max(1e-6 * low.abs().max(high.abs())).max(1e-9);
        (low - air, high + air)
    };
    let (mut x, mut y) = (range(|p| p.x), range(|p| p.y));
    if equal {
        let (width, height) = (f64::from(area.x.max(1.0)), f64::from(area.y.max(1.0)));
        let scale = ((x.1 - x.0) / width).max((y.1 - y.0) / height);
        let widened = |(low, high): (f64, f64), points: f64| {
            let (middle, half) = (0.5 * (low + high), 0.5 * scale * points);
            (middle - half, middle + half)
        };
        (x, y) = (widened(x, width), widened(y, height));
    }
    PlotBounds::from_min_max([x.0, y.0], [x.1, y.1])
}

/// Runs of the curve in one colour each; neighbours share a point.
fn runs(input: &XyInput<'_>, view: &View, dark: bool) -> Vec<(Range<usize>, Color32)> {
    let times = &input.prepared.times;
    let states = input.segmentation.map_or(&[][..], |s| s.states.as_slice());
    let (from, to) = input.view_s;
    let plain = theme::role(dark, render::ColorRole::Measured);
    let shade = |time: f64| ((time - from) / (to - from) * SHADES as f64).clamp(0.0, SHADES as f64 - 1.0) as usize;
    let color_of = |sample: usize| {
        let time = times[sample];
        match input.color {
            XyColor::Time => theme::time_color(dark, shade(time) as f32 / (SHADES - 1) as f32),
            XyColor::State => {
                let place = states.partition_point(|i| i.t0 <= time).checked_sub(1);
                place.and_then(|k| states.get(k)).map_or(plain, |i| theme::state_ink(dark, i.state))
            }
        }
    };
    let mut found: Vec<(Range<usize>, Color32)> = Vec::new();
    for (k, sample) in view.samples.iter().enumerate() {
        let color = color_of(*sample);
        match found.last_mut() {
            Some((range, same)) => {
                range.end = k + 1;
                if *same != color {
                    found.push((k..k + 1, color));
                }
            }
            None => found.push((k..k + 1, color)),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::{Channel, Recording};

    #[test]
    fn thinning_keeps_what_is_farthest_to_each_side() {
        let n = 300_000;
        let turn = |i: usize| i as f64 * 1e-3;
        let mut x: Vec<f64> = (0..n).map(|i| turn(i).cos()).collect();
        let mut y: Vec<f64> = (0..n).map(|i| turn(i).sin()).collect();
        (x[1_234], y[77_777], x[200_001], y[299_998]) = (5.0, -6.0, -7.0, 8.0);
        y[150_000] = f64::NAN;
        let (x, y, none) = (Levels::new(x), Levels::new(y), Recording::default());
        let kept = thin(&x.samples(&none), &y.samples(&none), 0..n, n);
        assert!(kept.len() <= MOST_POINTS + 4, "{}", kept.len());
        assert!([1_234, 77_777, 200_001, 299_998].iter().all(|i| kept.contains(i)));
        assert!(!kept.contains(&150_000) && kept.windows(2).all(|w| w[0] < w[1]));
        assert_eq!(thin(&x.samples(&none), &y.samples(&none), 10..2_000, 100).len(), 1_990);
    }

    #[test]
    fn a_view_that_stays_is_looked_at_longer() {
        let n = 400_000;
        let channel = |name: &str, values: Vec<f64>| Channel { name: name.into(), unit: "m".into(), values };
        let mut x: Vec<f64> = (0..n).map(|i| (f64::from(i) * 1e-3).cos()).collect();
        // A sample that a stride of four skips.
        x[200_001] = 3.0;
        let y = (0..n).map(|i| (f64::from(i) * 1e-3).sin()).collect();
        let recording = Recording { channels: vec![channel("x_m", x), channel("y_m", y)], ..Recording::default() };
        let prepared = Arc::new(Prepared::new(recording));
        let traces = &prepared.groups[0].traces;
        let mut input = XyInput {
            prepared: &prepared,
            x: &traces[0].levels,
            x_unit: "mm",
            y: &traces[1].levels,
            y_unit: "mm",
            color: XyColor::Time,
            segmentation: None,
            view_s: (0.0, 399_999.0),
            cursor_s: 0.0,
        };
        let mut cache = XyCache::default();
        let has_spike = |cache: &XyCache| cache.view.as_ref().is_some_and(|v| v.samples.contains(&200_001));
        assert!(cache.update(&input) && !has_spike(&cache), "at first only every fourth sample");
        assert!(!cache.update(&input) && has_spike(&cache), "then every one");
        assert!(!cache.update(&input) && has_spike(&cache), "and that stays");
        input.view_s = (200_000.0, 200_100.0);
        assert!(!cache.update(&input) && has_spike(&cache), "few are all looked at");
    }

    #[test]
    fn lengths_have_equal_axes() {
        let points = [PlotPoint::new(0.0, 0.0), PlotPoint::new(10.0, 2.0)];
        let b = bounds(&points, true, Vec2::new(400.0, 200.0));
        assert!((b.width() / 400.0 - b.height() / 200.0).abs() < 1e-12);
        assert!(b.min()[0] < 0.0 && b.max()[0] > 10.0 && b.min()[1] < 0.0 && b.max()[1] > 2.0);
        let b = bounds(&points, false, Vec2::new(400.0, 200.0));
        assert!(b.height() < 3.0);
    }
}
