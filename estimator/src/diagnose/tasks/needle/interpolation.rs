//! Motion between the rows of a hole, for reversals within a row and for laws with memory.

use crate::diagnose::data::interpolation::{FINE_HZ, mean_step_s};
use crate::diagnose::data::regression_data::{Fine, Span, Weighing};
use foundation::signal::task::Smoothed;
use std::ops::Range;

/// Points in the holes of a recording.
pub struct Between {
    pub points: Vec<Fine>,
    /// Index of the point at every so many samples; `None` outside of holes.
    of: Vec<Option<usize>>,
    every: usize,
    half: usize,
}

impl Between {
    /// `half`: half width of a row's mean, in samples; rows are twice as many apart. `in_hole`: flag of each sample.
    pub fn new(time_s: &[f64], depth: &Smoothed, surface_m: f64, in_hole: &[bool], half: usize) -> Self {
        let step_s = mean_step_s(time_s);
        // Rows coincide with points, so the points are symmetric about each row.
        let most = (1.0 / (FINE_HZ * step_s.max(1e-9))) as usize;
        let every = (1..=most.max(1)).rev().find(|every| (2 * half).is_multiple_of(*every)).unwrap_or(1);
        let mut points = Vec::new();
        let mut of = vec![None; time_s.len() / every + 1];
        for (stretch, run) in runs(in_hole, half).into_iter().enumerate() {
            for i in run.filter(|i| i.is_multiple_of(every)) {
                of[i / every] = Some(points.len());
                points.push(Fine {
                    segment: stretch,
                    time_s: time_s[i] - time_s[0],
                    position: depth.value[i] - surface_m,
                    velocity: depth.slope[i],
                    ..Fine::default()
                });
            }
        }
        Self { points, of, every, half }
    }

    /// Points over which the row at a sample is averaged; empty if some are missing.
    pub fn span(&self, i: usize) -> Span {
        let (middle, reach) = (i / self.every, self.half / self.every);
        let at = |k: Option<usize>| k.and_then(|k| self.of.get(k).copied().flatten());
        match (at(middle.checked_sub(reach)), at(middle.checked_add(reach))) {
            (Some(start), Some(last)) if last == start + 2 * reach => {
                Span { start, len: 2 * reach + 1, weighing: Weighing::Parabola }
            }
            _ => Span::default(),
        }
    }
}

/// Segments of samples in a hole, with the margin that the means at either end need.
fn runs(in_hole: &[bool], half: usize) -> Vec<Range<usize>> {
    let mut found: Vec<Range<usize>> = Vec::new();
    for i in (0..in_hole.len()).filter(|i| in_hole[*i]) {
        let (first, end) = (i.saturating_sub(half), (i + half + 1).min(in_hole.len()));
        match found.last_mut() {
            Some(last) if first < last.end => last.end = end,
            _ => found.push(first..end),
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_in_a_hole_lie_in_the_middle_of_their_points() {
        let time_s: Vec<f64> = (0..1000).map(|k| 1e-3 * f64::from(k)).collect();
        let depth = Smoothed { value: time_s.clone(), slope: vec![1.0; 1000] };
        let in_hole: Vec<bool> = (0..1000).map(|i| (200..400).contains(&i) || i >= 700).collect();
        let found = Between::new(&time_s, &depth, 0.0, &in_hole, 18);
        for i in (0..1000).step_by(36) {
            let span = found.span(i);
            let inside = in_hole[i] && i < 982;
            assert_eq!(span.len > 0, inside, "{i}");
            let mean: f64 = span.weights().map(|(k, weight)| weight * found.points[k].position).sum();
            assert!(!inside || (mean - time_s[i]).abs() < 1e-12, "{i}: {mean}");
        }
        assert_eq!(found.points.last().map(|p| p.segment), Some(1));
    }
}
