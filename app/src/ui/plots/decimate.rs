//! Thinning to extremes: every pixel column keeps its smallest and its largest value, so no spike is lost.

use super::levels::Samples;
use egui_plot::PlotPoint;

/// The curve between two times in at most two points a column (plus the neighbours outside, so that lines run on).
pub fn decimate(times: &[f64], levels: Samples<'_>, from: f64, to: f64, columns: usize) -> Vec<PlotPoint> {
    let n = times.len().min(levels.len());
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
            if low > high {
                // Nothing in this column is a number.
                at = next;
                continue;
            }
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
