//! Fault of the force sensors, which is no part of a world.

use super::candidate::Candidate;
use haptics::Vec2;
use haptics::law::Kind;

/// Fault of the force sensors of both fingers, which is no part of the world.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorFault {
    /// Constant offset, one per finger, N.
    pub offset_n: [Vec2; 2],
    /// Drift: initial rate, one per finger, N/s.
    pub drift_n_s: [Vec2; 2],
    /// Time constant of that drift, s; 0 if it never settles.
    pub settles_s: f64,
    /// True if the drift begins when an object is held, not at the start.
    pub drifts_once_held: bool,
    /// Constant offset of the force along the coordinate of a mechanism, N or N m.
    pub offset_along: f64,
    /// Drift along the coordinate: initial rate, N/s or N m/s.
    pub drift_along_per_s: f64,
    /// Jumps of the zero.
    pub steps: [Step; 3],
    /// Cross-talk: share of the finger's y force that is read in x, and of its x force that is read in y, one per
    /// finger.
    pub cross: [Vec2; 2],
    /// Relative gain error of the reading.
    pub gain_error: f64,
    /// Delay of the force after the motion, s.
    pub delay_s: f64,
}

/// A jump of the zero of a force sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// Its time, s since the start.
    pub at_s: f64,
    /// Its size, one per finger, N.
    pub force_n: [Vec2; 2],
    /// Its size along the coordinate of a mechanism, N or N m.
    pub along: f64,
}

impl SensorFault {
    /// Jumps that have happened at a time, s since the start.
    pub fn steps_until(&self, time_s: f64) -> impl Iterator<Item = &Step> {
        self.steps.iter().filter(move |step| step.at_s <= time_s)
    }

    /// Equivalent duration of the drift at its initial rate, s: one that settles saturates at its time constant.
    pub fn drifted_for(&self, time_s: f64) -> f64 {
        if self.settles_s > 0.0 { -self.settles_s * (-time_s / self.settles_s).exp_m1() } else { time_s }
    }

    /// Error of a finger's zero, N, at a time since the start, s. `drifts_s`: time since the drift began.
    pub fn zero_n(&self, finger: usize, time_s: f64, drifts_s: f64) -> Vec2 {
        let stepped: Vec2 = self.steps_until(time_s).map(|step| step.force_n[finger]).sum();
        self.offset_n[finger] + self.drifted_for(drifts_s) * self.drift_n_s[finger] + stepped
    }
}

/// Names and units of a bias and of a drift of each finger along each axis.
pub(crate) const BIAS: [[(&str, &str); 2]; 2] = [[("bx1", "N"), ("by1", "N")], [("bx2", "N"), ("by2", "N")]];
pub(crate) const DRIFT: [[(&str, &str); 2]; 2] = [[("rx1", "N/s"), ("ry1", "N/s")], [("rx2", "N/s"), ("ry2", "N/s")]];

/// A fault of single channels of two fingers, of both channels of a finger, or of all. `column`: its regressor for a
/// finger (first) and an axis (second).
pub(crate) fn of_fingers(
    id: &'static str,
    names: &[[(&'static str, &'static str); 2]; 2],
    column: &dyn Fn(usize, usize) -> Vec<f64>,
) -> Vec<Candidate> {
    let mut made = Vec::new();
    for (finger, names) in names.iter().enumerate() {
        for (axis, (name, unit)) in names.iter().enumerate() {
            made.push(Candidate::one(id, Kind::Instrument, name, unit, column(finger, axis)));
        }
        let both = vec![column(finger, 0), column(finger, 1)];
        made.push(Candidate::several(id, Kind::Instrument, both, names.to_vec()));
    }
    let columns = vec![column(0, 0), column(0, 1), column(1, 0), column(1, 1)];
    made.push(Candidate::several(id, Kind::Instrument, columns, names.concat()));
    made
}

/// Fingers whose sensor a parameter is of, and the parameter's name without their number.
pub(crate) fn fingers(name: &str) -> (std::ops::Range<usize>, &str) {
    match (name.strip_suffix('1'), name.strip_suffix('2')) {
        (Some(name), _) if name != "g - " => (0..1, name),
        (_, Some(name)) => (1..2, name),
        _ => (0..2, name),
    }
}

/// Adds a vector to the faults of the fingers, if the parameter is one of its two components. A fault of the net force
/// is halved between the fingers.
pub(crate) fn add_halved(faults: &mut [Vec2; 2], [x, y]: [&str; 2], name: &str, value: f64) -> bool {
    let (fingers, name) = fingers(name);
    let half = value / fingers.len() as f64;
    for fault in &mut faults[fingers] {
        match name {
            name if name == x => fault.x += half,
            name if name == y => fault.y += half,
            _ => return false,
        }
    }
    true
}

/// Adds every estimate of a candidate; false if one of them is no fault of a force sensor. `add`: adds one, by its
/// name.
pub(crate) fn add_each(candidate: &Candidate, values: &[f64], mut add: impl FnMut(&str, f64) -> bool) -> bool {
    candidate.linear.iter().zip(values).all(|((name, _), value)| add(name, *value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zero_is_the_sum_of_offset_drift_and_jumps_and_a_drift_may_settle() {
        let settling = |settles_s| SensorFault { settles_s, ..SensorFault::default() };
        assert!((settling(0.0).drifted_for(10.0) - 10.0).abs() < 1e-12);
        assert!((settling(5.0).drifted_for(0.01) - 0.01).abs() < 1e-4, "at its first rate in the beginning");
        assert!((settling(5.0).drifted_for(1e3) - 5.0).abs() < 1e-9);
        let mut fault = settling(0.0);
        fault.offset_n[1] = Vec2::new(0.1, 0.0);
        fault.drift_n_s[1] = Vec2::new(0.0, 0.02);
        fault.steps[0] = Step { at_s: 4.0, force_n: [Vec2::zeros(), Vec2::new(-0.3, 0.0)], along: 0.0 };
        assert_eq!(fault.zero_n(0, 5.0, 5.0), Vec2::zeros());
        assert!((fault.zero_n(1, 3.0, 2.0) - Vec2::new(0.1, 0.04)).norm() < 1e-12);
        assert!((fault.zero_n(1, 5.0, 4.0) - Vec2::new(-0.2, 0.08)).norm() < 1e-12);
    }
}
