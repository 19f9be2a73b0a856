//! From samples to poses: one observation for every orientation that was held, or passed through slowly.

use crate::identify::mechanism::saturated;
use crate::segment::poses::{ARM_M, COM_M, ENOUGH_RESTS, REST_RAD_S, REST_S, Rates, SLOW_SHARE, poses, rates};
use foundation::estimate::EstimateError;
use foundation::signal::wrench::{Wrench, orientations, vector, wrench};
use haptics::recording::{Recording, WrenchFrame};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use std::ops::Range;

/// Mean reading of one pose.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Mean time, s; the number of the pose without a clock.
    pub time_s: f64,
    /// Mean orientation, sensor to base.
    pub turned: UnitQuaternion<f64>,
    /// Mean force in the frame of the columns, N.
    pub force_n: Vector3<f64>,
    /// Mean torque about the sensor's origin in the frame of the columns, N m.
    pub torque_nm: Option<Vector3<f64>>,
    /// Number of samples.
    pub samples: usize,
}

/// Readings of one recording, by pose.
#[derive(Clone, Debug)]
pub struct Observed {
    /// Name of the recording.
    pub name: String,
    /// The poses, in their order.
    pub poses: Vec<Observation>,
    /// Frame of the force columns; none if nothing states it.
    pub frame: Option<WrenchFrame>,
    /// Names of the force columns.
    pub force_names: [String; 3],
    /// True if the orientation is a matrix.
    pub has_matrix: bool,
    /// Upward unit vector in the base frame.
    pub up: Vector3<f64>,
    /// Gravity, m/s².
    pub gravity_m_s2: f64,
    /// Weight that the sidecar states, N.
    pub known_weight_n: Option<f64>,
    /// True with times.
    pub has_clock: bool,
    /// Middle of the recording, s: the time that the biases are given for.
    pub middle_s: f64,
    /// Standard deviation of single samples within a pose, N; none if no pose has several.
    pub noise_n: Option<f64>,
    /// The same of the torque, N m.
    pub noise_nm: Option<f64>,
    /// Sentences about samples that were left out.
    pub warnings: Vec<String>,
}

/// Samples that have an orientation and a reading.
struct Samples {
    rows: Vec<usize>,
    time_s: Option<Vec<f64>>,
    turned: Vec<UnitQuaternion<f64>>,
    force_n: Vec<Vector3<f64>>,
    torque_nm: Option<Vec<Vector3<f64>>>,
}

/// Upward unit vector in the base frame: z unless the sidecar states another axis.
fn up(recording: &Recording) -> Result<Vector3<f64>, EstimateError> {
    Ok(match recording.meta.up.as_deref().unwrap_or("z") {
        "x" => Vector3::x(),
        "-x" => -Vector3::x(),
        "y" => Vector3::y(),
        "-y" => -Vector3::y(),
        "-z" => -Vector3::z(),
        "none" => {
            return Err(EstimateError::Other(format!(
                "the sidecar of {} says that gravity does not act (\"up\": \"none\"), so no weight can be seen; state the axis of the base that points up",
                recording.name
            )));
        }
        _ => Vector3::z(),
    })
}

/// Poses of a recording with their mean readings.
///
/// # Errors
/// One sentence if orientation or force is missing, or if names and sidecar contradict each other about the frame.
pub fn observe(recording: &Recording) -> Result<Observed, EstimateError> {
    let missing = |column: &str| EstimateError::MissingColumn {
        task: "the load of a sensor".to_owned(),
        column: column.to_owned(),
        recording: recording.name.clone(),
    };
    let turned = orientations(recording).ok_or_else(|| missing("qx, qy, qz, qw, or r11 to r33"))?;
    let read = wrench(recording).ok_or_else(|| missing("fx_N, fy_N and fz_N"))?;
    if let Some((stated, named)) = recording.meta.wrench_frame.zip(read.frame).filter(|(a, b)| a != b) {
        return Err(EstimateError::Other(format!(
            "the sidecar of {} says \"wrench_frame\": \"{}\", and its columns are called {} ({}); remove one of both statements",
            recording.name,
            stated.name(),
            read.force_names[0],
            named.name()
        )));
    }
    let samples = samples(recording, &turned, &read);
    let mut warnings = Vec::new();
    let lost = turned.iter().filter(|turned| turned.is_none()).count();
    if lost > 0 {
        warnings.push(format!("{lost} sample(s) of {} without an orientation are left out", recording.name));
    }
    let point_m = crate::identify::mechanism::path::points(recording)
        .filter(|_| recording.channel("z_m").is_some())
        .map(|all| samples.rows.iter().map(|i| all[*i]).collect::<Vec<_>>());
    let found = samples.time_s.as_ref().and_then(|time_s| rates(time_s, &samples.turned, point_m.as_deref()));
    let runs = still(&samples, found.as_ref(), recording, &mut warnings);
    let poses: Vec<Observation> = runs.iter().enumerate().map(|(k, run)| samples.mean(run, k)).collect();
    Ok(Observed {
        name: recording.name.clone(),
        noise_n: noise(&samples.force_n, &runs),
        noise_nm: samples.torque_nm.as_ref().and_then(|torque_nm| noise(torque_nm, &runs)),
        poses,
        frame: read.frame,
        force_names: read.force_names,
        has_matrix: recording.channel("qw").is_none(),
        up: up(recording)?,
        gravity_m_s2: recording.meta.gravity(),
        known_weight_n: ["weight_N", "payload.weight_N"]
            .iter()
            .find_map(|name| recording.meta.known.get(*name))
            .copied(),
        has_clock: recording.time_s.is_some(),
        middle_s: recording.time_s.as_ref().and_then(|t| Some(0.5 * (t.first()? + t.last()?))).unwrap_or(0.0),
        warnings,
    })
}

