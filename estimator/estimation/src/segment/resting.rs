//! The force of a single tool while nothing is touched: its sensor's bias, and its noise.
//!
//! A load close to zero is no sign of free motion if the sensor has a bias, or much noise. A released tool shows
//! otherwise. For a while the force is constant but for its noise, at the same vector each time, and the tool is off
//! the circle that it follows while it holds the crank.

use super::threshold::percentile;
use crate::constraint::circle;
use foundation::signal::noise::quantum;
use haptics::Vec2;
use nalgebra::Vector3;
use std::ops::Range;

/// Length of the blocks of a recording that are compared with each other, s and samples.
const PIECE_S: f64 = 0.25;
const PIECE_SAMPLES: usize = 8;
/// Least number of blocks at the same force for free motion; one may be a moment of a turn.
const LEAST_PIECES: usize = 2;
/// Largest scatter of a block at rest, in multiples of the noise. It belongs to others when its mean is within `NEAR`
/// times the noise of theirs (noise with a memory does not average out within a block).
const STILL: f64 = 1.6;
const NEAR: f64 = 2.0;
/// Levels that are tried, from the smallest force on: more stand still in contact only.
const MOST_SEEDS: usize = 200;
/// Largest bias, as a share of the usual forces of the hand.
const LARGEST_BIAS: f64 = 0.35;
/// Distance off the circle: as a share of the radius, and in multiples of the path's usual distance from it.
const OFF_SHARE: f64 = 0.03;
const OFF_MULTIPLE: f64 = 4.0;
/// Points that a circle is fitted to are enough.
const MOST_POINTS: usize = 4000;

/// Force while nothing is touched.
#[derive(Clone, Debug, PartialEq)]
pub struct Resting {
    /// Mean force, N: the sensor's bias.
    pub bias_n: Vector3<f64>,
    /// Standard deviation of a component as recorded, N.
    pub noise_n: f64,
    /// Samples that were taken as free motion, in order.
    pub free: Vec<usize>,
    /// Times, s, and levels, N, of the force at rest, one rest after the other: two and more if the sensor drifts, else
    /// none.
    drift: Vec<(f64, Vector3<f64>)>,
}

/// A block of the recording.
struct Piece {
    first: usize,
    end: usize,
    mean_n: Vector3<f64>,
    /// Standard deviation of a component, N.
    scatter_n: f64,
}

impl Resting {
    /// Finds the force at rest; `None` where no force comes back again and again, or where only a held crank could make it.
    ///
    /// `certain_n`: a level of this size needs no circle to be believed.
    pub fn of(time_s: &[f64], force_n: &[Vector3<f64>], position_m: &[Vec2], certain_n: f64) -> Option<Self> {
        let axes = axes(force_n);
        let pieces = pieces(time_s, force_n, axes);
        let mut scatters: Vec<f64> = pieces.iter().map(|p| p.scatter_n).collect();
        let axis = |k: usize| quantum(&force_n.iter().map(|f| f[k]).collect::<Vec<_>>());
        let noise_n = percentile(&mut scatters, 0.1).max((0..3).map(axis).fold(0.0, f64::max) / 12.0_f64.sqrt());
        if noise_n <= 0.0 {
            return None;
        }
        let usual_n = percentile(&mut force_n.iter().map(Vector3::norm).collect::<Vec<_>>(), 0.95);
        let mut still: Vec<&Piece> = pieces.iter().filter(|p| p.scatter_n <= STILL * noise_n).collect();
        still.sort_by(|a, b| a.mean_n.norm().total_cmp(&b.mean_n.norm()));
        let mut tried: Vec<Vector3<f64>> = Vec::new();
        for seed in still.iter().take(MOST_SEEDS) {
            if tried.iter().any(|t| (t - seed.mean_n).norm() < 0.5 * NEAR * noise_n) {
                continue;
            }
            tried.push(seed.mean_n);
            let members = members(&still, seed.mean_n, NEAR * noise_n);
            let found = Self::from(&members, force_n, axes);
            let small = found.bias_n.norm() <= LARGEST_BIAS * usual_n;
            if members.len() >= LEAST_PIECES
                && small
                && (found.bias_n.norm() <= certain_n || is_off_circle(&found.free, force_n, found.bias_n, position_m))
            {
                let rests = found.drifted(&pieces, noise_n, LARGEST_BIAS * usual_n, (force_n, position_m));
                return Some(found.drifting(rests, time_s, force_n));
            }
        }
        None
    }

