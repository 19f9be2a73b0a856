//! Traces of the past in a sensor or a pad: low-passes and a resonance.

use std::f64::consts::TAU;

/// Memory of the slower of two low-passes over that of the other.
///
/// Choice: far enough that their sum is no single exponential.
const SLOWER: f64 = 5.0;

/// Two quantities, each through a low-pass and through a slower one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Creep {
    slow: [[f64; 2]; 2],
}

impl Creep {
    /// Follows a step of length `step_s`; `memory_s` is that of the faster low-pass.
    pub fn follow(&mut self, now: [f64; 2], memory_s: f64, step_s: f64) {
        for (slow, longer) in self.slow.iter_mut().zip([1.0, SLOWER]) {
            for (slow, now) in slow.iter_mut().zip(now) {
                *slow += step_s / (longer * memory_s) * (now - *slow);
            }
        }
    }

    /// The past: of the faster low-pass for form 0, the mean of both for others.
    pub fn past(&self, form: u32) -> [f64; 2] {
        let [slow, slower] = self.slow;
        if form == 0 { slow } else { [0, 1].map(|k: usize| 0.5 * (slow[k] + slower[k])) }
    }
}

/// A resonance that blows excite and that dies away.
#[derive(Clone, Copy, Debug, Default)]
pub struct Resonance {
    state: [f64; 2],
}

impl Resonance {
    /// Swings on for a step.
    pub fn swing(&mut self, hz: f64, decay_s: f64, step_s: f64) {
        let (sin, cos) = (TAU * hz * step_s).sin_cos();
        let keep = 1.0 - step_s / decay_s;
        let [x, y] = self.state;
        self.state = [keep * (cos * x - sin * y), keep * (sin * x + cos * y)];
    }

    /// Takes a blow.
    pub fn strike(&mut self, hard: f64) {
        self.state[0] += hard;
    }

    /// Present deflection.
    pub fn value(&self) -> f64 {
        self.state[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_past_comes_up_to_the_present_and_the_slower_share_later() {
        let mut creep = Creep::default();
        for _ in 0..1000 {
            creep.follow([1.0, -2.0], 1.0, 1e-3);
        }
        // After one memory: 1 − 1/e.
        assert!((creep.past(0)[0] - 0.632).abs() < 1e-3 && (creep.past(0)[1] + 1.264).abs() < 2e-3);
        assert!(creep.past(1)[0] < 0.5 && creep.past(1)[0] > 0.35);
    }

    #[test]
    fn a_struck_resonance_swings_at_its_frequency_and_dies_away() {
        let mut ring = Resonance::default();
        ring.strike(1.0);
        let values: Vec<f64> = (0..2000)
            .map(|_| {
                ring.swing(10.0, 0.2, 1e-3);
                ring.value()
            })
            .collect();
        let ups = values[..500].windows(2).filter(|w| w[0] < 0.0 && w[1] >= 0.0).count();
        assert!((4..=5).contains(&ups), "{ups}");
        assert!(values[1900..].iter().all(|v| v.abs() < 1e-3));
    }
}
