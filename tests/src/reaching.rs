//! A hand that reaches from place to place, waits there, and trembles: mechanisms that it moves stop often and for moments only.

use crate::coverage::{Scores, score};
use crate::mechanisms::{Mechanism, STEP_S, gauss, moved, recorded, truth};
use estimator::pipeline::{Options, analyse};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;

const SECONDS: f64 = 20.0;
const RATE_HZ: f64 = 1000.0;
/// A tremor is what a lightly damped muscle makes of noise.
const TREMOR_DAMPING: f64 = 0.08;
/// The noise behind it changes every so many steps.
const NOISE_STEPS: usize = 50;

/// Scores of one slide under a trembling hand.
pub fn slide_scores(seed: u64) -> Scores {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0x9fb2_1c65_1e98_df25));
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    let (inertia, coulomb, extent_m) = (draw(0.4, 3.0), draw(0.5, 3.0), draw(0.05, 0.2));
    let slide = Mechanism {
        angular: false,
        inertia,
        coulomb,
        viscous: draw(2.0, 9.0),
        offset: draw(-0.05, 0.05) * coulomb,
        gravity: 0.0,
    };
    let noises = [10.0_f64.powf(draw(-4.7, -3.9)), draw(0.02, 0.08)];
    let natural = TAU * draw(2.5, 5.0);
    let stiffness = inertia * natural * natural + 8.0 * coulomb / extent_m;
    let damping = 1.4 * (stiffness * inertia).sqrt();
    let places = reaches(&mut rng, extent_m);
    let shakes = tremor(&mut rng, coulomb, places.len());
    let hand = |step: usize, q: f64, v: f64| {
        let rate = (places[(step + 1).min(places.len() - 1)] - places[step]) / STEP_S;
        stiffness * (places[step] - q) + damping * (rate - v) + shakes[step]
    };
    let motion = moved(&slide, places[0], places.len(), RATE_HZ, hand);
    let recording = recorded(&slide, &motion, RATE_HZ, noises, &mut rng);
    score(&analyse(std::slice::from_ref(&recording), &Options::default()).expect("it moves").fit, &truth(&slide))
}

/// Where the hand wants it at every step: reaches of least jerk, after every other one of which it waits.
fn reaches(rng: &mut StdRng, extent_m: f64) -> Vec<f64> {
    let mut places = vec![0.0; (0.3 / STEP_S) as usize];
    let mut at = 0.0;
    while (places.len() as f64) < SECONDS / STEP_S {
        let (next, seconds) = (extent_m * rng.random_range(-1.0..1.0), rng.random_range(0.5..1.6));
        let steps = (seconds / STEP_S) as usize;
        let share = |i: usize| i as f64 / steps as f64;
        let smooth = |s: f64| s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
        places.extend((0..steps).map(|i| at + (next - at) * smooth(share(i))));
        if rng.random::<f64>() < 0.5 {
            let wait = (rng.random_range(0.0..0.4) / STEP_S) as usize;
            places.extend(std::iter::repeat_n(next, wait));
        }
        at = next;
    }
    places
}

/// Force of a tremor of 8 to 12 Hz at every step, N, up to a few tenths of the friction.
fn tremor(rng: &mut StdRng, coulomb: f64, steps: usize) -> Vec<f64> {
    let (pulse, size) = (TAU * rng.random_range(8.0..12.0), coulomb * rng.random_range(0.02..0.15));
    // White noise of this size shakes it by one on the average.
    let drive = (4.0 * TREMOR_DAMPING * pulse.powi(3) / (NOISE_STEPS as f64 * STEP_S)).sqrt();
    let (mut place, mut rate, mut noise) = (0.0, 0.0, 0.0);
    (0..steps)
        .map(|step| {
            if step % NOISE_STEPS == 0 {
                noise = drive * gauss(rng);
            }
            rate += STEP_S * (noise - 2.0 * TREMOR_DAMPING * pulse * rate - pulse * pulse * place);
            place += STEP_S * rate;
            size * place
        })
        .collect()
}
