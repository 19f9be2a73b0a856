//! What a diagnosis states of a cause's values is as uncertain as it says, also where one value had to be searched for beside another.
//!
//! A slide that a hand leads, with an integrator of its own (50 kHz, set-valued dry friction); truths are written apart from it.

use estimator::diagnose::{Options, diagnose};
use haptics::recording::{Channel, Meta, Recording, Task};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::TAU;

const STEP_S: f64 = 2e-5;
const RATE_HZ: f64 = 500.0;
const LASTS_S: f64 = 30.0;
const MASS_KG: f64 = 1.5;
const DRY_N: f64 = 2.5;
const OIL_N_S_M: f64 = 6.0;
const REACH_M: f64 = 0.1;

/// What is hidden, with the names that causes' parameters have.
#[derive(Clone, Copy)]
enum Hidden {
    /// Static friction above the Coulomb level, N, that falls with the speed, m/s.
    Stribeck { more_n: f64, speed: f64 },
    /// A bump on the way: N, m, m.
    Bump { size_n: f64, place: f64, width: f64 },
    /// Friction that changes by a share of itself, with a time, s.
    Warming { share: f64, within_s: f64 },
}

impl Hidden {
    fn drawn(kind: usize, rng: &mut StdRng) -> Self {
        let mut draw = |low: f64, high: f64| rng.random_range(low..high);
        match kind {
            0 => Self::Stribeck { more_n: draw(0.3, 1.5), speed: draw(0.015, 0.08) },
            1 => Self::Bump { size_n: draw(0.6, 2.0), place: draw(-0.04, 0.04), width: draw(0.02, 0.06) },
            _ => Self::Warming { share: draw(0.25, 0.8), within_s: draw(4.0, 15.0) },
        }
    }

    fn id(self) -> &'static str {
        match self {
            Self::Stribeck { .. } => "stribeck",
            Self::Bump { .. } => "local-resistance",
            Self::Warming { .. } => "friction-change",
        }
    }

    fn truth(self) -> Vec<(&'static str, f64)> {
        match self {
            Self::Stribeck { more_n, speed } => vec![("dFs", more_n), ("vs", speed)],
            Self::Bump { size_n, place, width } => vec![("F", size_n), ("place", place), ("width", width)],
            Self::Warming { share, within_s } => vec![("relative change", share), ("tau", within_s)],
        }
    }

    /// Dry friction at a place, speed and time, N.
    fn dry_n(self, q: f64, v: f64, t: f64) -> f64 {
        match self {
            Self::Stribeck { more_n, speed } => DRY_N + more_n * (-(v / speed) * (v / speed)).exp(),
            Self::Bump { size_n, place, width } => {
                let off = (q - place) / width;
                DRY_N + if off.abs() < 0.5 { size_n * (0.5 + 0.5 * (TAU * off).cos()) } else { 0.0 }
            }
            Self::Warming { share, within_s } => DRY_N * (1.0 + share * (1.0 - (-t / within_s).exp())),
        }
    }
}

