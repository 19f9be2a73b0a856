//! A recording without the weight of its load and without the bias of its sensor: the wrench of the contact alone.

use super::doubts::{better_reading, is_unexplained};
use super::estimate::Estimate;
use super::observations::observe;
use super::report::{PAYLOAD, SEPARATES};
use foundation::estimate::EstimateError;
use foundation::signal::wrench::{is_turned_sensor, orientations, wrench};
use haptics::recording::{Recording, WrenchFrame};
use nalgebra::{UnitQuaternion, Vector3};

/// Weight, moment, biases, and drifts that are removed.
#[derive(Clone, Debug)]
pub struct Removed {
    weight_n: f64,
    moment_nm: Vector3<f64>,
    /// Force, then torque.
    bias: [Vector3<f64>; 2],
    drift: [Vector3<f64>; 2],
    middle_s: f64,
    up: Vector3<f64>,
    frame: WrenchFrame,
    has_torque: bool,
}

/// Estimates that `recording` shows of its own load.
///
/// # Errors
/// One sentence if it shows no load, if it was compensated already, or if its frame is in doubt.
pub fn removed(recording: &Recording) -> Result<Removed, EstimateError> {
    let refuse = |why: String| Err(EstimateError::Other(why));
    let name = &recording.name;
    if !recording.meta.compensated.is_empty() {
        return refuse(format!(
            "weight and bias were removed from {name} already; convert the recording it was made from"
        ));
    }
    if !is_turned_sensor(recording) {
        return refuse(format!(
            "--compensate removes the weight of a load and the bias of a force/torque sensor, and {name} has no orientation beside a force in space; leave it out"
        ));
    }
    let seen = observe(recording)?;
    let frame = seen.frame.unwrap_or(WrenchFrame::Sensor);
    let found = Estimate::of(&seen, frame)?;
    if let Some(doubt) = better_reading(&seen, &found) {
        return refuse(format!("{name} is not compensated: {doubt}"));
    }
    if is_unexplained(&found) {
        return refuse(format!(
            "{name} is not compensated: load and bias explain little of its force; take them from poses in which nothing touches the sensor (--compensate=POSES.csv)"
        ));
    }
    let Some((weight_n, _)) = found.weight_n().filter(|_| found.value("force_bias_x_N").is_some()) else {
        return refuse(format!(
            "{name} is not compensated: its orientations show only the sum of weight and bias; {SEPARATES}"
        ));
    };
    let vector = |names: [&str; 3]| Vector3::from(names.map(|name| found.value(name).map_or(0.0, |(value, _)| value)));
    Ok(Removed {
        weight_n,
        moment_nm: vector(["moment_x_Nm", "moment_y_Nm", "moment_z_Nm"]),
        bias: [
            vector(["force_bias_x_N", "force_bias_y_N", "force_bias_z_N"]),
            vector(["torque_bias_x_Nm", "torque_bias_y_Nm", "torque_bias_z_Nm"]),
        ],
        drift: [
            vector(["force_drift_x_N_s", "force_drift_y_N_s", "force_drift_z_N_s"]),
            vector(["torque_drift_x_Nm_s", "torque_drift_y_Nm_s", "torque_drift_z_Nm_s"]),
        ],
        middle_s: found.middle_s,
        up: seen.up,
        frame,
        has_torque: found.value("moment_x_Nm").is_some(),
    })
}

impl Removed {
    /// The same for another recording of the same sensor and load: its clock is another one, so no drift is removed.
    #[must_use]
    pub fn without_drift(self) -> Self {
        Self { drift: [Vector3::zeros(); 2], ..self }
    }

    /// Force and torque of load and bias in the sensor's axes.
    fn reading(&self, turned: &UnitQuaternion<f64>, time_s: f64) -> [Vector3<f64>; 2] {
        let down = turned.inverse() * -self.up;
        let bias = |k: usize| self.bias[k] + self.drift[k] * (time_s - self.middle_s);
        [down * self.weight_n + bias(0), self.moment_nm.cross(&down) + bias(1)]
    }

    /// Values that are removed, named as in a fit.
    fn named(&self) -> Vec<(String, f64)> {
        let mut all = vec![(format!("{PAYLOAD}.weight_N"), self.weight_n)];
        let triples = [
            ("force_bias", "N", self.bias[0]),
            ("torque_bias", "Nm", self.bias[1]),
            ("force_drift", "N_s", self.drift[0]),
            ("torque_drift", "Nm_s", self.drift[1]),
        ];
        let com_m = if self.weight_n == 0.0 { Vector3::zeros() } else { self.moment_nm / self.weight_n };
        for (k, axis) in ["x", "y", "z"].into_iter().enumerate() {
            if self.has_torque {
                all.push((format!("{PAYLOAD}.com_{axis}_m"), com_m[k]));
            }
            let shown =
                triples.iter().filter(|(name, _, v)| (self.has_torque || name.starts_with('f')) && v.norm() > 0.0);
            all.extend(shown.map(|(name, unit, v)| (format!("{}.{name}_{axis}_{unit}", super::SENSOR), v[k])));
        }
        all
    }
}

/// `recording` without `removed`, in the frame and with the signs of its own columns. Its sidecar states what was removed.
///
/// # Errors
/// One sentence if its columns do not show orientation and force, or if a sample has no orientation.
pub fn compensated(recording: &Recording, removed: &Removed) -> Result<Recording, EstimateError> {
    let name = &recording.name;
    let missing =
        || EstimateError::Other(format!("{name} has no orientation beside a force in space and cannot be compensated"));
    if !recording.meta.compensated.is_empty() {
        return Err(EstimateError::Other(format!(
            "weight and bias were removed from {name} already; convert the recording it was made from"
        )));
    }
    let turned = orientations(recording).ok_or_else(missing)?;
    let read = wrench(recording).ok_or_else(missing)?;
    let frame = read.frame.unwrap_or(removed.frame);
    let mut other = recording.clone();
    for (k, names) in [(0, &read.force_names), (1, &read.torque_names)] {
        if k == 1 && (read.torque.is_none() || !removed.has_torque) {
            continue;
        }
        for (i, turned) in turned.iter().enumerate() {
            let turned = turned.ok_or_else(|| {
                EstimateError::Other(format!("row {} of {name} has no orientation; remove it before", i + 1))
            })?;
            let time_s = recording.time_s.as_ref().map_or(removed.middle_s, |time| time[i]);
            let own = removed.reading(&turned, time_s)[k];
            let shown = if frame == WrenchFrame::Base { turned * own } else { own };
            for (axis, name) in names.iter().enumerate() {
                if let Some(channel) = other.channels.iter_mut().find(|c| c.name == *name) {
                    channel.values[i] -= shown[axis];
                }
            }
        }
    }
    other.meta.compensated = removed.named().into_iter().collect();
    if read.force_names[0] == "fx_N" {
        other.meta.wrench_frame = Some(frame);
    }
    Ok(other)
}
