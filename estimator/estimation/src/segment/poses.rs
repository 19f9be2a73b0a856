//! Poses of a sensor that is turned: angular speed, acceleration, and the runs of samples with one orientation.

use foundation::estimate::EstimateError;
use foundation::signal::wrench::orientations;
use haptics::recording::Recording;
use nalgebra::{UnitQuaternion, Vector3};
use std::ops::Range;

/// Time to either side over which rates are taken, s. A sensor that was turned rings no longer than about twice that, and
/// shorter rests are not counted.
const REACH_S: f64 = 0.25;
/// Angular speed below which a sensor rests, rad/s: 3 degrees a second, far above the noise of an encoder or of a tracker
/// over half a second, far below the speed of a robot or a hand.
pub const REST_RAD_S: f64 = 0.05;
/// Shortest rest, s: twice the reach of a rate.
pub const REST_S: f64 = 2.0 * REACH_S;
/// Angle within which samples have one orientation, rad: the direction of a weight is off by at most half of it, and its
/// mean by a thousandth of that.
const POSE_RAD: f64 = 0.05;
/// Distance of a load from the axis that the sensor turns about, m, where its positions are not recorded: a hand's length
/// from a wrist, half of an arm's reach.
pub const ARM_M: f64 = 0.3;
/// Distance of a load from the sensor's origin, m, that its inertia is judged by.
pub const COM_M: f64 = 0.1;
/// Acceleration from which the inertia of a load matters, as a share of gravity: the size of the errors between poses
/// of the best sensors.
pub const SLOW_SHARE: f64 = 0.01;
/// Least number of rests that show weight and bias: three orientations determine them, one more shows the errors.
pub const ENOUGH_RESTS: usize = 4;
/// Most poses of a recording: a long slow motion is cut less finely.
const MOST_POSES: usize = 400;

/// Rates of a recording, one a sample.
#[derive(Clone, Debug, Default)]
pub struct Rates {
    /// Angular speed, rad/s.
    pub speed_rad_s: Vec<f64>,
    /// Acceleration by the turning at a distance of 1 m from the axis, m/s²: `sqrt(ω⁴ + α²)`.
    pub turning_m_s2: Vec<f64>,
    /// Acceleration of the sensor's origin, m/s²; none without positions.
    pub origin_m_s2: Option<Vec<f64>>,
}

/// Rates from orientations and times; `point_m`: positions of the sensor's origin, if they are known.
///
/// None if the samples are farther apart than a rest takes, and most steps leave a pose: such a table lists poses, and
/// shows no motion.
pub fn rates(time_s: &[f64], turned: &[UnitQuaternion<f64>], point_m: Option<&[Vector3<f64>]>) -> Option<Rates> {
    let n = time_s.len().min(turned.len());
    let steps = || (1..n).map(|i| turned[i - 1].angle_to(&turned[i]));
    if n < 3 {
        return None;
    }
    let step_s = (time_s[n - 1] - time_s[0]) / (n - 1) as f64;
    if step_s >= REST_S && 2 * steps().filter(|angle| *angle > POSE_RAD).count() > n - 1 {
        return None;
    }
    let reach = ((REACH_S / step_s).round().max(1.0) as usize).min((n - 1) / 2);
    let ends = |i: usize| (i.saturating_sub(reach), (i + reach).min(n - 1));
    let spin = |i: usize| {
        let (a, b) = ends(i);
        (turned[a].inverse() * turned[b]).scaled_axis() / (time_s[b] - time_s[a]).max(f64::MIN_POSITIVE)
    };
    let spins: Vec<Vector3<f64>> = (0..n).map(spin).collect();
    let turning = |i: usize| {
        let (a, b) = ends(i);
        let change = (spins[b] - spins[a]).norm() / (time_s[b] - time_s[a]).max(f64::MIN_POSITIVE);
        spins[i].norm_squared().hypot(change)
    };
    let origin = |points: &[Vector3<f64>]| {
        let of = |i: usize| {
            let (a, b) = ends(i);
            let (before, after) = (time_s[i] - time_s[a], time_s[b] - time_s[i]);
            if before <= 0.0 || after <= 0.0 {
                return 0.0;
            }
            let change = (points[b] - points[i]) / after - (points[i] - points[a]) / before;
            2.0 * change.norm() / (before + after)
        };
        (0..n).map(of).collect()
    };
    Some(Rates {
        speed_rad_s: spins.iter().map(Vector3::norm).collect(),
        turning_m_s2: (0..n).map(turning).collect(),
        origin_m_s2: point_m.map(origin),
    })
}

