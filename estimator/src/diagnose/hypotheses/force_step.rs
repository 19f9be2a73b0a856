//! A step of the force channel as a hypothesis: its times come from a scan of all times.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::grid::{Near, Point, Ranges};
use super::hypothesis::{About, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::sensor_fault::{SensorFault, add_each, add_halved};
use super::variable::Variable;
use crate::diagnose::contract::CauseParameter;
use crate::diagnose::data::direction::STANDS;
use crate::diagnose::data::limits::{HALF, LEAST_PIECES, SIGNIFICANT};
use crate::diagnose::data::regression_data::{Place, Row, Track};
use foundation::signal::noise::white_noise;
use haptics::Vec2;
use haptics::law::{ForceStep, Kind};

pub(crate) const ID: &str = "force-step";

/// Points: none; a scan finds the times.
const SCAN: &str = "scan";
/// Points: time, recording.
const TIMES: &str = "time";

impl Hypothesis for ForceStep {
    fn about(&self) -> About {
        About {
            id: ID,
            form: Form::Exact(&[Over::Time]),
            relations: &[Relation::NeedsForce],
            seen: Variable::Time,
            ..About::PLAIN
        }
    }

    fn coarse(&self, _ranges: &Ranges<'_>) -> Vec<Point> {
        vec![Point::one(SCAN, 0.0)]
    }

    fn around(&self, near: &Near<'_>) -> Vec<Point> {
        let apart_s = HALF * near.step * near.ranges.track.period_s;
        let times = near.of(ID).filter_map(|found| Some((found.value("t0")?, found.part as f64)));
        let beside = [-1.5, -1.0, -0.5, 0.5, 1.0, 1.5];
        times.flat_map(|(time, part)| beside.map(|k| Point::two(TIMES, time + k * apart_s, part))).collect()
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        let near = data.points(ID, TIMES).map(|[time_s, part, ..]| step(data, &[(part as usize, time_s)]));
        let jumps = if data.points(ID, SCAN).next().is_some() { jumps(data) } else { Vec::new() };
        near.chain((1..=jumps.len()).map(|n| step(data, &jumps[..n]))).collect()
    }

    /// A step while the object stands may be anywhere between the moving rows before and after.
    fn widen(&self, parameters: &mut [CauseParameter], track: &Track) {
        let moves = |row: &&Row| !matches!(row.place, Place::Stuck { .. }) && row.open <= STANDS;
        let times = || track.rows.iter().filter(moves).map(|row| row.motion.time_s);
        for parameter in parameters.iter_mut().filter(|p| SYMBOLS.iter().any(|symbols| symbols.time == p.name)) {
            let before_s = times().filter(|t| *t <= parameter.value).fold(f64::NEG_INFINITY, f64::max);
            let after_s = times().filter(|t| *t > parameter.value).fold(f64::INFINITY, f64::min);
            if (after_s - before_s).is_finite() {
                // Standard deviation of a uniform distribution.
                parameter.std_error = parameter.std_error.hypot((after_s - before_s) / 12.0_f64.sqrt());
            }
        }
    }

    fn add_to_fault(&self, fault: &mut SensorFault, candidate: &Candidate, values: &[f64]) -> bool {
        for (step, searched) in fault.steps.iter_mut().zip(&candidate.searched) {
            step.at_s = searched.value;
        }
        add_each(candidate, values, |name, value| {
            SYMBOLS.iter().enumerate().any(|(k, symbols)| {
                if name == symbols.along {
                    fault.steps[k].along = value;
                    return true;
                }
                add_halved(&mut fault.steps[k].force_n, symbols.axes, name, value)
            })
        })
    }
}

/// Least gain of a further step, over that of the first.
/// Derived: between 0.15, the gain of a second step for a straight slope, and 0.33, that for a staircase of two equal
/// steps (piecewise constant least squares).
const LEAST_GAIN: f64 = 0.25;

/// Names of the parameters of one step.
struct Symbols {
    along: &'static str,
    axes: [&'static str; 2],
    time: &'static str,
}

/// Names of the first, second and third step.
const SYMBOLS: [Symbols; 3] = [
    Symbols { along: "step", axes: ["bx", "by"], time: "t0" },
    Symbols { along: "second step", axes: ["second bx", "second by"], time: "second t0" },
    Symbols { along: "third step", axes: ["third bx", "third by"], time: "third t0" },
];

/// Sum of the steps of a candidate with two axes until a time, N. `values`: two for each step.
pub(crate) fn vector_at(candidate: &Candidate, values: &[f64], time_s: f64) -> Vec2 {
    let steps = values.chunks_exact(2).zip(&candidate.searched);
    steps.filter(|(_, at)| time_s >= at.value).map(|(step, _)| Vec2::new(step[0], step[1])).sum()
}

/// Steps of one recording at these times. `jumps`: recording and time, s.
fn step(data: &Dictionary<'_>, jumps: &[(usize, f64)]) -> Candidate {
    let (mut columns, mut linear) = (Vec::new(), Vec::new());
    for ((recording, time_s), symbols) in jumps.iter().zip(&SYMBOLS) {
        let of = |row: &Row| if row.recording == *recording { 1.0 } else { 0.0 };
        let since: Vec<f64> = if data.track.planar {
            data.every(&|r| if r.motion.time_s >= *time_s { of(r) } else { 0.0 })
        } else {
            let law = data.law(&ForceStep, &[1.0, *time_s]);
            data.track.rows.iter().zip(law.iter()).map(|(r, x)| of(r) * x).collect()
        };
        let along = |axis: Vec2| -> Vec<f64> {
            data.track.rows.iter().zip(&since).map(|(r, x)| r.along.dot(&axis) * x).collect()
        };
        if data.track.planar {
            columns.extend([along(Vec2::x()), along(Vec2::y())]);
            linear.extend(symbols.axes.map(|name| (name, "N")));
        } else {
            columns.push(since);
            linear.push((symbols.along, data.unit(&ForceStep, 0)));
        }
    }
    let mut candidate = Candidate::several(ID, Kind::Instrument, columns, linear).within(jumps[0].0);
    // The time of a change counts twice, because it is the best of all times (Zhang & Siegmund 2007).
    candidate.cost += jumps.len() as f64;
    jumps.iter().zip(&SYMBOLS).fold(candidate, |made, ((_, time_s), symbols)| made.at(symbols.time, *time_s, "s"))
}

/// Recordings and times of up to three steps, each the best one beside those before it. The first takes half of the
/// power of the residual.
fn jumps(data: &Dictionary<'_>) -> Vec<(usize, f64)> {
    let recordings = data.track.rows.iter().map(|row| row.recording).max().map_or(0, |last| last + 1);
    let scans = (0..recordings).map(|recording| (recording, Scan::of(data, recording)));
    let steps = |(recording, mut scan): (usize, Scan)| -> (f64, Vec<(usize, f64)>) {
        let power = dot(&scan.residual, &scan.residual);
        let mut found: Vec<(f64, f64)> = SYMBOLS.iter().map_while(|_| scan.next_step()).collect();
        let first = found.first().map_or(0.0, |(gain, _)| *gain);
        let enough =
            |(k, (gain, _)): &(usize, &(f64, f64))| *gain > if *k == 0 { HALF * power } else { LEAST_GAIN * first };
        let steps = found.iter().enumerate().take_while(enough).count();
        found.truncate(steps);
        (first, found.iter().map(|(_, time_s)| (recording, *time_s)).collect())
    };
    // A step has a recording of its own.
    scans.map(steps).max_by(|a, b| a.0.total_cmp(&b.0)).map_or_else(Vec::new, |(_, steps)| steps)
}

/// Least-squares scan over the times of a step beside the model of one recording.
struct Scan {
    time_s: Vec<f64>,
    /// Effect on each row of a unit force along each axis of the sensor.
    axes: Vec<Vec<f64>>,
    /// Orthonormal regressors of the model and of the steps found, and the residual beside them.
    basis: Vec<Vec<f64>>,
    residual: Vec<f64>,
}

impl Scan {
    fn of(data: &Dictionary<'_>, recording: usize) -> Self {
        let rows = &data.track.rows;
        let counts = |row: &Row| row.recording == recording && !matches!(row.place, Place::Stuck { .. });
        let mut own: Vec<usize> = (0..rows.len()).filter(|i| counts(&rows[*i]) && rows[*i].open <= STANDS).collect();
        own.sort_by(|a, b| rows[*a].motion.time_s.total_cmp(&rows[*b].motion.time_s));
        let column = |of: &dyn Fn(usize) -> f64| own.iter().map(|i| of(*i)).collect::<Vec<f64>>();
        let axes = if data.track.planar {
            [Vec2::x(), Vec2::y()].iter().map(|axis| column(&|i| rows[i].along.dot(axis))).collect()
        } else {
            vec![vec![1.0; own.len()]]
        };
        let slides =
            |i: usize| if rows[i].place == Place::Along { data.dry[i] * rows[i].motion.direction } else { 0.0 };
        let model = [column(&|i| data.predicted[i]), column(&|i| data.resisting[i]), column(&slides)];
        let mut scan = Self {
            time_s: column(&|i| rows[i].motion.time_s),
            axes,
            basis: Vec::new(),
            residual: column(&|i| rows[i].target),
        };
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

    /// Sum of squares that the best step takes off the residual, and its time; it joins the model.
    fn next_step(&mut self) -> Option<(f64, f64)> {
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
        // The best step takes at most 8/9 of the power of a slope from zero.
        let slow = dot(&self.residual, &self.residual) * 8.0 / 9.0;
        let (gain, at, _) = best.filter(|(gain, at, size)| *gain > slow || self.is_sharp(*at, *size))?;
        for axis in self.axes.clone() {
            self.fit(axis.iter().enumerate().map(|(i, a)| if i >= at { *a } else { 0.0 }).collect());
        }
        Some((gain, HALF * (self.time_s[at - 1] + self.time_s[at])))
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

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
