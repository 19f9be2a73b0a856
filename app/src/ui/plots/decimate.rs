//! Thinning to extremes: every pixel column keeps its minimum and maximum, so no spike is lost.

use super::levels::Samples;
use egui_plot::PlotPoint;
use estimator::log::pyramid::Pyramid;
use std::ops::Range;

/// Number of pyramid blocks per column from which column edges are moved to block edges.
const BLOCKS_IN_A_COLUMN: usize = 10;

/// Samples of a time span, assigned to pixel columns. They are found once for all curves of a recording.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// Drawn samples: those inside, and one neighbour on either side, so that lines continue to the edge.
    samples: Range<usize>,
    /// End (one past the last sample) and centre time of each column that has samples; empty where every sample is
    /// drawn.
    ends: Vec<(usize, f64)>,
}

impl Columns {
    /// `count` columns between two times. Their edges coincide with the pyramid's block edges, as long as a column has
    /// many blocks. No sample then needs to be read, and no edge moves by more than a tenth of a pixel.
    pub fn new(times: &[f64], from: f64, to: f64, count: usize) -> Self {
        let n = times.len();
        let first = times.partition_point(|t| *t < from).saturating_sub(1);
        let end = (times.partition_point(|t| *t <= to) + 1).min(n);
        Self::within(times, first..end, count)
    }

    /// Like [`new`](Self::new), for samples whose range is known.
    pub fn within(times: &[f64], samples: Range<usize>, count: usize) -> Self {
        let Range { start: first, end } = samples;
        let count = count.max(1);
        if end <= first || end - first <= 3 * count {
            return Self { samples: first..end.max(first), ends: Vec::new() };
        }
        let grain = Pyramid::grain((end - first) / count / BLOCKS_IN_A_COLUMN);
        let (start, width) = (times[first], (times[end - 1] - times[first]) / count as f64);
        let mut ends = Vec::with_capacity(count);
        let (mut at, mut usual) = (first, (end - first) / count);
        for column in 1..=count {
            let limit = start + width * column as f64;
            let exact = if column == count { end } else { step_to(&times[..end], at, usual, limit) };
            let many = exact - at >= BLOCKS_IN_A_COLUMN * grain && column < count;
            let next = if many { exact / grain * grain } else { exact };
            if next > at {
                ends.push((next, 0.5 * (times[at] + times[next - 1])));
                (usual, at) = (next - at, next);
            }
        }
        Self { samples: first..end, ends }
    }
}

/// First sample from `at` on that is not before `limit`. The search starts `usual` samples ahead and widens, because
/// clocks are nearly even.
fn step_to(times: &[f64], at: usize, usual: usize, limit: f64) -> usize {
    // Every sample before `low` is before the limit; none from `high` on is.
    let (mut low, mut high, mut step) = (at, times.len(), 1);
    let guess = (at + usual).min(high);
    if guess < high && times[guess] < limit {
        low = guess + 1;
        while low + step < high {
            if times[low + step] >= limit {
                high = low + step;
                break;
            }
            (low, step) = (low + step + 1, 2 * step);
        }
    } else {
        high = guess;
        while low + step < high {
            if times[high - step] < limit {
                low = high - step + 1;
                break;
            }
            (high, step) = (high - step, 2 * step);
        }
    }
    low + times[low..high].partition_point(|t| *t < limit)
}

/// Curve between two times in at most two points per column (plus the neighbours outside, so that lines continue to the
/// edge).
pub fn decimate(times: &[f64], levels: Samples<'_>, from: f64, to: f64, columns: usize) -> Vec<PlotPoint> {
    decimate_in(times, levels, &Columns::new(times, from, to, columns))
}

/// [`decimate`] into known columns.
pub fn decimate_in(times: &[f64], levels: Samples<'_>, columns: &Columns) -> Vec<PlotPoint> {
    let n = times.len().min(levels.len());
    let (first, end) = (columns.samples.start, columns.samples.end.min(n));
    if end <= first {
        return Vec::new();
    }
    let sample = |i: usize| PlotPoint::new(times[i], levels.value(i));
    if columns.ends.is_empty() {
        return (first..end).map(sample).collect();
    }
    let mut points = Vec::with_capacity(2 * columns.ends.len() + 2);
    points.push(sample(first));
    let (mut at, mut before) = (first, levels.value(first));
    for (next, middle) in &columns.ends {
        let next = (*next).min(end);
        let (low, high) = levels.range(at, next);
        at = next;
        // No sample of this column is a number.
        if low > high {
            continue;
        }
        // The nearer end first, so that slopes stay slopes.
        let (a, b) = if (before - low).abs() <= (before - high).abs() { (low, high) } else { (high, low) };
        points.push(PlotPoint::new(*middle, a));
        if b != a {
            points.push(PlotPoint::new(*middle, b));
        }
        before = b;
    }
    points.push(sample(end - 1));
    points
}

#[cfg(test)]
mod tests {
    use super::super::levels::Levels;
    use super::*;
    use haptics::recording::{Channel, Recording};

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
    fn columns_hold_every_sample_once_at_the_time_that_it_has() {
        // Uneven steps, a pause, and a burst.
        let mut now = 0.0;
        let times: Vec<f64> = (0..200_000)
            .map(|i| {
                now += if i == 70_000 {
                    30.0
                } else if i > 150_000 {
                    1e-5
                } else {
                    1e-3 + 4e-4 * f64::from(i).sin()
                };
                now
            })
            .collect();
        for (from, to, count) in [(0.0, now, 900), (10.0, 95.0, 300), (60.0, 200.0, 777)] {
            let columns = Columns::new(&times, from, to, count);
            let width = (times[columns.samples.end - 1] - times[columns.samples.start]) / count as f64;
            let mut at = columns.samples.start;
            for (next, middle) in &columns.ends {
                assert!(*next > at && times[at] <= *middle && *middle <= times[next - 1]);
                // A tenth of a column to either side; a column with few samples is exact.
                assert!(times[next - 1] - times[at] <= 1.25 * width, "{at}..{next} of {from} to {to}");
                at = *next;
            }
            assert_eq!(at, columns.samples.end);
            assert!(columns.ends.len() <= count);
        }
    }

    #[test]
    fn from_afar_no_sample_is_read() {
        let n = 3_000_000;
        let times: Vec<f64> = (0..n).map(|i| f64::from(i) * 1e-3).collect();
        let columns = Columns::new(&times, 0.0, 3_000.0, 1_500);
        let inside = &columns.ends[..columns.ends.len() - 1];
        assert!(inside.iter().all(|(end, _)| end % 16 == 0));
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
        // A recording that has been replaced since.
        assert!(decimate(&times, levels.samples(&Recording::default()), 0.0, 5e3, 20).is_empty());
    }
}