/// Runs of samples with one orientation, at most [`MOST_POSES`] of them. `is_kept`: samples that take part.
pub fn poses(turned: &[UnitQuaternion<f64>], is_kept: &dyn Fn(usize) -> bool) -> Vec<Range<usize>> {
    let mut width = POSE_RAD;
    loop {
        let mut found: Vec<Range<usize>> = Vec::new();
        for i in (0..turned.len()).filter(|i| is_kept(*i)) {
            match found.last_mut() {
                Some(last) if last.end == i && turned[last.start].angle_to(&turned[i]) <= width => last.end = i + 1,
                _ => found.push(i..i + 1),
            }
        }
        // Beyond a turn, a run ends where samples were left out.
        if found.len() <= MOST_POSES || width > std::f64::consts::PI {
            return found;
        }
        width *= 1.5;
    }
}

/// Angular speed of every sample of a recording, rad/s.
///
/// # Errors
/// One sentence without orientations, or without a clock.
pub fn angular_speed(recording: &Recording) -> Result<Vec<f64>, EstimateError> {
    let clockless = || EstimateError::Clockless { what: "a state".to_owned(), recording: recording.name.clone() };
    let turned = orientations(recording).ok_or_else(|| EstimateError::MissingColumn {
        task: "the load of a sensor".to_owned(),
        column: "qx, qy, qz, qw, or r11 to r33".to_owned(),
        recording: recording.name.clone(),
    })?;
    let time_s = recording.time_s.as_ref().ok_or_else(clockless)?;
    let mut last = UnitQuaternion::identity();
    // A sample without an orientation keeps the one before.
    let held: Vec<UnitQuaternion<f64>> = turned
        .into_iter()
        .map(|turned| {
            last = turned.unwrap_or(last);
            last
        })
        .collect();
    let rates = rates(time_s, &held, None);
    Ok(rates.map_or_else(|| vec![0.0; held.len()], |rates| rates.speed_rad_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rests for a second, turns by a quarter turn about x within 2 s, rests again; 100 Hz.
    fn quarter() -> (Vec<f64>, Vec<UnitQuaternion<f64>>) {
        let time_s: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.01).collect();
        let angle = |t: f64| (t - 1.0).clamp(0.0, 2.0) * std::f64::consts::FRAC_PI_4;
        let turned = time_s.iter().map(|t| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle(*t))).collect();
        (time_s, turned)
    }

    #[test]
    fn speed_and_acceleration_are_those_of_the_turn() {
        let (time_s, turned) = quarter();
        let found = rates(&time_s, &turned, None).expect("a motion");
        assert!((found.speed_rad_s[200] - std::f64::consts::FRAC_PI_4).abs() < 1e-9, "{}", found.speed_rad_s[200]);
        // ω² at one metre in the middle of the turn, nothing at rest.
        assert!((found.turning_m_s2[200] - std::f64::consts::FRAC_PI_4.powi(2)).abs() < 1e-9);
        assert!(found.speed_rad_s[50] < 1e-12 && found.speed_rad_s[350] < 1e-12);
    }

    #[test]
    fn rests_are_single_poses_and_a_table_of_poses_has_no_rates() {
        let (time_s, turned) = quarter();
        let found = poses(&turned, &|_| true);
        assert!(found[0].len() >= 100 && found.last().is_some_and(|last| last.len() >= 100), "{found:?}");
        // 1.571 rad in runs of 0.05 rad and a sample.
        assert!((25..=36).contains(&found.len()), "{}", found.len());
        let sparse: Vec<UnitQuaternion<f64>> = turned.iter().step_by(60).copied().collect();
        let times: Vec<f64> = time_s.iter().step_by(60).copied().collect();
        assert!(rates(&times[1..6], &sparse[1..6], None).is_none());
    }
}
