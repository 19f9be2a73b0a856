//! The laws of eq. 5.2 along the circle, row by row.
//!
//! A row is made of the last tenth of a second through the low-pass of the batch fit. Rows keep the circle that was
//! known when they began. Beside the regression runs the derivative of every row with respect to centre and give. The
//! values can thus be corrected for the present estimate of the circle, and its errors join theirs.

use super::super::change::{Change, ChangeDetector};
use super::super::recursive::Recursive;
use super::super::settings::Settings;
use super::geometry::Circle;
use crate::identify::crank::frame::{Frame, Handled, LOW_PASS_HALF_S};
use crate::identify::crank::laws::{LAWS, NAMES, Place, column, missing_motion};
use foundation::estimate::Parameter;
use haptics::law::Motion;

/// Number of laws.
pub(crate) const COUNT: usize = 5;
/// Rows a block of scores: rows are a filter window apart already.
const BLOCK: u32 = 2;
/// Changes that matter: weight (N), load friction, viscous friction (N s/m), constant friction (N), inertia (kg).
const MATTERS: [f64; COUNT] = [0.02, 0.02, 0.2, 0.02, 0.03];
/// Small differences of centre (m) and give (m/N) by which rows are made again.
const SHIFT: [f64; 4] = [1e-4, 1e-4, 1e-5, 1e-5];
/// A circle that differs by more than this share of the radius from the one in the rows asks for new rows.
const ANEW: f64 = 0.03;
/// Largest force by the error of a parameter, as a share of the measured force, for it to be shown (as in the batch
/// fit).
const LARGEST_ERROR: f64 = 0.3;

/// Weight, frictions and inertia while it is turned.
#[derive(Clone, Debug)]
pub struct Laws {
    half: usize,
    window: Vec<Handled>,
    times: Vec<f64>,
    next: usize,
    filled: usize,
    since_row: usize,
    motions: Vec<(Motion, f64)>,
    frame: Option<Frame>,
    fit: Recursive<COUNT>,
    change: ChangeDetector<COUNT>,
    /// Σ w x (Δy − Σ θ Δx) of every shift, without θ: Σ w x Δy and Σ w x Δxᵀ.
    by_force: [[f64; COUNT]; 4],
    by_column: [[[f64; COUNT]; COUNT]; 4],
    /// Mean squares of columns and of the force, weighted, and the weight.
    squares: [f64; COUNT],
    load: f64,
    weight: f64,
    /// Mean of the normal force and of its size, N, and of the speed, m/s.
    normal_n: f64,
    pull_n: f64,
    speed_m_s: f64,
    rows: u64,
}

impl Laws {
    pub(super) fn new(settings: &Settings, period_s: f64) -> Self {
        let half = (LOW_PASS_HALF_S / period_s).round().max(1.0) as usize;
        let (length, row_s) = (2 * half + 1, 2.0 * half as f64 * period_s);
        Self {
            half,
            window: vec![Handled::default(); length],
            times: vec![0.0; length],
            next: 0,
            filled: 0,
            since_row: 0,
            motions: Vec::with_capacity(length),
            frame: None,
            fit: Recursive::new([1.0, 1.0, 0.1, 1.0, 0.5], settings.memory_s / row_s, BLOCK),
            change: ChangeDetector::new(settings.false_alarms_per_hour, row_s, MATTERS),
            by_force: [[0.0; COUNT]; 4],
            by_column: [[[0.0; COUNT]; COUNT]; 4],
            squares: [0.0; COUNT],
            load: 0.0,
            weight: 0.0,
            normal_n: 0.0,
            pull_n: 0.0,
            speed_m_s: 0.0,
            rows: 0,
        }
    }

    /// Starts the window again: the next samples do not follow the earlier ones.
    pub(super) fn interrupt(&mut self) {
        (self.filled, self.since_row) = (0, 0);
    }

    /// Takes in a sample that turns; says when a parameter jumped, with its value before.
    pub(super) fn push(
        &mut self,
        time_s: f64,
        handled: &Handled,
        circle: &Circle,
        blur_m_s: f64,
    ) -> Option<(usize, Change, f64)> {
        (self.window[self.next], self.times[self.next]) = (*handled, time_s);
        self.next = (self.next + 1) % self.window.len();
        self.filled = (self.filled + 1).min(self.window.len());
        self.since_row += 1;
        if self.filled < self.window.len() || self.since_row < 2 * self.half {
            return None;
        }
        let (center_m, radius_m, give_m_per_n, _) = circle.frame()?;
        let now = Frame { center_m, give_m_per_n, up: 1.0, blur_m_s };
        if self.frame.is_none_or(|f| (f.center_m - center_m).norm() > ANEW * radius_m) {
            self.anew(now, time_s);
        }
        let frame = Frame { blur_m_s, ..self.frame? };
        self.since_row = 0;
        self.row(time_s, &frame)
    }

    fn anew(&mut self, frame: Frame, time_s: f64) {
        self.frame = Some(frame);
        self.fit.reset();
        self.change.restart(time_s);
        (self.by_force, self.by_column) = ([[0.0; COUNT]; 4], [[[0.0; COUNT]; COUNT]; 4]);
        (self.squares, self.load, self.weight, self.rows) = ([0.0; COUNT], 0.0, 0.0, 0);
    }

