//! Weight, centre of mass, biases, and drifts with their joint covariance.

use super::observations::{Observation, Observed};
use crate::regression::blocks::{Block, Solved, solve};
use foundation::estimate::EstimateError;
use haptics::recording::WrenchFrame;
use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};

/// Parts of the model of a reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Model {
    /// Load: its weight, and its moment.
    pub load: bool,
    /// Biases.
    pub bias: bool,
    /// Drifts of the biases.
    pub drift: bool,
}

/// Reading of a pose in the sensor's axes.
#[derive(Clone, Debug)]
pub struct Row {
    /// Time from the middle, s.
    pub since_s: f64,
    /// Unit vector along gravity.
    pub down: Vector3<f64>,
    /// Gravity's axes: base to sensor.
    pub to_sensor: Matrix3<f64>,
    /// Force, N.
    pub force_n: Vector3<f64>,
    /// Torque, N m.
    pub torque_nm: Option<Vector3<f64>>,
}

/// The estimates of one recording, in the order of [`Estimate::names`].
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Poses in the sensor's axes.
    pub rows: Vec<Row>,
    /// Frame that the columns were read in.
    pub frame: WrenchFrame,
    /// The model.
    pub model: Model,
    /// Time that the biases are given for, s.
    pub middle_s: f64,
    /// `(object, name)` of each value.
    pub names: Vec<(&'static str, &'static str)>,
    /// Values: weight in N, moment W r in N m, biases in N and N m, drifts in N/s and N m/s.
    pub values: Vec<f64>,
    /// Covariance of the values, with few degrees of freedom counted in.
    pub covariance: DMatrix<f64>,
    /// Degrees of freedom of each value's error.
    pub freedom: Vec<f64>,
    /// False for a value that the recording does not show.
    pub identified: Vec<bool>,
    /// Weight that was stated, N.
    pub known_weight_n: Option<f64>,
    /// Residual RMS of the force components, N.
    pub rms_n: [f64; 3],
    /// Residual RMS of the torque components, N m.
    pub rms_nm: Option<[f64; 3]>,
    /// Residual RMS of the force, N.
    pub force_rms_n: f64,
    /// The same of poses that took no part in the fit, N.
    pub held_out_rms_n: Option<f64>,
    /// Number of samples.
    pub samples: usize,
    /// Number of poses of a block of the covariance.
    pub block: usize,
}

/// Names of the values of the force and of the torque, the load first.
const FORCE: [&str; 7] = [
    "weight_N",
    "force_bias_x_N",
    "force_bias_y_N",
    "force_bias_z_N",
    "force_drift_x_N_s",
    "force_drift_y_N_s",
    "force_drift_z_N_s",
];
const TORQUE: [&str; 9] = [
    "moment_x_Nm",
    "moment_y_Nm",
    "moment_z_Nm",
    "torque_bias_x_Nm",
    "torque_bias_y_Nm",
    "torque_bias_z_Nm",
    "torque_drift_x_Nm_s",
    "torque_drift_y_Nm_s",
    "torque_drift_z_Nm_s",
];

/// Poses in the sensor's axes, if the columns have `frame`. `other`: another reading of an orientation.
pub(super) fn rows(
    seen: &Observed,
    frame: WrenchFrame,
    other: &dyn Fn(&UnitQuaternion<f64>) -> UnitQuaternion<f64>,
) -> Vec<Row> {
    let row = |pose: &Observation| {
        let turned = other(&pose.turned);
        let to_sensor = turned.inverse();
        let own = |v: Vector3<f64>| if frame == WrenchFrame::Base { to_sensor * v } else { v };
        Row {
            since_s: pose.time_s - seen.middle_s,
            down: to_sensor * -seen.up,
            to_sensor: *to_sensor.to_rotation_matrix().matrix(),
            force_n: own(pose.force_n),
            torque_nm: pose.torque_nm.map(own),
        }
    };
    seen.poses.iter().map(row).collect()
}

/// Rows of a block: the load's regressors, then bias and drift of each component.
fn block(rows: &[Row], model: Model, load: &dyn Fn(&Row) -> DMatrix<f64>, y: &dyn Fn(&Row) -> Vector3<f64>) -> Block {
    let loads = if model.load { rows.first().map_or(0, |row| load(row).ncols()) } else { 0 };
    let columns = loads + if model.bias { 3 } else { 0 } + if model.drift { 3 } else { 0 };
    let mut x = DMatrix::zeros(3 * rows.len(), columns);
    let mut right = DVector::zeros(3 * rows.len());
    for (k, row) in rows.iter().enumerate() {
        let mut at = loads;
        if model.load {
            x.view_mut((3 * k, 0), (3, loads)).copy_from(&load(row));
        }
        for (is_in, factor) in [(model.bias, 1.0), (model.drift, row.since_s)] {
            if is_in {
                x.view_mut((3 * k, at), (3, 3)).copy_from(&(Matrix3::identity() * factor));
                at += 3;
            }
        }
        right.rows_mut(3 * k, 3).copy_from(&y(row));
    }
    Block { x, y: right }
}

