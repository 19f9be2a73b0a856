use crate::diagnose::hypotheses::candidate::Candidate;
use haptics::Vec2;

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
    /// Cross-talk: share of the finger's y force that is read in x, and of its x force that is read in y, one per
    /// finger.
    pub cross: [Vec2; 2],
    /// Relative gain error of the reading.
    pub gain_error: f64,
    /// Delay of the force after the motion, s.
    pub delay_s: f64,
}

impl SensorFault {
    /// Adds the estimate of a candidate; false for a fault that is none of these.
    pub(crate) fn add(&mut self, candidate: &Candidate, values: &[f64]) -> bool {
        if candidate.id == "force-drift" {
            self.settles_s = candidate.searched.first().map_or(0.0, |s| s.value);
        }
        candidate.linear.iter().zip(values).all(|((name, _), value)| self.add_one(candidate.id, name, *value))
    }

    /// Adds a fault. Faults of the net force are halved between the fingers; those in proportion to the force belong to
    /// each finger.
    fn add_one(&mut self, id: &str, name: &str, value: f64) -> bool {
        match (id, name) {
            ("force-bias", "b") => self.offset_along = value,
            ("force-drift", "rate") => self.drift_along_per_s = value,
            _ => return self.add_to_fingers(id, name, value),
        }
        true
    }

    fn add_to_fingers(&mut self, id: &str, name: &str, value: f64) -> bool {
        let (fingers, name) = match (name.strip_suffix('1'), name.strip_suffix('2')) {
            (Some(name), _) if name != "g - " => (0..1, name),
            (_, Some(name)) => (1..2, name),
            _ => (0..2, name),
        };
        let half = value / fingers.len() as f64;
        for finger in fingers {
            match (id, name) {
                ("force-bias", "bx") => self.offset_n[finger].x += half,
                ("force-bias", "by") => self.offset_n[finger].y += half,
                ("force-drift", "rx") => self.drift_n_s[finger].x += half,
                ("force-drift", "ry") => self.drift_n_s[finger].y += half,
                ("force-cross-axis", "kappa_xy") => self.cross[finger].x += value,
                ("force-cross-axis", "kappa_yx") => self.cross[finger].y += value,
                ("force-cross-axis", "kappa_turned") => self.cross[finger] += Vec2::new(-value, value),
                ("force-gain", _) => self.gain_error = value,
                ("time-delay", "tau") => self.delay_s = value,
                _ => return false,
            }
        }
        true
    }
}
