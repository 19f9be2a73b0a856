//! From the estimates of a load to the named parameters of the result.

use super::doubts::{better_reading, doubts, is_unexplained};
use super::estimate::Estimate;
use super::observations::{Observed, observe};
use crate::identify::limits::SIGNIFICANT;
use foundation::estimate::{Correlated, EstimateError, Fit, Parameter, Quality};
use foundation::words::amount;
use haptics::recording::{Recording, WrenchFrame};
use nalgebra::DMatrix;

/// Name of the load in the results.
pub const PAYLOAD: &str = "payload";
/// Name of the sensor in the results.
pub const SENSOR: &str = "sensor";

/// Motion that tells weight and bias apart.
pub const SEPARATES: &str = "turn the sensor by 90 degrees about two axes, and rest in each orientation";
/// Coordinates of the centre of mass, and the moments that they follow from.
const COM: [(&str, &str); 3] = [("com_x_m", "moment_x_Nm"), ("com_y_m", "moment_y_Nm"), ("com_z_m", "moment_z_Nm")];

/// A parameter as a linear function of the estimates, about their values.
struct Published {
    object: &'static str,
    name: &'static str,
    value: f64,
    /// Derivative by each estimate.
    by: Vec<f64>,
    how: String,
    /// Reason why it is not known.
    unknown: Option<String>,
}

/// The fit of one recording.
///
/// # Errors
/// One sentence if orientation or force is missing, or if the statements about their frame contradict each other.
pub fn fit(recording: &Recording) -> Result<Fit, EstimateError> {
    let seen = observe(recording)?;
    let found = Estimate::of(&seen, seen.frame.unwrap_or(WrenchFrame::Sensor))?;
    let published = published(&seen, &found);
    let mut warnings = seen.warnings.clone();
    warnings.splice(0..0, doubts(&seen, &found));
    if found.weight_n().is_none() {
        let text = format!("the orientations of {} show only the sum of weight and bias; {SEPARATES}", seen.name);
        warnings.insert(0, text);
    }
    let quality = quality(&found, seen.noise_n);
    let is_doubted = better_reading(&seen, &found).is_some() || is_unexplained(&found);
    let torque = torque_quality(&found, seen.noise_nm);
    let qualities = [&quality, &torque].into_iter().flatten().filter(|_| !is_doubted);
    warnings.extend(qualities.filter_map(Quality::misfit));
    if !recording.meta.compensated.is_empty() {
        let text = "weight and bias were removed from this recording already: the values are what is left of them";
        warnings.insert(0, text.to_owned());
    }
    let error = |p: &Published| variance(&p.by, &found.covariance).max(0.0).sqrt();
    let parameter = |p: &Published| match &p.unknown {
        Some(why) => Parameter::unidentified(p.object, p.name, found.samples, why),
        None => Parameter::identified(p.object, p.name, p.value, error(p), found.samples, &p.how),
    };
    let far: Vec<&Published> = published.iter().filter(|p| p.name.starts_with("com_") && p.unknown.is_none()).collect();
    if let Some(p) = far.iter().find(|p| p.value.abs() > 2.0) {
        let text = format!(
            "{} is {}: no load hangs so far from its sensor; check units and frame of the torque",
            p.name,
            amount(p.value, "m")
        );
        warnings.insert(0, text);
    }
    Ok(Fit {
        task: "payload".to_owned(),
        parameters: published.iter().map(parameter).collect(),
        correlated: vec![correlated(&published, &found)],
        quality,
        warnings,
        ..Fit::default()
    })
}

fn variance(by: &[f64], covariance: &DMatrix<f64>) -> f64 {
    let product = |i: usize| (0..by.len()).map(|j| covariance[(i, j)] * by[j]).sum::<f64>();
    (0..by.len()).filter(|i| by[*i] != 0.0).map(|i| by[i] * product(i)).sum()
}

