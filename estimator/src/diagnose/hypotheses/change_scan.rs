//! Scan of all times for the sudden change that explains most of a residual.

use super::dictionary::Dictionary;
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::direction::STANDS;
use crate::diagnose::data::limits::{HALF, LEAST_PIECES, SIGNIFICANT};
use crate::diagnose::data::regression_data::{Place, Row, Track};
use foundation::signal::noise::white_noise;

/// Least-squares scan over the times of a step beside the model of one recording.
#[derive(Clone)]
pub(crate) struct Scan {
    time_s: Vec<f64>,
    /// Effect on each row of a unit of each component of the change.
    axes: Vec<Vec<f64>>,
    /// Orthonormal regressors of the model and of the steps found, and the residual beside them.
    basis: Vec<Vec<f64>>,
    pub(crate) residual: Vec<f64>,
}

impl Scan {
    /// `axes`: number of the change's components, at most two; `unit`: effect of a unit of each on a row.
    pub(crate) fn of(data: &Dictionary<'_>, recording: usize, axes: usize, unit: &dyn Fn(usize) -> [f64; 2]) -> Self {
        let rows = &data.track.rows;
        let counts = |row: &Row| row.recording == recording && !matches!(row.place, Place::Stuck { .. });
        let mut own: Vec<usize> = (0..rows.len()).filter(|i| counts(&rows[*i]) && rows[*i].open <= STANDS).collect();
        own.sort_by(|a, b| rows[*a].motion.time_s.total_cmp(&rows[*b].motion.time_s));
        let column = |of: &dyn Fn(usize) -> f64| own.iter().map(|i| of(*i)).collect::<Vec<f64>>();
        let axes = (0..axes).map(|axis| column(&|i| unit(i)[axis])).collect();
        let model = vec![column(&|i| data.predicted[i]), column(&|i| data.resisting[i]), column(&|i| slides(data, i))];
        Self::beside(model, column(&|i| rows[i].motion.time_s), column(&|i| rows[i].target)).along(axes)
    }

    /// The rows in the order of their times, beside a model's regressors.
    pub(crate) fn beside(model: Vec<Vec<f64>>, time_s: Vec<f64>, target: Vec<f64>) -> Self {
        let mut scan = Self { time_s, axes: Vec::new(), basis: Vec::new(), residual: target };
        let whole = dot(&scan.residual, &scan.residual);
        for column in model {
            scan.fit(column);
        }
        // Rounding errors have no step.
        if dot(&scan.residual, &scan.residual) <= 1e-9 * whole {
            scan.time_s.clear();
        }
        scan
    }

    /// The same rows with these components of a change, at most two: the effect of a unit of each on each row.
    pub(crate) fn along(&self, axes: Vec<Vec<f64>>) -> Self {
        Self { axes, ..self.clone() }
    }

    /// Adds a regressor to the model.
    fn fit(&mut self, mut column: Vec<f64>) {
        let size = dot(&column, &column);
        for known in &self.basis {
            let share = dot(known, &column);
            column.iter_mut().zip(known).for_each(|(c, k)| *c -= share * k);
        }
        let left = dot(&column, &column);
        if left <= 1e-9 * size {
            return;
        }
        for c in &mut column {
            *c /= left.sqrt();
        }
        let share = dot(&column, &self.residual);
        self.residual.iter_mut().zip(&column).for_each(|(r, c)| *r -= share * c);
        self.basis.push(column);
    }

    /// Time of the best step.
    pub(crate) fn best_time_s(&self) -> Option<f64> {
        let (_, at, _) = self.best()?;
        Some(self.before(at))
    }

    /// Sum of squares that the best step takes off the residual, and its time; it joins the model. `None` for a slow
    /// change.
    pub(crate) fn next_step(&mut self) -> Option<(f64, f64)> {
        // The best step takes at most 8/9 of the power of a slope from zero.
        let slow = dot(&self.residual, &self.residual) * 8.0 / 9.0;
        let (gain, at, _) = self.best().filter(|(gain, at, size)| *gain > slow || self.is_sharp(*at, *size))?;
        for axis in self.axes.clone() {
            self.fit(axis.iter().enumerate().map(|(i, a)| if i >= at { *a } else { 0.0 }).collect());
        }
        Some((gain, self.before(at)))
    }

    /// Time between a row and the one before, s.
    fn before(&self, at: usize) -> f64 {
        HALF * (self.time_s[at - 1] + self.time_s[at])
    }

