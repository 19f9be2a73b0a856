//! The recursion and the detector against the batch fit and against their own statements.

mod change;
mod recursive;

use rand::{RngExt as _, rngs::StdRng};
use rand_distr::StandardNormal;

/// Autocorrelated noise of standard deviation 1.
struct Noise {
    rng: StdRng,
    rho: f64,
    state: f64,
}

impl Noise {
    fn new(mut rng: StdRng, rho: f64) -> Self {
        let state = rng.sample(StandardNormal);
        Self { rng, rho, state }
    }

    fn next(&mut self) -> f64 {
        let shock: f64 = self.rng.sample(StandardNormal);
        self.state = self.rho * self.state + (1.0 - self.rho * self.rho).sqrt() * shock;
        self.state
    }
}
