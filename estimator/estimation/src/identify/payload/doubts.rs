//! Doubts about a load: another frame or another convention explains the readings better, something else acts on the
//! sensor, the base is tilted, values that cannot be meant.

use super::estimate::{Estimate, of_force, rows};
use super::observations::Observed;
use crate::identify::limits::{CLEARLY_SIGNIFICANT, SIGNIFICANT};
use foundation::words::amount;
use haptics::recording::WrenchFrame;
use nalgebra::{Quaternion, UnitQuaternion};

/// A reading of the orientation columns: as they are, base to sensor, scalar first.
type Reading = fn(&UnitQuaternion<f64>) -> UnitQuaternion<f64>;

/// A unit quaternion whose columns x y z w hold w x y z.
fn scalar_first(turned: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(turned.i, turned.j, turned.k, turned.w))
}

/// One sentence if another frame of the wrench, or another convention of the orientation, explains the force much better.
///
/// Of the residual, less than half must remain: a wrong reading leaves as much as the weight.
pub fn better_reading(seen: &Observed, found: &Estimate) -> Option<String> {
    let inverse = if seen.has_matrix {
        "an orientation that turns from the base to the sensor (\"columns\": {\"r12\": \"r21\", \"r21\": \"r12\", \"r13\": \"r31\", \
         \"r31\": \"r13\", \"r23\": \"r32\", \"r32\": \"r23\"})"
    } else {
        "an orientation that turns from the base to the sensor (\"sign\": {\"qx\": -1, \"qy\": -1, \"qz\": -1})"
    };
    let readings: [(Reading, &str); 3] = [
        (|r| *r, ""),
        (|r| r.inverse(), inverse),
        (
            scalar_first,
            "a quaternion with its scalar first (\"columns\": {\"qw\": \"qx\", \"qx\": \"qy\", \"qy\": \"qz\", \"qz\": \"qw\"})",
        ),
    ];
    let is_other = |frame: WrenchFrame, words: &str| frame != found.frame || !words.is_empty();
    let readings = readings.into_iter().take(if seen.has_matrix { 2 } else { 3 });
    let all = [found.frame, found.frame.other()]
        .into_iter()
        .flat_map(|frame| readings.clone().map(move |(r, words)| (frame, r, words)));
    let rms = |(frame, reading, words): (WrenchFrame, Reading, &'static str)| {
        let rows = rows(seen, frame, &reading);
        (of_force(&rows, found.model, found.known_weight_n, 1, false).rms(), frame, words)
    };
    let best = all.filter(|(frame, _, words)| is_other(*frame, words)).map(rms).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (rms_n, frame, words) = best;
    if 2.0 * rms_n >= found.force_rms_n {
        return None;
    }
    let frame_words = format!("a wrench in the axes of the {} (\"wrench_frame\": \"{}\")", frame.name(), frame.name());
    let said: Vec<&str> =
        [(frame != found.frame).then_some(frame_words.as_str()), Some(words).filter(|w| !w.is_empty())]
            .into_iter()
            .flatten()
            .collect();
    let assumed = if seen.frame.is_none() { ", which nothing states" } else { "" };
    Some(format!(
        "the readings do not follow the orientation: in the axes of the {}{assumed}, {} remain; with {} in the sidecar, {} remain. If that is right, state it",
        found.frame.name(),
        amount(found.force_rms_n, "N"),
        said.join(" and "),
        amount(rms_n, "N")
    ))
}

/// Share of the change of the reading, and of the reading, that load and bias leave.
pub fn unexplained(found: &Estimate) -> [f64; 2] {
    let n = found.rows.len().max(1) as f64;
    let mean = found.rows.iter().map(|row| row.force_n).sum::<nalgebra::Vector3<f64>>() / n;
    let rms = |of: &dyn Fn(&super::estimate::Row) -> f64| (found.rows.iter().map(of).sum::<f64>() / (3.0 * n)).sqrt();
    let (change, reading) = (rms(&|row| (row.force_n - mean).norm_squared()), rms(&|row| row.force_n.norm_squared()));
    [found.force_rms_n / change.max(f64::MIN_POSITIVE), found.force_rms_n / reading.max(f64::MIN_POSITIVE)]
}

