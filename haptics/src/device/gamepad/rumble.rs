//! Rumble as a cue of the finger force and of the speed of impacts.

/// Force of the strongest rumble, N.
const FULL_FORCE_N: f64 = 4.0;
/// Slower impacts are not felt, m/s.
const FAINTEST_M_S: f64 = 0.02;
/// Speed of the strongest knock, m/s.
const FULL_M_S: f64 = 0.5;
/// A knock stays at its full strength for this long, s: a pad takes some thirty commands a second, and its motors need as long to
/// come up.
const HOLD_S: f64 = 0.04;
/// Time constant with which it then fades, s.
const FADE_S: f64 = 0.05;
/// Strength below which it ends: a motor that hardly turns only hums.
const SILENT: f64 = 0.05;

/// Strength of the two motors of a pad, each 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rumble {
    /// By the force on the fingers: the small motor.
    pub force: f32,
    /// By the speed of the last impact: the large motor.
    pub impact: f32,
}

/// Strength of the rumble for a force on a finger, N: 0 to 1, linear.
pub fn force_strength(force_n: f64) -> f64 {
    (force_n / FULL_FORCE_N).clamp(0.0, 1.0)
}

/// Strength of the knock of an impact at a speed, m/s, a time after it, s: 0 to 1. By the root of the speed, so that a gentle
/// touch is still felt; held for a moment, then fading to nothing.
pub fn impact_strength(speed_m_s: f64, age_s: f64) -> f64 {
    // Not a number compares as false.
    let felt = speed_m_s >= FAINTEST_M_S && age_s >= 0.0;
    if !felt {
        return 0.0;
    }
    let strength = (speed_m_s / FULL_M_S).min(1.0).sqrt() * (-(age_s - HOLD_S).max(0.0) / FADE_S).exp();
    if strength < SILENT { 0.0 } else { strength }
}

/// The knock that is under way.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Knock {
    speed_m_s: f64,
    age_s: f64,
}

impl Knock {
    /// Something struck at a speed, m/s. A weaker impact does not cut a stronger one short.
    pub fn strike(&mut self, speed_m_s: f64) {
        if impact_strength(speed_m_s, 0.0) > self.strength() {
            *self = Self { speed_m_s, age_s: 0.0 };
        }
    }

    /// Lets time pass, s.
    pub fn pass(&mut self, dt_s: f64) {
        self.age_s += dt_s;
    }

    /// Present strength of the cue, 0 to 1.
    pub fn strength(&self) -> f64 {
        impact_strength(self.speed_m_s, self.age_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_knock_grows_with_the_speed_holds_and_fades_to_nothing() {
        for age_s in [0.0, 0.02, HOLD_S] {
            assert_eq!(impact_strength(0.5, age_s), 1.0, "held");
            assert_eq!(impact_strength(5.0, age_s), 1.0, "no more than all");
            assert!((impact_strength(0.125, age_s) - 0.5).abs() < 1e-12, "a quarter of the speed, half the strength");
        }
        let fading: Vec<f64> = (0..400).map(|ms| impact_strength(0.5, HOLD_S + f64::from(ms) * 1e-3)).collect();
        assert!((fading[50] - (-1.0_f64).exp()).abs() < 1e-12);
        assert!(fading.windows(2).all(|w| w[1] < w[0] || w[1] == 0.0) && fading[399] == 0.0);
        assert!(impact_strength(0.02, 0.0) > 0.1 && impact_strength(0.019, 0.0) == 0.0, "a mere touch is none");
        for (speed, age) in [(f64::NAN, 0.0), (0.5, f64::NAN), (0.5, -1.0), (-0.5, 0.0)] {
            assert_eq!(impact_strength(speed, age), 0.0, "{speed} m/s, {age} s");
        }
        assert_eq!(impact_strength(f64::INFINITY, 0.0), 1.0);
    }

    #[test]
    fn a_stronger_impact_takes_over_and_a_weaker_one_waits_its_turn() {
        let mut knock = Knock::default();
        assert_eq!(knock.strength(), 0.0);
        knock.strike(0.5);
        knock.pass(0.06);
        knock.strike(0.05);
        assert!((knock.strength() - (-0.02_f64 / FADE_S).exp()).abs() < 1e-12, "the old one goes on");
        knock.strike(0.4);
        assert!((knock.strength() - 0.8_f64.sqrt()).abs() < 1e-12, "the new one begins");
        knock.pass(0.3);
        assert_eq!(knock.strength(), 0.0);
        knock.strike(0.05);
        assert!((knock.strength() - 0.1_f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn force_is_linear_and_bounded() {
        assert_eq!([0.0, 1.0, 4.0, 100.0, -1.0].map(force_strength), [0.0, 0.25, 1.0, 1.0, 0.0]);
    }
}
