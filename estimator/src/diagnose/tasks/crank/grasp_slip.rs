//! Start and duration of a grasp's slip or creep along the handle: the candidates, and a direct test for one large
//! slip.

use super::path_points::{Path, PathPoint};
use crate::diagnose::data::limits::SURE;
use crate::diagnose::hypotheses::axis::Axis;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::normal_equations::LEAST_BLOCK;
use haptics::Vec2;

/// Tried starts of a slip, in shares of the recording.
/// Choice: halved, 3 of 43 answers change; doubled, 3 of 43 answers change.
pub const SLIP_STARTS: Axis = Axis::even(1.0 / 24.0, 23.0 / 24.0, 23);
/// Starts of a creep of the grasp, in shares of the recording.
/// Choice: halved, 3 of 43 answers change; doubled, 3 of 43 answers change.
const CREEP_STARTS: Axis = Axis::even(0.0, 0.75, 4);
/// Durations of a creep of the grasp, in shares of the recording.
/// Choice: halved, 1 of 43 answers change; doubled, 3 of 43 answers change.
const CREEP_DURATIONS: Axis = Axis::geometric(0.25, 1.0, 3);
/// Small ridge that keeps the normal equations regular for equal regressors.
/// Derived: far above the rounding of a sum of squares (1e-16) and far below any power of a regressor.
const JUMP_RIDGE: f64 = 1e-9;

/// Time course of a grasp's slip: start and duration. A slip without a duration is a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    pub start_s: f64,
    pub duration_s: Option<f64>,
}

impl Course {
    pub fn of(slip: &Candidate) -> Self {
        Self { start_s: slip.searched[0].value, duration_s: slip.searched.get(1).map(|d| d.value) }
    }

    /// Share of the slip completed at this time.
    pub fn gone(self, time_s: f64) -> f64 {
        let since_s = time_s - self.start_s;
        self.duration_s.map_or(f64::from(u8::from(since_s >= 0.0)), |d| (since_s / d.max(1e-12)).clamp(0.0, 1.0))
    }

    /// Candidates of the first round. A creeping grasp looks like a wandering centre.
    pub fn coarse(path: &Path) -> Vec<Self> {
        let first = path.points.first().map_or(0.0, |p| p.time_s);
        let span_s = path.span_s();
        let slips = SLIP_STARTS.values().map(|start| Self { start_s: first + span_s * start, duration_s: None });
        let creeps = CREEP_STARTS.values().flat_map(|start| {
            CREEP_DURATIONS
                .values()
                .map(move |d| Self { start_s: first + span_s * start, duration_s: Some(span_s * d) })
        });
        slips.chain(creeps).collect()
    }

    /// Neighbours of a found course, and the course itself.
    pub fn around(self, step_s: f64) -> Vec<Self> {
        // Creeps were tried farther apart.
        let wide_s =
            if self.duration_s.is_some() { step_s * CREEP_STARTS.spacing() / SLIP_STARTS.spacing() } else { step_s };
        let starts = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|s| self.start_s + s * wide_s);
        let Some(duration_s) = self.duration_s else {
            return starts.map(|start_s| Self { start_s, duration_s: None }).to_vec();
        };
        let lasts = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|s| duration_s + s * wide_s).into_iter().filter(|d| *d > step_s);
        // An apparent creep may be a jump in its middle.
        let middle_s = self.start_s + 0.5 * duration_s;
        let at_once = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|s| Self { start_s: middle_s + s * wide_s, duration_s: None });
        lasts.flat_map(|d| starts.map(|start_s| Self { start_s, duration_s: Some(d) })).chain(at_once).collect()
    }
}

/// Time of the one large jump of the grasp, if there was one: the split for which two circles of one radius leave the
/// smallest residual. A comparison of single slips misses a large jump. The residual between its time and the tried one
/// looks like coloured noise, beside which no slip is better than another.
pub fn jump(path: &Path, center_m: Vec2) -> Option<Course> {
    let outward = |p: &PathPoint| (p.position - center_m).normalize();
    let row = |p: &PathPoint| {
        let out = outward(p);
        [1.0, out.x, out.y, (p.position - center_m).norm()]
    };
    let products = |p: &PathPoint| {
        let row = nalgebra::Vector4::from(row(p));
        row * row.transpose()
    };
    let whole: nalgebra::Matrix4<f64> = path.points.iter().map(products).sum();
    // Columns: 1, out x, out y before and after; out x, out y, 1 after; the distance.
    let left = |after: &nalgebra::Matrix4<f64>| -> Option<f64> {
        let part = |i: usize, j: usize| match (i / 3, j / 3) {
            (0, 0) => whole[(i, j)],
            _ => after[(i % 3, j % 3)],
        };
        let right = nalgebra::Vector6::from_fn(|i, _| if i < 3 { whole[(i, 3)] } else { after[(i % 3, 3)] });
        let normal = nalgebra::Matrix6::from_fn(|i, j| part(i, j) * if i == j { 1.0 + JUMP_RIDGE } else { 1.0 });
        let solved = normal.cholesky()?.solve(&right);
        Some(whole[(3, 3)] - solved.dot(&right))
    };
    let n = path.points.len();
    let mut after = whole;
    let mut best: Option<(f64, usize)> = None;
    for (k, point) in path.points.iter().enumerate() {
        let inside = k.min(n - k) >= LEAST_BLOCK;
        if inside
            && let Some(left) = left(&after)
            && best.is_none_or(|(least, _)| left < least)
        {
            best = Some((left, k));
        }
        after -= products(point);
    }
    let (least, k) = best?;
    let right = whole.fixed_view::<3, 1>(0, 3).into_owned();
    let plain = whole[(3, 3)] - whole.fixed_view::<3, 3>(0, 0).into_owned().cholesky()?.solve(&right).dot(&right);
    let much = n as f64 * (plain / least.max(1e-300)).ln();
    (much > SURE).then(|| Course { start_s: path.points[k].time_s, duration_s: None })
}