fn samples(recording: &Recording, turned: &[Option<UnitQuaternion<f64>>], read: &Wrench<'_>) -> Samples {
    let names = read.force_names.iter().chain(&read.torque_names).map(String::as_str);
    let at_limit = saturated(recording, &names.collect::<Vec<_>>());
    let is_read =
        |i: &usize| turned[*i].is_some() && !at_limit[*i] && vector(&read.force, *i).iter().all(|v| v.is_finite());
    let rows: Vec<usize> = (0..recording.len()).filter(is_read).collect();
    let vectors = |columns: &[&[f64]; 3]| rows.iter().map(|i| vector(columns, *i)).collect::<Vec<_>>();
    Samples {
        time_s: recording.time_s.as_ref().map(|time| rows.iter().map(|i| time[*i]).collect()),
        turned: rows.iter().filter_map(|i| turned[*i]).collect(),
        force_n: vectors(&read.force),
        torque_nm: read.torque.as_ref().map(vectors).filter(|all| all.iter().flatten().all(|v| v.is_finite())),
        rows,
    }
}

/// Runs of one orientation without inertia: rests if they are enough, else slow motion, else all.
fn still(
    samples: &Samples,
    rates: Option<&Rates>,
    recording: &Recording,
    warnings: &mut Vec<String>,
) -> Vec<Range<usize>> {
    let Some(rates) = rates else { return poses(&samples.turned, &|_| true) };
    let mut rests = poses(&samples.turned, &|i| rates.speed_rad_s[i] < REST_RAD_S);
    // A slow swing stands for a moment at its ends, where its inertia is largest.
    rests.retain(|run| samples.lasts(run));
    let all = samples.turned.len();
    let rest: usize = rests.iter().map(Range::len).sum();
    if rests.len() >= ENOUGH_RESTS && 3 * rest >= all || rest == all {
        return rests;
    }
    let (name, limit) = (&recording.name, SLOW_SHARE * recording.meta.gravity());
    let acceleration = |i: usize| match &rates.origin_m_s2 {
        Some(origin) => origin[i] + COM_M * rates.turning_m_s2[i],
        None => ARM_M * rates.turning_m_s2[i],
    };
    let slow = poses(&samples.turned, &|i| acceleration(i) < limit);
    let kept: usize = slow.iter().map(Range::len).sum();
    if 4 * kept < all || slow.len() < ENOUGH_RESTS {
        warnings.push(format!(
            "the sensor of {name} is moved so fast that inertia acts on its load nearly all the time: values are those of a sensor at rest only as far as that averages out; stop in several orientations"
        ));
        return poses(&samples.turned, &|_| true);
    }
    if kept < all {
        warnings.push(format!(
            "{} of {all} samples of {name} are left out: the sensor is moved so fast there that the inertia of its load matters",
            all - kept
        ));
    }
    slow
}

impl Samples {
    /// Mean of a run of samples; `number`: place of the pose.
    fn mean(&self, run: &Range<usize>, number: usize) -> Observation {
        let count = run.len() as f64;
        let mean = |all: &[Vector3<f64>]| all[run.clone()].iter().sum::<Vector3<f64>>() / count;
        let sum: Matrix3<f64> = self.turned[run.clone()].iter().map(|r| *r.to_rotation_matrix().matrix()).sum();
        Observation {
            time_s: self.time_s.as_ref().map_or(number as f64, |t| t[run.clone()].iter().sum::<f64>() / count),
            turned: if run.len() == 1 { self.turned[run.start] } else { UnitQuaternion::from_matrix(&(sum / count)) },
            force_n: mean(&self.force_n),
            torque_nm: self.torque_nm.as_ref().map(|all| mean(all)),
            samples: run.len(),
        }
    }

    /// True for a run that is long enough to be a rest.
    fn lasts(&self, run: &Range<usize>) -> bool {
        self.time_s.as_ref().is_none_or(|t| {
            let step_s = (t[t.len() - 1] - t[0]) / (t.len() - 1).max(1) as f64;
            t[run.end - 1] - t[run.start] + step_s >= REST_S
        })
    }
}

/// Standard deviation of a component between neighbouring samples of one pose.
fn noise(values: &[Vector3<f64>], runs: &[Range<usize>]) -> Option<f64> {
    let steps = |run: &Range<usize>| (run.start + 1..run.end).map(|i| values[i] - values[i - 1]);
    let count: usize = runs.iter().map(|run| run.len() - 1).sum();
    let squares: f64 = runs.iter().flat_map(steps).map(|step| step.norm_squared()).sum();
    // A step has the variance of two samples, in three components.
    (count > 0).then(|| (squares / (6 * count) as f64).sqrt())
}