fn gauss(rng: &mut StdRng) -> f64 {
    (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0
}

fn recording(hidden: Hidden, noise_n: f64, rng: &mut StdRng) -> Recording {
    let mut wave = |share: f64, low: f64, high: f64| {
        (share * REACH_M, TAU * rng.random_range(low..high), rng.random_range(0.0..TAU))
    };
    let waves = [wave(0.7, 0.08, 0.16), wave(0.3, 0.25, 0.5), wave(0.1, 0.8, 1.6)];
    let wanted = |t: f64| waves.iter().map(|(a, w, p)| a * (w * t + p).sin()).sum::<f64>();
    let stiffness = 2500.0 * MASS_KG;
    let (mut q, mut v) = (wanted(0.0), 0.0_f64);
    let every = (1.0 / (RATE_HZ * STEP_S)).round() as usize;
    let (mut places, mut forces) = (Vec::new(), Vec::new());
    for step in 0..(LASTS_S / STEP_S) as usize {
        let t = step as f64 * STEP_S;
        let hand_n = stiffness * (wanted(t) - q) - 1.5 * stiffness.sqrt() * MASS_KG.sqrt() * v;
        if step % every == 0 {
            places.push(q + 1e-5 * gauss(rng));
            forces.push(hand_n + noise_n * gauss(rng));
        }
        let free = v + (hand_n - OIL_N_S_M * v) / MASS_KG * STEP_S;
        let most = hidden.dry_n(q, v, t) / MASS_KG * STEP_S;
        v = if free.abs() <= most { 0.0 } else { free - most * free.signum() };
        q += v * STEP_S;
    }
    let channel = |name: &str, values| Channel { name: name.to_owned(), unit: String::new(), values };
    Recording {
        name: "a slide".to_owned(),
        time_s: Some((0..places.len()).map(|k| k as f64 / RATE_HZ).collect()),
        channels: vec![channel("q_m", places), channel("f_N", forces)],
        meta: Meta { task: Some(Task::Mechanism), ..Meta::default() },
        ..Recording::default()
    }
}

/// Error over stated error of every value of the hidden cause; nothing where it was not found.
fn scores(kind: usize, seed: u64) -> Vec<(&'static str, f64)> {
    let mut rng = StdRng::seed_from_u64(seed ^ (kind as u64) << 32);
    let hidden = Hidden::drawn(kind, &mut rng);
    let noise_n = rng.random_range(0.03..0.15);
    let recording = recording(hidden, noise_n, &mut rng);
    let options = Options { baseline: Some("mass+viscous+coulomb".to_owned()), ..Options::default() };
    let found = diagnose(&[recording], &options).expect("it can be diagnosed");
    let Some(cause) = found.causes.iter().find(|c| c.id == hidden.id()) else { return Vec::new() };
    let of = |(name, truth): (&'static str, f64)| {
        let stated = cause.parameters.iter().find(|p| p.name == name)?;
        if std::env::var("TOUCHSTONE_VERBOSE").is_ok() {
            println!("{} {seed} {name}: {truth:.4} {:.4} ± {:.4}", hidden.id(), stated.value, stated.std_error);
        }
        Some((name, (stated.value - truth) / stated.std_error))
    };
    hidden.truth().into_iter().filter_map(of).collect()
}

/// Share of the values that must lie within 1.96 errors, less three standard deviations of so few.
fn least(count: usize) -> f64 {
    let wanted = 0.88_f64;
    wanted - 3.0 * (wanted * (1.0 - wanted) / count as f64).sqrt()
}

/// No value may be off by so many errors.
const WORST: f64 = 6.0;

#[test]
fn stated_errors_hold_the_truth() {
    let number = |name: &str| std::env::var(name).ok().and_then(|s| s.parse::<u64>().ok());
    let (first, count) = (number("TOUCHSTONE_SEED").unwrap_or(700), number("TOUCHSTONE_COVERAGE").unwrap_or(16));
    let mut wrong = Vec::new();
    for kind in 0..3 {
        let all: Vec<Vec<(&str, f64)>> = (0..count).into_par_iter().map(|seed| scores(kind, first + seed)).collect();
        let found = all.iter().filter(|scores| !scores.is_empty()).count();
        if (found as f64) < 0.85 * count as f64 {
            wrong.push(format!("kind {kind}: {found} of {count} found"));
        }
        let mut names: Vec<&str> = all.iter().flatten().map(|(name, _)| *name).collect();
        names.sort_unstable();
        names.dedup();
        for name in names {
            let mut off: Vec<f64> = all.iter().flatten().filter(|(n, _)| *n == name).map(|(_, z)| z.abs()).collect();
            off.sort_by(f64::total_cmp);
            let within = off.iter().filter(|z| **z <= 1.96).count() as f64 / off.len() as f64;
            let worst = off[off.len() - 1];
            let said = format!("kind {kind}, {name}: {within:.2} of {} within, worst {worst:.1}", off.len());
            println!("{said}");
            if within < least(off.len()) || worst > WORST {
                wrong.push(said);
            }
        }
    }
    assert!(wrong.is_empty(), "from seed {first} on: {wrong:#?}");
}
