//! Information in recordings of a crank that the estimator beside the servo cannot follow: one tool on the handle has
//! no grip to tell when it is held. The circle is that of the fit; rows are made by the same laws; the weight of a row
//! follows from the errors that the fit states.

use super::candidates::{Round, Turned, round, rubbing};
use super::geometry::Circle;
use super::laws::Laws;
use crate::identify::crank::frame::{Frame, Handled};
use crate::identify::crank::laws::{LAWS, NAMES, Place, column};
use crate::online::information::problem::Problem;
use foundation::estimate::Fit;
use foundation::signal::task::{is_two_fingered, task_signals, tip_series};
use haptics::Vec2;
use haptics::recording::Recording;
use nalgebra::{DMatrix, DVector};

/// A sample this far off the circle, as a share of its radius, is not on the handle.
const ON_CIRCLE: f64 = 0.15;
/// Slower than this share of the fastest, it hardly turns.
const TURNS: f64 = 0.02;
/// Within this speed the direction is a guess, m/s: twice the usual noise of a velocity.
const BLUR_M_S: f64 = 2e-3;
/// Rows this small beside the largest are rounding.
const RIDGE: f64 = 1e-10;

/// The handle over a recording: time, position, velocity and force.
type Course = Vec<(f64, Vec2, Vec2, Vec2)>;

/// Problems of a crank's recordings; none without a clock, a force or a circle.
pub(crate) fn crank_problems_of(recordings: &[Recording], fit: &Fit, free_row_s: f64) -> Vec<Problem> {
    let value = |name: &str| fit.value("crank", name);
    let (Some(x), Some(y), Some(radius_m)) = (value("center_x_m"), value("center_y_m"), value("radius_m")) else {
        return Vec::new();
    };
    let center_m = Vec2::new(x, y);
    let frame = Frame { center_m, give_m_per_n: Vec2::zeros(), up: 1.0, blur_m_s: BLUR_M_S };
    let courses: Vec<Course> = recordings.iter().filter_map(course).collect();
    let fastest = courses.iter().flatten().map(|c| c.2.norm()).fold(0.0, f64::max);
    let turns = |sample: &(f64, Vec2, Vec2, Vec2)| {
        let off = (sample.1 - center_m).norm() / radius_m - 1.0;
        off.abs() < ON_CIRCLE && sample.2.norm() > TURNS * fastest
    };
    let mut laws = Rows::default();
    let mut circle = Rows::default();
    for course in &courses {
        laws.take(course, 1.0 / Laws::rows_per_s(), |part| {
            let middle = part.get(part.len() / 2).filter(|m| turns(m))?;
            let (first, last) = (part.first()?, part.last()?);
            let acceleration = (last.2 - first.2) / (last.0 - first.0).max(1e-9);
            let (position, velocity, force) = (middle.1, middle.2, middle.3);
            let handled = Handled { position, velocity, acceleration, force, ..Handled::default() };
            let (motion, _) = frame.at(middle.0, &handled);
            let columns = LAWS.iter().map(|law| column(*law, &motion)).collect();
            Some((columns, [motion.normal_force_n, motion.velocity.abs()]))
        });
        circle.take(course, 1.0 / Circle::rows_per_s(), |part| {
            let middle = part.get(part.len() / 2).filter(|m| turns(m))?;
            let n = frame.outward(middle.1, middle.3);
            Some((vec![1.0, n.x, n.y, n.x * middle.3.x, n.y * middle.3.y], [middle.3.norm(), 0.0]))
        });
    }
    let error = |name: &str| fit.parameter("crank", name).filter(|p| p.identified).and_then(|p| p.std_error);
    let mut problems = Vec::new();
    let of_law =
        |k: usize| error(NAMES[k]).map(|e| if k == Place::Inertia as usize { e / (radius_m * radius_m) } else { e });
    if let Some((information, variance)) = laws.counted(&of_law) {
        let [normal_n, speed_m_s] = laws.mean();
        problems.push(rubbing(&Turned {
            information,
            variance,
            seconds: laws.seconds(),
            normal_n,
            pull_n: laws.mean_size(),
            speed_m_s,
            radius_m,
            // The fit's error of the weight contains the bias already.
            bias_error: of_law(Place::Weight as usize).map(|e| 0.3 * e),
            bias_noise_n: 0.0,
            free_row_s,
        }));
    }
    let of_circle = |k: usize| ["radius_m", "center_x_m", "center_y_m"].get(k).and_then(|name| error(name));
    if let Some((information, variance)) = circle.counted(&of_circle) {
        let force_n = circle.mean()[0];
        let normal_n = laws.mean()[0];
        problems.push(round(&Round { information, variance, seconds: circle.seconds(), normal_n, force_n }));
    }
    problems
}

