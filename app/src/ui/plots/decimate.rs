//! Thinning to extremes: every pixel column keeps its smallest and its largest value, so no spike is lost.

use egui_plot::PlotPoint;

/// Samples in a block whose extremes are known beforehand.
const BLOCK: usize = 64;

/// Values with the extremes of every block: a column over a million samples looks at thousands of blocks, not at samples.
#[derive(Clone, Debug, Default)]
pub struct Levels {
    values: Vec<f64>,
    blocks: Vec<(f64, f64)>,
}

impl Levels {
    /// Prepares values.
    pub fn new(values: Vec<f64>) -> Self {
        let blocks = values.chunks(BLOCK).map(extremes).collect();
        Self { values, blocks }
    }

    /// A value; NaN outside.
    pub fn value(&self, sample: usize) -> f64 {
        self.values.get(sample).copied().unwrap_or(f64::NAN)
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// True when there is no sample.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Smallest and largest of `first..end`; (∞, −∞) when there is none.
    pub fn range(&self, first: usize, end: usize) -> (f64, f64) {
        let end = end.min(self.values.len());
        if first >= end {
            return (f64::INFINITY, f64::NEG_INFINITY);
        }
        let (inner_first, inner_end) = (first.div_ceil(BLOCK), end / BLOCK);
        if inner_first >= inner_end {
            return extremes(&self.values[first..end]);
        }
        let middle = self.blocks[inner_first..inner_end]
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let head = extremes(&self.values[first..inner_first * BLOCK]);
        let tail = extremes(&self.values[inner_end * BLOCK..end]);
        (middle.0.min(head.0).min(tail.0), middle.1.max(head.1).max(tail.1))
    }
}

fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}

/// The curve between two times in at most two points a column (plus the neighbours outside, so that lines run on).
pub fn decimate(times: &[f64], levels: &Levels, from: f64, to: f64, columns: usize) -> Vec<PlotPoint> {
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

    fn wave(n: usize) -> (Vec<f64>, Levels) {
        let times: Vec<f64> = (0..n).map(|i| i as f64 * 1e-3).collect();
        let mut values: Vec<f64> = times.iter().map(|t| (3.0 * t).sin()).collect();
        values[n / 2] = 7.0;
        (times, Levels::new(values))
    }

    #[test]
    fn no_spike_is_lost_and_no_more_points_than_pixels_need() {
        let (times, levels) = wave(1_000_000);
        let points = decimate(&times, &levels, 0.0, 1_000.0, 1_200);
        assert!(points.len() <= 2 * 1_200 + 2);
        let highest = points.iter().map(|p| p.y).fold(f64::MIN, f64::max);
        assert_eq!(highest, 7.0);
        assert!(points.windows(2).all(|w| w[0].x <= w[1].x));
    }

    #[test]
    fn close_up_every_sample_is_drawn() {
        let (times, levels) = wave(10_000);
        let points = decimate(&times, &levels, 2.0, 2.1, 1_200);
        assert_eq!(points.len(), 103, "a hundred and one samples and a neighbour on each side");
    }

    #[test]
    fn block_extremes_agree_with_a_plain_search() {
        let (_, levels) = wave(1_000);
        for (first, end) in [(0, 1_000), (3, 5), (63, 65), (64, 128), (100, 900), (999, 1_000), (5, 5)] {
            assert_eq!(levels.range(first, end), extremes(&levels.values[first..end]), "{first}..{end}");
        }
    }

    #[test]
    fn a_million_samples_take_milliseconds() {
        let (times, levels) = wave(1_000_000);
        let begun = std::time::Instant::now();
        for _ in 0..10 {
            std::hint::black_box(decimate(&times, &levels, 0.0, 1_000.0, 1_500));
        }
        // Unoptimised: under 10 ms each, measured 1 to 3; ten times that is a defect, not noise.
        assert!(begun.elapsed().as_secs_f64() < 1.0, "{:?}", begun.elapsed());
    }
}
