//! Slides and axes that somebody moves: equations of motion written down here and integrated in steps of 20 µs, seen by sensors.

use crate::coverage::{LEVELS, Scores, score};
use crate::generate::Truth;
use estimator::pipeline::{Options, analyse};
use haptics::recording::{Channel, Recording, Task};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

pub(crate) const STEP_S: f64 = 2e-5;
const SECONDS: f64 = 12.0;

/// One degree of freedom: what resists, in N and m, or N m and rad.
pub(crate) struct Mechanism {
    pub(crate) angular: bool,
    pub(crate) inertia: f64,
    pub(crate) viscous: f64,
    pub(crate) coulomb: f64,
    pub(crate) offset: f64,
    /// Moment of gravity, times the sine of the coordinate.
    pub(crate) gravity: f64,
}

/// Where a hand wants it: sines of several frequencies.
struct Hand {
    parts: Vec<(f64, f64, f64)>,
    stiffness: f64,
    damping: f64,
}

pub(crate) fn gauss(rng: &mut StdRng) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

fn drawn(rng: &mut StdRng) -> (Mechanism, Hand) {
    let mut draw = |low: f64, high: f64| rng.random_range(low..high);
    let angular = draw(0.0, 1.0) < 0.5;
    let of = |linear: f64, turning: f64| if angular { turning } else { linear };
    let hangs = angular && draw(0.0, 1.0) < 0.7;
    let mechanism = Mechanism {
        angular,
        inertia: of(draw(0.5, 4.0), draw(0.01, 0.05)),
        viscous: of(draw(3.0, 15.0), draw(0.02, 0.1)),
        coulomb: of(draw(1.0, 5.0), draw(0.03, 0.1)),
        offset: of(draw(-1.5, 1.5), draw(-0.03, 0.03)),
        gravity: if hangs { draw(0.2, 0.8) } else { 0.0 },
    };
    let size = of(draw(0.08, 0.2), draw(0.6, 1.4));
    let mut part = |share: f64, low: f64, high: f64| (share * size, draw(low, high), draw(0.0, std::f64::consts::TAU));
    let parts = vec![part(1.0, 1.2, 2.2), part(0.4, 3.0, 5.0), part(0.12, 7.0, 11.0)];
    // From an arm, which lets a slide stick for long at every reversal, to a machine that follows its path, 1/s²; damped by three quarters.
    let stiffness = 600.0 * (40_000.0_f64 / 600.0).powf(draw(0.0, 1.0));
    let hand =
        Hand { parts, stiffness: stiffness * mechanism.inertia, damping: 1.5 * stiffness.sqrt() * mechanism.inertia };
    (mechanism, hand)
}

impl Hand {
    /// Where it wants to be, and how fast.
    fn wanted(&self, t: f64) -> (f64, f64) {
        let of = |(a, w, p): &(f64, f64, f64)| (a * (w * t + p).sin(), a * w * (w * t + p).cos());
        self.parts.iter().map(of).fold((0.0, 0.0), |s, x| (s.0 + x.0, s.1 + x.1))
    }
}

/// Coordinate and driving force at `rate_hz` for `steps` steps from `start` on: the force is what the hand gives at a step, place and
/// speed, so that friction may hold the mechanism still.
pub(crate) fn moved(
    mechanism: &Mechanism,
    start: f64,
    steps: usize,
    rate_hz: f64,
    mut hand: impl FnMut(usize, f64, f64) -> f64,
) -> Vec<(f64, f64)> {
    let (mut q, mut v) = (start, 0.0_f64);
    let every = (1.0 / (rate_hz * STEP_S)).round() as usize;
    let mut seen = Vec::new();
    for step in 0..steps {
        let drive = hand(step, q, v);
        if step % every == 0 {
            seen.push((q, drive));
        }
        let rest = drive - mechanism.offset - mechanism.gravity * q.sin() - mechanism.viscous * v;
        // Dry friction stops within a step and holds what it can.
        let free = v + rest / mechanism.inertia * STEP_S;
        let most = mechanism.coulomb / mechanism.inertia * STEP_S;
        v = if free.abs() <= most { 0.0 } else { free - most * free.signum() };
        q += v * STEP_S;
    }
    seen
}

/// `noises`: of coordinate and force, one standard deviation.
pub(crate) fn recorded(
    mechanism: &Mechanism,
    motion: &[(f64, f64)],
    rate_hz: f64,
    noises: [f64; 2],
    rng: &mut StdRng,
) -> Recording {
    let names = if mechanism.angular { ["q_rad", "tau_Nm"] } else { ["q_m", "f_N"] };
    // Of an uncompensated quartz: 100 ppm.
    let clock = 1.0 + 1e-4 * gauss(rng);
    let mut noisy = |value: f64, noise: f64| value + noise * gauss(rng);
    let values: Vec<[f64; 2]> = motion.iter().map(|(q, f)| [noisy(*q, noises[0]), noisy(*f, noises[1])]).collect();
    let channel = |k: usize| Channel {
        name: names[k].to_owned(),
        unit: String::new(),
        values: values.iter().map(|pair| pair[k]).collect(),
    };
    let mut recording = Recording {
        name: "mechanism".to_owned(),
        time_s: Some((0..motion.len()).map(|i| i as f64 / rate_hz * clock).collect()),
        channels: vec![channel(0), channel(1)],
        ..Recording::default()
    };
    recording.meta.task = Some(Task::Mechanism);
    recording
}

/// Scores of one mechanism, a level of noise each.
pub fn mechanism_scores(seed: u64) -> Vec<Scores> {
    let mut rng = StdRng::seed_from_u64(seed.wrapping_mul(0xd6e8_feb8_6659_fd93));
    let (mechanism, hand) = drawn(&mut rng);
    let rate_hz = [200.0, 500.0, 1000.0][seed as usize % 3];
    let drive = |step: usize, q: f64, v: f64| {
        let (place, rate) = hand.wanted(step as f64 * STEP_S);
        hand.stiffness * (place - q) + hand.damping * (rate - v)
    };
    let motion = moved(&mechanism, hand.wanted(0.0).0, (SECONDS / STEP_S) as usize, rate_hz, drive);
    let truth = truth(&mechanism);
    let noises = if mechanism.angular { [1e-4, 0.004] } else { [1e-5, 0.05] };
    let mut fitted = |level: f64| {
        let recording = recorded(&mechanism, &motion, rate_hz, noises.map(|n| level * n), &mut rng);
        score(&analyse(std::slice::from_ref(&recording), &Options::default()).expect("it moves").fit, &truth)
    };
    LEVELS.map(&mut fitted).to_vec()
}

pub(crate) fn truth(mechanism: &Mechanism) -> Truth {
    let names = if mechanism.angular {
        ["inertia_kg_m2", "viscous_Nm_s", "coulomb_Nm", "offset_Nm"]
    } else {
        ["mass_kg", "viscous_N_s_m", "coulomb_N", "offset_N"]
    };
    let values = [mechanism.inertia, mechanism.viscous, mechanism.coulomb, mechanism.offset];
    let mut all: Vec<(&str, f64)> = names.into_iter().zip(values).collect();
    if mechanism.gravity > 0.0 {
        all.push(("gravity_moment_Nm", mechanism.gravity));
    }
    all.into_iter().map(|(name, value)| (("mechanism".to_owned(), name.to_owned()), value)).collect()
}