/// The force by a model: one direction of gravity, or with `is_free` one that is estimated in the base's axes.
pub(super) fn of_force(rows: &[Row], model: Model, known_n: Option<f64>, size: usize, is_free: bool) -> Solved {
    let load = |row: &Row| {
        if is_free {
            DMatrix::from_fn(3, 3, |i, j| row.to_sensor[(i, j)])
        } else {
            DMatrix::from_fn(3, 1, |i, _| row.down[i])
        }
    };
    let model = Model { load: model.load && known_n.is_none(), ..model };
    let y = |row: &Row| row.force_n - row.down * known_n.unwrap_or(0.0);
    solve(&rows.chunks(size.max(1)).map(|rows| block(rows, model, &load, &y)).collect::<Vec<_>>())
}

/// The torque by a model, with the moment W r of the load.
fn of_torque(rows: &[Row], model: Model, size: usize) -> Option<Solved> {
    if rows.iter().any(|row| row.torque_nm.is_none()) {
        return None;
    }
    // W r × down = −[down]× (W r).
    let load = |row: &Row| {
        let across = row.down.cross_matrix();
        DMatrix::from_fn(3, 3, |i, j| -across[(i, j)])
    };
    let y = |row: &Row| row.torque_nm.unwrap_or_default();
    Some(solve(&rows.chunks(size.max(1)).map(|rows| block(rows, model, &load, &y)).collect::<Vec<_>>()))
}

/// Residual of the force by a model.
pub struct Left {
    /// Root mean square, N.
    pub rms_n: f64,
    /// Mean square of each block by a fit without it, N²; that of the fit itself where the others do not show all that it needs.
    pub held_out: Vec<f64>,
    /// Square of the correlation of neighbouring blocks, times their components: of one degree of freedom if they are white.
    pub correlated: f64,
}

/// Residual of the force by a model.
pub fn left_by(rows: &[Row], model: Model, size: usize) -> Left {
    let solved = of_force(rows, model, None, size, false);
    let square = |r: &DVector<f64>| r.norm_squared() / r.len().max(1) as f64;
    let out = solved.left_out.iter().zip(&solved.residuals);
    let whole = |pair: &&[DVector<f64>]| pair[0].len() == pair[1].len();
    let power: f64 = solved.residuals.iter().map(DVector::norm_squared).sum();
    let next: f64 = solved.residuals.windows(2).filter(whole).map(|w| w[0].dot(&w[1])).sum();
    let components: usize = solved.residuals.iter().map(DVector::len).sum();
    Left {
        rms_n: solved.rms(),
        held_out: out.map(|(out, own)| square(out.as_ref().unwrap_or(own))).collect(),
        correlated: if power > 0.0 { (next / power).powi(2) * components as f64 } else { 0.0 },
    }
}

/// Number of neighbouring poses of a block, from the correlation of their residuals: some correlation times, and at least
/// five blocks.
fn block_size(residuals: &[DVector<f64>]) -> usize {
    let power: f64 = residuals.iter().map(DVector::norm_squared).sum();
    let next: f64 = residuals.windows(2).map(|w| w[0].dot(&w[1])).sum();
    let n = residuals.len();
    let correlation = next / power;
    // Three components a pose; two standard deviations of the correlation of independent ones.
    if correlation.is_nan() || correlation * correlation * 3.0 * n as f64 <= 4.0 || correlation <= 0.0 {
        return 1;
    }
    let time = (1.0 + correlation) / (1.0 - correlation).max(1e-3);
    (2.0 * time).ceil().min((n / 5) as f64).max(1.0) as usize
}