/// All parameters, the load's first.
fn published(seen: &Observed, found: &Estimate) -> Vec<Published> {
    let weight = found.weight_n();
    let count = found.rows.len();
    let along = |index: Option<usize>, slope: f64| {
        let mut by = vec![0.0; found.values.len()];
        if let Some(at) = index {
            by[at] = slope;
        }
        by
    };
    let at = found.index("weight_N");
    let mut all = Vec::new();
    let only_sum = || format!("the orientations show only the sum of weight and bias; {SEPARATES}");
    for (name, divisor) in [("weight_N", 1.0), ("mass_kg", seen.gravity_m_s2)] {
        if at.is_some() {
            all.push(Published {
                object: PAYLOAD,
                name,
                value: weight.map_or(0.0, |(w, _)| w / divisor),
                by: along(at, 1.0 / divisor),
                how: format!("part of the force that turns against the sensor, in {count} poses"),
                unknown: weight.is_none().then(only_sum),
            });
        }
    }
    for (name, moment) in COM {
        let place = found.index(moment);
        let shown = found.value(moment).zip(weight);
        let is_heavy = weight.is_some_and(|(w, e)| w.abs() > SIGNIFICANT * e && w != 0.0);
        let unknown = if place.is_none() {
            Some("the recording has no torques; add tx_Nm, ty_Nm and tz_Nm".to_owned())
        } else if weight.is_none() {
            Some(only_sum())
        } else if !is_heavy {
            Some("no weight is seen beside its error; hang something on the sensor".to_owned())
        } else {
            shown.is_none().then(|| format!("the orientations do not show it; {SEPARATES}"))
        };
        let (m, w) = shown.map_or((0.0, 1.0), |((m, _), (w, _))| (m, w));
        let mut by = along(place, 1.0 / w);
        if let Some(at) = at {
            by[at] = -m / (w * w);
        }
        let how = "moment of the load over its weight, from the sensor's origin in its axes".to_owned();
        all.push(Published { object: PAYLOAD, name, value: m / w, by, how, unknown });
    }
    for (i, (object, name)) in found.names.iter().enumerate().filter(|(_, (object, _))| *object == SENSOR) {
        let why = if name.contains("drift") { "the recording is too short for it".to_owned() } else { only_sum() };
        all.push(Published {
            object,
            name,
            value: found.values[i],
            by: along(Some(i), 1.0),
            how: how_of_sensor(name, found),
            unknown: (!found.identified[i]).then_some(why),
        });
    }
    all
}

fn how_of_sensor(name: &str, found: &Estimate) -> String {
    let axis = ["_x_", "_y_", "_z_"].iter().position(|axis| name.contains(axis)).unwrap_or(0);
    let left = if name.starts_with("torque") {
        found.rms_nm.map_or_else(String::new, |rms| amount(rms[axis], "N m"))
    } else {
        amount(found.rms_n[axis], "N")
    };
    if name.contains("drift") {
        return "change of the bias with time, in the sensor's axes".to_owned();
    }
    let when = if found.model.drift { " in the middle of the recording" } else { "" };
    format!("part that turns with the sensor, in its axes{when}; {left} of this component remain, RMS")
}

fn correlated(published: &[Published], found: &Estimate) -> Correlated {
    let shown: Vec<&Published> = published.iter().filter(|p| p.unknown.is_none()).collect();
    let pair = |a: &Published, b: &Published| {
        let product = |i: usize| (0..b.by.len()).map(|j| found.covariance[(i, j)] * b.by[j]).sum::<f64>();
        (0..a.by.len()).map(|i| a.by[i] * product(i)).sum::<f64>()
    };
    Correlated {
        parameters: shown.iter().map(|p| format!("{}.{}", p.object, p.name)).collect(),
        values: shown.iter().map(|p| p.value).collect(),
        covariance: shown.iter().map(|a| shown.iter().map(|b| pair(a, b)).collect()).collect(),
        shown_below: vec![f64::INFINITY; shown.len()],
    }
}

/// Residual of the torque. `noise`: of a sample's torque, N m.
fn torque_quality(found: &Estimate, noise: Option<f64>) -> Option<Quality> {
    let root = |squares: f64| (squares / 3.0).sqrt();
    let rms = root(found.rms_nm?.iter().map(|rms| rms * rms).sum());
    let squares: f64 = found.rows.iter().filter_map(|row| row.torque_nm).map(|torque| torque.norm_squared()).sum();
    let reading = root(squares / found.rows.len() as f64);
    let heldout_relative = rms / reading.max(f64::MIN_POSITIVE);
    Some(Quality { rms, heldout_rms: rms, heldout_relative, heldout_share: 0.0, noise, unit: "Nm".to_owned() })
}

/// Residual of the force; each pose is held out in turn. `noise`: of a pose's force, N.
fn quality(found: &Estimate, noise: Option<f64>) -> Option<Quality> {
    let heldout_rms = found.held_out_rms_n?;
    let square: f64 = found.rows.iter().map(|row| row.force_n.norm_squared()).sum();
    let reading = (square / (3 * found.rows.len()) as f64).sqrt();
    Some(Quality {
        rms: found.force_rms_n,
        heldout_rms,
        heldout_relative: heldout_rms / reading.max(f64::MIN_POSITIVE),
        noise,
        heldout_share: found.block as f64 / found.rows.len() as f64,
        unit: "N".to_owned(),
    })
}