    fn row(&mut self, time_s: f64, frame: &Frame) -> Option<(usize, Change, f64)> {
        let (columns, tangential, direction) = self.pass(frame);
        let middle = self.motions[self.half].0;
        // Around a reversal the direction is a guess.
        let weight = direction.powi(4);
        if weight < 1e-6 {
            return None;
        }
        for (k, step) in SHIFT.into_iter().enumerate() {
            let mut shifted = *frame;
            match k {
                0 | 1 => shifted.center_m[k] += step,
                _ => shifted.give_m_per_n[k - 2] += step,
            }
            let (other, force, _) = self.pass(&shifted);
            for i in 0..COUNT {
                self.by_force[k][i] += weight * columns[i] * (force - tangential) / step;
                for j in 0..COUNT {
                    self.by_column[k][i][j] += weight * columns[i] * (other[j] - columns[j]) / step;
                }
            }
        }
        for (sum, c) in self.squares.iter_mut().zip(columns) {
            *sum += weight * c * c;
        }
        (self.load, self.weight, self.rows) =
            (self.load + weight * tangential * tangential, self.weight + weight, self.rows + 1);
        let share = 1.0 / self.rows as f64;
        self.normal_n += share * (middle.normal_force_n - self.normal_n);
        self.pull_n += share * (middle.normal_force_n.abs() - self.pull_n);
        self.speed_m_s += share * (middle.velocity.abs() - self.speed_m_s);
        let before = self.fit.values();
        let innovation = self.fit.push(&columns, tangential, weight)?;
        let scaled = columns.map(|c| c * weight.sqrt());
        let change = self.change.push(time_s, &scaled, innovation.residual * weight.sqrt(), innovation.leverage)?;
        self.anew(self.frame?, time_s);
        Some((change.parameter, change, before[change.parameter]))
    }

    /// The window through the low-pass, split by `frame`: regressors of the laws, tangential force, certainty of the
    /// direction.
    fn pass(&mut self, frame: &Frame) -> ([f64; COUNT], f64, f64) {
        let length = self.window.len();
        self.motions.clear();
        for k in 0..length {
            let at = (self.next + k) % length;
            self.motions.push(frame.at(self.times[at], &self.window[at]));
        }
        let reach = (self.half as f64 + 0.5).powi(2);
        let (mut columns, mut tangential, mut direction, mut total) = ([0.0; COUNT], 0.0, 0.0, 0.0);
        for (k, (motion, force)) in self.motions.iter().enumerate() {
            let w = reach - (k as f64 - self.half as f64).powi(2);
            for (sum, law) in columns.iter_mut().zip(LAWS) {
                *sum += w * column(law, motion);
            }
            tangential += w * force;
            direction += w * motion.direction.abs();
            total += w;
        }
        (columns.map(|c| c / total), tangential / total, direction / total)
    }

    /// Values corrected for the circle of now, their errors from the rows alone and with those of the circle.
    pub(crate) fn values(&self, circle: &Circle) -> Option<([f64; COUNT], [f64; COUNT])> {
        let (frame, (center, _, give, circle_errors)) = (self.frame?, circle.frame()?);
        let (mut values, mut errors) = (self.fit.values(), self.fit.std_errors());
        let (inverse, fitted) = (self.fit.inverse(), self.fit.values());
        let moved = [
            center.x - frame.center_m.x,
            center.y - frame.center_m.y,
            give.x - frame.give_m_per_n.x,
            give.y - frame.give_m_per_n.y,
        ];
        for k in 0..4 {
            let score: [f64; COUNT] = std::array::from_fn(|i| {
                self.by_force[k][i] - (0..COUNT).map(|j| self.by_column[k][i][j] * fitted[j]).sum::<f64>()
            });
            for (i, row) in inverse.iter().enumerate() {
                let slope: f64 = row.iter().zip(score).map(|(a, s)| a * s).sum();
                values[i] += slope * moved[k];
                errors[i] = errors[i].hypot(slope * circle_errors[k + 1]);
            }
        }
        Some((values, errors))
    }

    /// The recursion behind them.
    pub(crate) fn fit(&self) -> &Recursive<COUNT> {
        &self.fit
    }

    /// Mean normal force, mean size of it, N, and mean speed, m/s.
    pub(crate) fn usual(&self) -> (f64, f64, f64) {
        (self.normal_n, self.pull_n, self.speed_m_s)
    }

    /// Rows a second while it turns.
    pub(crate) fn rows_per_s() -> f64 {
        0.5 / LOW_PASS_HALF_S
    }

    pub(super) fn parameters(&self, circle: &Circle, bias: Option<(f64, f64)>) -> Vec<Parameter> {
        let samples = self.rows as usize;
        let radius = circle.frame().map_or(0.0, |f| f.1);
        let known = self.values(circle);
        let load = (self.load / self.weight.max(1e-12)).sqrt();
        let of = |(law, name): (usize, &str)| {
            let scale = if law == Place::Inertia as usize { radius * radius } else { 1.0 };
            let size = (self.squares[law] / self.weight.max(1e-12)).sqrt();
            match known {
                Some((values, errors))
                    if errors[law] * size <= LARGEST_ERROR * load
                        && (law != Place::Weight as usize || bias.is_some()) =>
                {
                    let of_bias = if law == Place::Weight as usize { bias.map_or(0.0, |(_, e)| e) } else { 0.0 };
                    let error = errors[law].hypot(of_bias) * scale;
                    let how = format!("{} in the tangential force (eq. 5.2)", LAWS[law].title());
                    Parameter::identified("crank", name, values[law] * scale, error, samples, &how)
                }
                None => {
                    Parameter::unidentified("crank", name, samples, "the circle is not known well enough yet; turn on")
                }
                Some(_) if law == Place::Weight as usize && bias.is_none() => Parameter::unidentified(
                    "crank",
                    name,
                    samples,
                    "the hand was not seen free yet: a bias of the force sensors would pass for weight; let go for a second",
                ),
                Some(_) => Parameter::unidentified("crank", name, samples, missing_motion(law)),
            }
        };
        NAMES.into_iter().enumerate().map(of).collect()
    }
}