impl Estimate {
    /// Estimates of the poses seen, their columns read in `frame`.
    ///
    /// # Errors
    /// One sentence without a pose.
    pub fn of(seen: &Observed, frame: WrenchFrame) -> Result<Self, EstimateError> {
        if seen.poses.is_empty() {
            return Err(EstimateError::TooFewSamples {
                recording: seen.name.clone(),
                samples: 0,
                what: " with an orientation and a force".to_owned(),
                needed: 1,
            });
        }
        let rows = rows(seen, frame, &|turned| *turned);
        // Drifts need twice as many readings as unknowns: few poses are better spent on the weight.
        let is_timed = seen.has_clock && rows.iter().any(|row| row.since_s.abs() > 0.0);
        let model = Model { load: true, bias: true, drift: is_timed && 3 * rows.len() >= 2 * FORCE.len() };
        let known_n = seen.known_weight_n;
        let size = block_size(&of_force(&rows, model, known_n, 1, false).residuals);
        let force = of_force(&rows, model, known_n, size, false);
        let torque = of_torque(&rows, model, size);
        let mut names: Vec<&'static str> = Vec::new();
        let drifts = if model.drift { 3 } else { 0 };
        names.extend(&FORCE[usize::from(known_n.is_some())..4 + drifts]);
        if torque.is_some() {
            names.extend(&TORQUE[..6 + drifts]);
        }
        let all: Vec<&Solved> = std::iter::once(&force).chain(&torque).collect();
        let influence = |c: usize| -> Vec<f64> {
            all.iter().flat_map(|s| s.influence[c].iter().zip(s.widening()).map(|(v, w)| v * w)).collect()
        };
        let mut covariance = DMatrix::zeros(names.len(), names.len());
        for c in 0..force.influence.len() {
            let psi = DVector::from_vec(influence(c));
            covariance += &psi * psi.transpose();
        }
        let reading = reading(&rows);
        let is_shown = |(at, is_seen): (usize, bool)| {
            let size = if names[at].ends_with("Nm") || names[at].ends_with("Nm_s") { reading[1] } else { reading[0] };
            // An error as large as the reading says nothing.
            let error = covariance[(at, at)].sqrt() * if names[at].contains("drift") { span_s(&rows) } else { 1.0 };
            is_seen && rows.len() > 1 && error <= size
        };
        let identified = all.iter().flat_map(|s| s.identified.iter().copied()).enumerate().map(is_shown).collect();
        Ok(Self {
            frame,
            model,
            middle_s: seen.middle_s,
            values: all.iter().flat_map(|s| s.values.iter().copied()).collect(),
            names: names.into_iter().map(|name| (object_of(name), name)).collect(),
            covariance,
            freedom: all.iter().flat_map(|s| s.freedom.iter().copied()).collect(),
            identified,
            known_weight_n: known_n,
            rms_n: by_component(&force.residuals),
            rms_nm: torque.as_ref().map(|torque| by_component(&torque.residuals)),
            force_rms_n: force.rms(),
            held_out_rms_n: force.held_out_rms(),
            samples: seen.poses.iter().map(|pose| pose.samples).sum(),
            block: size,
            rows,
        })
    }

    /// Place of a value.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|(_, own)| *own == name)
    }

    /// A value and its standard error.
    pub fn value(&self, name: &str) -> Option<(f64, f64)> {
        let at = self.index(name).filter(|at| self.identified[*at])?;
        Some((self.values[at], self.covariance[(at, at)].max(0.0).sqrt()))
    }

    /// Weight and its standard error, N.
    pub fn weight_n(&self) -> Option<(f64, f64)> {
        self.known_weight_n.map(|weight| (weight, 0.0)).or_else(|| self.value(FORCE[0]))
    }
}

/// Object that a value is of.
fn object_of(name: &str) -> &'static str {
    if name == FORCE[0] || TORQUE[..3].contains(&name) { super::PAYLOAD } else { super::SENSOR }
}

/// Root mean square of the readings: of the force, N, and of the torque, N m.
fn reading(rows: &[Row]) -> [f64; 2] {
    let rms = |of: &dyn Fn(&Row) -> Vector3<f64>| {
        (rows.iter().map(|row| of(row).norm_squared()).sum::<f64>() / rows.len().max(1) as f64).sqrt()
    };
    [rms(&|row| row.force_n), rms(&|row| row.torque_nm.unwrap_or_default())]
}

/// Time from the first pose to the last, s.
fn span_s(rows: &[Row]) -> f64 {
    rows.last().map_or(0.0, |last| last.since_s) - rows.first().map_or(0.0, |first| first.since_s)
}

fn by_component(residuals: &[DVector<f64>]) -> [f64; 3] {
    let of = |axis: usize| {
        let all = residuals.iter().flat_map(|r| r.iter().skip(axis).step_by(3));
        let (sum, count) = all.fold((0.0, 0), |(sum, count), r| (sum + r * r, count + 1));
        (sum / f64::from(count.max(1))).sqrt()
    };
    [of(0), of(1), of(2)]
}
