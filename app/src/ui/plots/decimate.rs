//! Thinning to extremes: every pixel column keeps its smallest and its largest value, so no spike is lost.

use egui_plot::PlotPoint;
use estimator::log::pyramid::{Band, Pyramid};
use haptics::recording::Recording;
use std::ops::Range;

/// One curve's values, or where they stand in the recording, with a pyramid of their extremes: a column of pixels over a million
/// samples looks at tens of blocks, not at samples.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    source: Source,
    /// Shown value = value × factor; positive.
    factor: f64,
    pyramid: Pyramid,
}

#[derive(Clone, Debug)]
enum Source {
    /// A channel of the recording, which holds the values already.
    Channel(usize),
    Own(Vec<f64>),
}

impl Default for Source {
    fn default() -> Self {
        Self::Own(Vec::new())
    }
}

impl Levels {
    /// Of values that nobody else holds, in the shown unit.
    pub fn new(values: Vec<f64>) -> Self {
        Self { pyramid: Pyramid::of(&values), source: Source::Own(values), factor: 1.0 }
    }

    /// Of channel `index` of a recording, whose `values` stay there; shown times `factor`.
    pub fn of_channel(index: usize, values: &[f64], factor: f64) -> Self {
        Self { pyramid: Pyramid::of(values), source: Source::Channel(index), factor }
    }

    /// The samples, to be drawn.
    pub fn samples<'a>(&'a self, recording: &'a Recording) -> Samples<'a> {
        let values = match &self.source {
            Source::Own(values) => values.as_slice(),
            Source::Channel(index) => recording.channels.get(*index).map_or(&[][..], |c| c.values.as_slice()),
        };
        Samples { values, levels: self }
    }
}

/// A curve's values with their pyramid.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    values: &'a [f64],
    levels: &'a Levels,
}

impl Samples<'_> {
    /// A value in the shown unit; NaN outside.
    pub fn value(&self, sample: usize) -> f64 {
        self.values.get(sample).map_or(f64::NAN, |v| v * self.levels.factor)
    }

    /// Smallest and largest of `first..end` in the shown unit; (∞, −∞) when there is none.
    fn range(&self, first: usize, end: usize) -> (f64, f64) {
        let read = |range: Range<usize>| Band::of(self.values.get(range).unwrap_or_default());
        let band = self.levels.pyramid.band(first..end, &read);
        band.map_or((f64::INFINITY, f64::NEG_INFINITY), |b| (b.low * self.levels.factor, b.high * self.levels.factor))
    }
}

/// The curve between two times in at most two points a column (plus the neighbours outside, so that lines run on).
pub fn decimate(times: &[f64], levels: Samples<'_>, from: f64, to: f64, columns: usize) -> Vec<PlotPoint> {
    let n = times.len().min(levels.values.len());
    let first = times[..n].partition_point(|t| *t < from).saturating_sub(1);
    let end = (times[..n].partition_point(|t| *t <= to) + 1).min(n);
    if end <= first {
        return Vec::new();
    }
    let columns = columns.max(1);
    if end - first <= 3 * columns {
        return (first..end).map(|i| PlotPoint::new(times[i], levels.value(i))).collect();
    }
    let mut points = Vec::with_capacity(2 * columns + 2);
    points.push(PlotPoint::new(times[first], levels.value(first)));
    let (start, width) = (times[first], (times[end - 1] - times[first]) / columns as f64);
    let mut at = first;
    for column in 1..=columns {
        let limit = start + width * column as f64;
        let next = if column == columns { end } else { at + times[at..end].partition_point(|t| *t < limit) };
        if next > at {
            let (low, high) = levels.range(at, next);
            let middle = 0.5 * (times[at] + times[next - 1]);
            // The order follows the curve, so that slopes stay slopes.
            let rising = levels.value(at) <= levels.value(next - 1);
            let (a, b) = if rising { (low, high) } else { (high, low) };
            points.push(PlotPoint::new(middle, a));
            points.push(PlotPoint::new(middle, b));
            at = next;
        }
    }
    points.push(PlotPoint::new(times[end - 1], levels.value(end - 1)));
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    fn wave(n: usize) -> (Vec<f64>, Levels) {
        let times: Vec<f64> = (0..n).map(|i| i as f64 * 1e-3).collect();
        let mut values: Vec<f64> = times.iter().map(|t| (3.0 * t).sin()).collect();
        values[n / 2] = 7.0;
        (times, Levels::new(values))
    }

    #[test]
    fn no_spike_is_lost_and_no_more_points_than_pixels_need() {
        let ((times, levels), none) = (wave(1_000_000), Recording::default());
        let points = decimate(&times, levels.samples(&none), 0.0, 1_000.0, 1_200);
        assert!(points.len() <= 2 * 1_200 + 2);
        let highest = points.iter().map(|p| p.y).fold(f64::MIN, f64::max);
        assert_eq!(highest, 7.0);
        assert!(points.windows(2).all(|w| w[0].x <= w[1].x));
    }

    #[test]
    fn close_up_every_sample_is_drawn() {
        let ((times, levels), none) = (wave(10_000), Recording::default());
        let points = decimate(&times, levels.samples(&none), 2.0, 2.1, 1_200);
        assert_eq!(points.len(), 103, "a hundred and one samples and a neighbour on each side");
    }

    #[test]
    fn a_channel_is_drawn_from_the_recording_in_its_shown_unit() {
        let values: Vec<f64> = (0..5_000).map(|i| f64::from(i % 100) * 1e-3).collect();
        let times: Vec<f64> = (0..5_000).map(f64::from).collect();
        let levels = Levels::of_channel(1, &values, 1000.0);
        let channel = |values: Vec<f64>| Channel { name: String::new(), unit: "m".to_owned(), values };
        let recording = Recording { channels: vec![channel(vec![]), channel(values)], ..Recording::default() };
        let samples = levels.samples(&recording);
        assert_eq!((samples.value(42), samples.range(0, 5_000), samples.range(3, 7)), (42.0, (0.0, 99.0), (3.0, 6.0)));
        assert!(samples.value(5_000).is_nan() && samples.range(7, 7).0.is_infinite());
        assert!(decimate(&times, samples, 0.0, 5e3, 20).iter().all(|p| (0.0..=99.0).contains(&p.y)));
        // A recording that is another one by now.
        assert!(decimate(&times, levels.samples(&Recording::default()), 0.0, 5e3, 20).is_empty());
    }
}
