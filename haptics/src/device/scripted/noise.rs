//! Involuntary motion of every hand: tremor, and a pinch that wanders.

use crate::Vec2;
use rand::RngExt;
use rand::rngs::StdRng;

/// Physiological tremor: three sines between 8 and 12 Hz in each direction.
pub(super) struct Tremor {
    waves: [(f64, f64, Vec2); 3],
}

impl Tremor {
    pub fn new(amplitude_m: f64, rng: &mut StdRng) -> Self {
        let waves = [(); 3].map(|()| {
            let share = amplitude_m / 3.0_f64.sqrt();
            let direction = Vec2::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)) * share;
            (std::f64::consts::TAU * rng.random_range(8.0..12.0), rng.random_range(0.0..6.2), direction)
        });
        Self { waves }
    }

    pub fn at(&self, t_s: f64) -> Vec2 {
        self.waves.iter().map(|(w, phase, direction)| direction * (w * t_s + phase).sin()).sum()
    }
}

/// Slow relative wander of the pinch force: no hand holds a force constant.
pub(super) struct Wander {
    waves: [(f64, f64, f64); 3],
}

impl Wander {
    /// `scale` is relative to a steady hand.
    pub fn new(scale: f64, rng: &mut StdRng) -> Self {
        Self {
            waves: [(); 3].map(|()| {
                (
                    std::f64::consts::TAU * rng.random_range(0.15..1.2),
                    rng.random_range(0.0..6.2),
                    scale * rng.random_range(0.05..0.15),
                )
            }),
        }
    }

    pub fn at(&self, t_s: f64) -> f64 {
        self.waves.iter().map(|(w, phase, share)| share * (w * t_s + phase).sin()).sum()
    }
}