    /// Rests at which the force stands still elsewhere: at other times, off the circle, and no farther from here than `most_n`.
    fn drifted(
        &self,
        pieces: &[Piece],
        noise_n: f64,
        most_n: f64,
        (force_n, position_m): (&[Vector3<f64>], &[Vec2]),
    ) -> Vec<Range<usize>> {
        let is_here = |p: &Piece| self.free.binary_search(&p.first).is_ok();
        let rests =
            |p: &Piece| p.scatter_n <= STILL * noise_n && (p.mean_n - self.bias_n).norm() <= most_n && !is_here(p);
        let follows = |a: &Piece, b: &Piece| rests(a) && rests(b) && (a.mean_n - b.mean_n).norm() <= NEAR * noise_n;
        let runs = pieces.chunk_by(follows).filter(|run| run.len() >= LEAST_PIECES && rests(&run[0]));
        let spans = runs.map(|run| run[0].first..run[run.len() - 1].end);
        spans
            .filter(|span| is_off_circle(&span.clone().collect::<Vec<_>>(), force_n, self.bias_n, position_m))
            .collect()
    }

    /// The same with further rests of a sensor that drifts.
    fn drifting(mut self, rests: Vec<Range<usize>>, time_s: &[f64], force_n: &[Vector3<f64>]) -> Self {
        if rests.is_empty() {
            return self;
        }
        self.free.extend(rests.into_iter().flatten());
        self.free.sort_unstable();
        let mean = |run: &[usize]| {
            let count = run.len() as f64;
            let when_s = run.iter().map(|i| time_s[*i]).sum::<f64>() / count;
            (when_s, run.iter().map(|i| force_n[*i]).sum::<Vector3<f64>>() / count)
        };
        self.drift = self.free.chunk_by(|a, b| a + 1 == *b).map(mean).collect();
        self
    }

    /// The force at rest at a time, N: interpolated between the rests before and after if the sensor drifts.
    pub fn bias_at(&self, time_s: f64) -> Vector3<f64> {
        let next = self.drift.partition_point(|(t, _)| *t < time_s);
        match (next.checked_sub(1).and_then(|k| self.drift.get(k)), self.drift.get(next)) {
            (Some((t0, before)), Some((t1, after))) => before.lerp(after, (time_s - t0) / (t1 - t0).max(1e-12)),
            (Some((_, level)), None) | (None, Some((_, level))) => *level,
            (None, None) => self.bias_n,
        }
    }

    /// Largest distance of the force at rest from zero, N.
    pub fn farthest_n(&self) -> f64 {
        self.drift.iter().map(|(_, level)| level.norm()).fold(self.bias_n.norm(), f64::max)
    }

    /// True if it changes with time.
    pub fn drifts(&self) -> bool {
        !self.drift.is_empty()
    }

    fn from(members: &[&Piece], force_n: &[Vector3<f64>], axes: f64) -> Self {
        let mut free: Vec<usize> = members.iter().flat_map(|p| p.first..p.end).collect();
        free.sort_unstable();
        let count = free.len().max(1) as f64;
        let bias_n = free.iter().map(|i| force_n[*i]).sum::<Vector3<f64>>() / count;
        let squares: f64 = free.iter().map(|i| (force_n[*i] - bias_n).norm_squared()).sum();
        Self { bias_n, noise_n: (squares / (axes * count)).sqrt(), free, drift: Vec::new() }
    }