    /// Gain of the best step, its first row, and its size along each axis.
    fn best(&self) -> Option<(f64, usize, [f64; 2])> {
        let last = self.time_s.len().checked_sub(LEAST_PIECES)?;
        let first = LEAST_PIECES;
        // Sums over all rows from one on: products of the axes with the residual, the basis, and each other.
        let (mut with_residual, mut with_basis) = ([0.0; 2], vec![[0.0; 2]; self.basis.len()]);
        let mut square = [[0.0; 2]; 2];
        let mut best: Option<(f64, usize, [f64; 2])> = None;
        for i in (first..self.time_s.len()).rev() {
            for (a, axis) in self.axes.iter().enumerate() {
                with_residual[a] += axis[i] * self.residual[i];
                with_basis.iter_mut().zip(&self.basis).for_each(|(sum, column)| sum[a] += axis[i] * column[i]);
                self.axes.iter().enumerate().for_each(|(b, other)| square[a][b] += axis[i] * other[i]);
            }
            let beside = |a: usize, b: usize| square[a][b] - with_basis.iter().map(|s| s[a] * s[b]).sum::<f64>();
            let size = size(with_residual, [beside(0, 0), beside(0, 1), beside(1, 1)], self.axes.len());
            let gain = size[0] * with_residual[0] + size[1] * with_residual[1];
            if i <= last && best.is_none_or(|(most, ..)| gain > most) {
                best = Some((gain, i, size));
            }
        }
        best
    }

    /// True if the residual jumps by this step between the rows before and after, within half of it: a slow change does
    /// not.
    /// Rows that the step hardly moves count less: each side has the power of a few mean rows.
    fn is_sharp(&self, at: usize, size: [f64; 2]) -> bool {
        let step = |i: usize| self.axes.iter().zip(size).map(|(axis, b)| axis[i] * b).sum::<f64>();
        let rows = self.time_s.len();
        let enough = LEAST_PIECES as f64 * (0..rows).map(|i| step(i).powi(2)).sum::<f64>() / rows as f64;
        let share = |side: &mut dyn Iterator<Item = usize>| {
            let (mut power, mut product) = (f64::MIN_POSITIVE, 0.0);
            while power < enough {
                let Some(i) = side.next() else { break };
                power += step(i).powi(2);
                product += step(i) * self.residual[i];
            }
            (product / power, power.recip())
        };
        let (before, after) = (share(&mut (0..at).rev()), share(&mut (at..rows)));
        let error = white_noise(&self.residual) * (before.1 + after.1).sqrt();
        let (jump, error) = (after.0 - before.0, SIGNIFICANT * error);
        jump > error && (jump - 1.0).abs() < HALF.max(error)
    }
}

/// Widens the standard error of a change's time: while the object stands, it may be anywhere between the moving rows
/// before and after.
pub(crate) fn widen_time(time: &mut CauseParameter, track: &Track) {
    let moves = |row: &&Row| !matches!(row.place, Place::Stuck { .. }) && row.open <= STANDS;
    let times: Vec<f64> = track.rows.iter().filter(moves).map(|row| row.motion.time_s).collect();
    widen_between(time, &times);
}

/// Widens the standard error of a change's time: it may be anywhere between the times before and after.
pub(crate) fn widen_between(time: &mut CauseParameter, times: &[f64]) {
    let before_s = times.iter().copied().filter(|t| *t <= time.value).fold(f64::NEG_INFINITY, f64::max);
    let after_s = times.iter().copied().filter(|t| *t > time.value).fold(f64::INFINITY, f64::min);
    if (after_s - before_s).is_finite() {
        // Standard deviation of a uniform distribution about any of its points.
        let [spread_s, aside_s] = [(after_s - before_s) / 12.0_f64.sqrt(), HALF * (before_s + after_s) - time.value];
        time.std_error = time.std_error.hypot(spread_s).hypot(aside_s);
    }
}

/// The dry friction of a row if it slid, with the sign of its direction.
pub(crate) fn slides(data: &Dictionary<'_>, i: usize) -> f64 {
    let row = &data.track.rows[i];
    if row.place == Place::Along { data.dry[i] * row.motion.direction } else { 0.0 }
}

/// Least-squares size of a step along one or two axes. `with_residual`: products of its regressors with the residual;
/// `own`: those with each other beside the model (xx, xy, yy).
fn size([x, y]: [f64; 2], [xx, xy, yy]: [f64; 3], axes: usize) -> [f64; 2] {
    let det = xx * yy - xy * xy;
    match axes {
        2 if det > 1e-9 * xx * yy => [(x * yy - y * xy) / det, (y * xx - x * xy) / det],
        1 if xx > 1e-9 => [x / xx, 0.0],
        _ => [0.0; 2],
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