/// True if most of the change of the reading goes with neither the load nor the bias, and not for want of both.
pub fn is_unexplained(found: &Estimate) -> bool {
    let [of_change, of_reading] = unexplained(found);
    // A sensor without a load changes by its errors alone, which are small beside its bias.
    2.0 * of_change > 1.0 && 5.0 * of_reading > 1.0 && found.rows.len() > 1
}

/// Angle between the stated vertical and gravity, and its standard error, rad, if it is significant.
pub fn tilt_rad(seen: &Observed, found: &Estimate) -> Option<(f64, f64)> {
    let free = of_force(&found.rows, found.model, None, found.block, true);
    if found.known_weight_n.is_some() || free.identified.iter().take(3).any(|is| !is) {
        return None;
    }
    let weight = nalgebra::Vector3::from_iterator(free.values.iter().take(3).copied());
    let across = weight - seen.up * seen.up.dot(&weight);
    let side = across.try_normalize(f64::MIN_POSITIVE)?;
    let widening = free.widening();
    let error = |psi: &nalgebra::DVector<f64>| (0..3).map(|j| psi[j] * widening[j] * side[j]).sum::<f64>().powi(2);
    let error_n = free.influence.iter().map(error).sum::<f64>().sqrt();
    // The direction across is the largest of two: the level of one comparison is too low.
    (across.norm() > CLEARLY_SIGNIFICANT * error_n)
        .then(|| (across.norm().atan2(-seen.up.dot(&weight)), error_n / weight.norm()))
}

/// All doubts, the most important first.
pub fn doubts(seen: &Observed, found: &Estimate) -> Vec<String> {
    let mut said = Vec::new();
    let better = better_reading(seen, found);
    if better.is_none() && is_unexplained(found) {
        said.push(format!(
            "load and bias leave {} of a force that changes with the pose: it is touched, or moved fast, or the orientation has another convention (base to sensor, scalar first, left-handed axes); the values are doubtful",
            amount(found.force_rms_n, "N")
        ));
    } else if seen.frame.is_none() && better.is_none() {
        said.push(format!(
            "nothing states the axes of {}: those of the sensor are assumed; state \"wrench_frame\": \"sensor\" in the sidecar if that is right",
            seen.force_names[0]
        ));
    }
    let is_fine = better.is_none();
    // A residual of rounding errors is no accuracy.
    let is_few = unexplained(found)[1] > 1e-9 && found.rows.len() < 3 * found.values.len();
    said.extend(better);
    if let Some((weight, error)) = found.weight_n().filter(|(weight, error)| *weight < -SIGNIFICANT * error) {
        said.push(format!(
            "the weight comes out at {} ± {}, below zero: the sensor states the opposite of the force{}, or another axis points up (\"up\")",
            amount(weight, "N"),
            amount(error, "N"),
            if found.rms_nm.is_some() {
                ", and most likely of the torque, so that its six columns need the \"sign\" -1 in the sidecar"
            } else {
                " (\"sign\" in the sidecar)"
            }
        ));
    }
    if let Some((angle, error)) = tilt_rad(seen, found).filter(|_| is_fine && !is_unexplained(found)) {
        said.push(format!(
            "gravity lies {:.2} ± {:.2} degrees off the stated vertical: the base is not level, or its axis is not the vertical; a tilt makes weight and bias slightly wrong",
            angle.to_degrees(),
            error.to_degrees()
        ));
    }
    if let Some(held_out) = found.held_out_rms_n.filter(|held_out| is_few && *held_out > 1.1 * found.force_rms_n) {
        said.push(format!(
            "the residual of {} is smaller than the error of a new pose: of {} poses, each without taking part is met to {}; more poses show the accuracy",
            amount(found.force_rms_n, "N"),
            found.rows.len(),
            amount(held_out, "N")
        ));
    }
    said
}