    /// Standard deviation of a component of another series (the calmed force) over the same samples, N.
    pub fn noise_of(&self, time_s: &[f64], force_n: &[Vector3<f64>]) -> f64 {
        let squares: f64 = self.free.iter().map(|i| (force_n[*i] - self.bias_at(time_s[*i])).norm_squared()).sum();
        (squares / (axes(force_n) * self.free.len().max(1) as f64)).sqrt()
    }
}

/// Number of axes in which a force was measured: 2 or 3.
fn axes(force_n: &[Vector3<f64>]) -> f64 {
    if force_n.iter().all(|force| force.z == 0.0) { 2.0 } else { 3.0 }
}

fn pieces(time_s: &[f64], force_n: &[Vector3<f64>], axes: f64) -> Vec<Piece> {
    let mut pieces = Vec::new();
    let mut first = 0;
    for i in 1..=time_s.len() {
        let complete = i - first >= PIECE_SAMPLES && time_s[i - 1] - time_s[first] >= PIECE_S;
        if complete {
            let own = &force_n[first..i];
            let mean_n = own.iter().sum::<Vector3<f64>>() / own.len() as f64;
            let squares: f64 = own.iter().map(|f| (f - mean_n).norm_squared()).sum();
            let scatter_n = (squares / (axes * (own.len() - 1) as f64)).sqrt();
            pieces.push(Piece { first, end: i, mean_n, scatter_n });
            first = i;
        }
    }
    pieces
}

/// The blocks about a level, which is moved to their own middle once.
fn members<'a>(still: &[&'a Piece], level_n: Vector3<f64>, near_n: f64) -> Vec<&'a Piece> {
    let about = |level: Vector3<f64>| -> Vec<&'a Piece> {
        still.iter().copied().filter(|p| (p.mean_n - level).norm() <= near_n).collect()
    };
    let first = about(level_n);
    if first.is_empty() {
        return first;
    }
    about(first.iter().map(|p| p.mean_n).sum::<Vector3<f64>>() / first.len() as f64)
}

/// True if samples are off the circle that the tool follows under load.
fn is_off_circle(free: &[usize], force_n: &[Vector3<f64>], bias_n: Vector3<f64>, position_m: &[Vec2]) -> bool {
    let mut is_free = vec![false; force_n.len()];
    for i in free {
        is_free[*i] = true;
    }
    let mut loads: Vec<f64> = force_n.iter().map(|f| (f - bias_n).norm()).collect();
    let usual_n = percentile(&mut loads.clone(), 0.5);
    // Samples that are not free and carry some load.
    let held: Vec<usize> = (0..loads.len()).filter(|i| !is_free[*i] && loads[*i] >= 0.5 * usual_n).collect();
    loads.clear();
    let points: Vec<Vec2> =
        held.iter().step_by(held.len().div_ceil(MOST_POINTS).max(1)).map(|i| position_m[*i]).collect();
    if points.len() < PIECE_SAMPLES {
        return false;
    }
    let middle = points.iter().sum::<Vec2>() / points.len() as f64;
    let extent_m = points.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
    if extent_m <= 0.0 {
        return false;
    }
    let mut centred: Vec<Vec2> = points.iter().map(|p| p - middle).collect();
    let (mut arc, _) = circle::fit(&centred, extent_m);
    // The way to the handle and back is under load already: a tenth may miss the circle.
    let mut misses: Vec<f64> = centred.iter().map(|p| arc.distance(*p).abs()).collect();
    let worst = percentile(&mut misses, 0.9);
    centred.retain(|p| arc.distance(*p).abs() <= worst);
    let cost;
    (arc, cost) = circle::fit(&centred, extent_m);
    if arc.curvature <= 0.0 {
        return false;
    }
    let rms_m = (cost / centred.len().max(1) as f64).sqrt();
    let mut off: Vec<f64> = free.iter().map(|i| arc.distance(position_m[*i] - middle).abs()).collect();
    percentile(&mut off, 0.8) > (OFF_SHARE / arc.curvature).max(OFF_MULTIPLE * rms_m)
}

#[cfg(test)]
pub(crate) mod tests;