/// Motion and force of the handle, or nothing where a channel or the clock is missing.
fn course(recording: &Recording) -> Option<Course> {
    recording.time_s.as_ref()?;
    let time_s = foundation::signal::task::times(recording);
    let (position, velocity, force) = if is_two_fingered(recording) {
        let signals = task_signals(recording).ok()?;
        (signals.position, signals.velocity, signals.net_force_n)
    } else {
        let tip = tip_series(recording, "").ok()?;
        (tip.position, tip.velocity?, tip.force?)
    };
    let all = time_s.into_iter().zip(position).zip(velocity).zip(force);
    Some(all.map(|(((t, p), v), f)| (t, p, v, f)).collect())
}

/// Rows of a regression, with the usual figures in them.
#[derive(Default)]
struct Rows {
    columns: Vec<Vec<f64>>,
    usual: Vec<[f64; 2]>,
    row_s: f64,
}

impl Rows {
    /// Cuts a course into parts of `row_s` seconds, one row each where `row` makes one.
    fn take(
        &mut self,
        course: &Course,
        row_s: f64,
        row: impl Fn(&[(f64, Vec2, Vec2, Vec2)]) -> Option<(Vec<f64>, [f64; 2])>,
    ) {
        self.row_s = row_s;
        let mut first = 0;
        while first < course.len() {
            let end = first + course[first..].partition_point(|c| c.0 < course[first].0 + row_s).max(1);
            if let Some((columns, usual)) = row(&course[first..end]) {
                self.columns.push(columns);
                self.usual.push(usual);
            }
            first = end;
        }
    }

    fn seconds(&self) -> f64 {
        self.row_s * self.columns.len() as f64
    }

    fn mean(&self) -> [f64; 2] {
        let n = self.usual.len().max(1) as f64;
        [0, 1].map(|k| self.usual.iter().map(|u| u[k]).sum::<f64>() / n)
    }

    fn mean_size(&self) -> f64 {
        self.usual.iter().map(|u| u[0].abs()).sum::<f64>() / self.usual.len().max(1) as f64
    }

    /// Information, and the variance that makes rows into it, so that the known errors result. `None` if none is known.
    fn counted(&self, error: &dyn Fn(usize) -> Option<f64>) -> Option<(DMatrix<f64>, f64)> {
        let n = self.columns.first()?.len();
        if self.columns.len() < 3 * n {
            return None;
        }
        let gram = self.columns.iter().fold(DMatrix::zeros(n, n), |sum: DMatrix<f64>, row| {
            let x = DVector::from_column_slice(row);
            sum + &x * x.transpose()
        });
        let size = DVector::from_fn(n, |k, _| gram[(k, k)].sqrt().max(1e-300));
        let scaled =
            DMatrix::from_fn(n, n, |i, j| gram[(i, j)] / (size[i] * size[j]) + if i == j { RIDGE } else { 0.0 });
        let inverse = scaled.try_inverse()?;
        let ratios: Vec<f64> = (0..n)
            .filter_map(|k| Some(error(k)?.powi(2) * size[k].powi(2) / inverse[(k, k)]))
            .filter(|r| r.is_finite() && *r > 0.0)
            .collect();
        let variance = ratios.iter().sum::<f64>() / ratios.len() as f64;
        (variance.is_finite() && variance > 0.0).then(|| (gram / variance, variance))
    }
}
