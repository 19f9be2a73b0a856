//! Random numbers of the generator: everything is drawn from one seed.

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// A source of random numbers that a seed repeats.
pub struct Chance(StdRng);

impl Chance {
    /// A source of its own for a seed and a purpose.
    pub fn new(seed: u64, purpose: u64) -> Self {
        Self(StdRng::seed_from_u64(
            seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ purpose.wrapping_mul(0xc2b2_ae3d_27d4_eb4f),
        ))
    }

    /// Uniform in `low..high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// Uniform in the logarithm: sizes whose order of magnitude is what varies.
    pub fn of_order(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    /// True with probability `p`.
    pub fn happens(&mut self, p: f64) -> bool {
        self.0.random::<f64>() < p
    }

    /// −1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.happens(0.5) { 1.0 } else { -1.0 }
    }

    /// One of several.
    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.0.random_range(0..of.len())]
    }

    /// A whole number in `low..=high`.
    pub fn whole(&mut self, low: u32, high: u32) -> u32 {
        self.0.random_range(low..=high)
    }

    /// Standard normal (Box & Muller 1958).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.0.random::<f64>()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.0.random::<f64>()).cos()
    }
}

/// Noise with a memory: an Ornstein–Uhlenbeck process of unit variance, or a resonance driven by noise.
pub struct Coloured {
    value: [f64; 2],
    keep: f64,
    turn: (f64, f64),
}

impl Coloured {
    /// Forgets within `memory_s` and swings at `swing_hz` (0: does not) when sampled every `step_s`.
    pub fn new(memory_s: f64, swing_hz: f64, step_s: f64) -> Self {
        Self {
            value: [0.0; 2],
            keep: (-step_s / memory_s).exp(),
            turn: (std::f64::consts::TAU * swing_hz * step_s).sin_cos(),
        }
    }

    /// The same, in the middle of its life.
    pub fn running(memory_s: f64, swing_hz: f64, step_s: f64, chance: &mut Chance) -> Self {
        let mut noise = Self::new(memory_s, swing_hz, step_s);
        noise.value = [chance.normal(), chance.normal()];
        noise
    }

    /// The next value.
    pub fn next(&mut self, chance: &mut Chance) -> f64 {
        let fresh = (1.0 - self.keep * self.keep).sqrt();
        let (sin, cos) = self.turn;
        let [x, y] = self.value;
        self.value = [
            self.keep * (cos * x - sin * y) + fresh * chance.normal(),
            self.keep * (sin * x + cos * y) + fresh * chance.normal(),
        ];
        self.value[0]
    }
}
