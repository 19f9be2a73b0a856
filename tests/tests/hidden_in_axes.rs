//! What is hidden in a motor's axis, as others would record it: a stiff loop, a force that is what the motor was told, an encoder with fine steps.
//!
//! The axis has an integrator of its own (20 kHz, set-valued dry friction) and shares no formula with the estimator.

use estimator::diagnose::{Findings, Options, diagnose};
use haptics::recording::{Channel, Meta, Recording, Task};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

const STEP_S: f64 = 1.0 / 20_000.0;
const RATE_HZ: f64 = 1000.0;
const LASTS_S: f64 = 20.0;
const MASS_KG: f64 = 95.0;
const DRY_N: f64 = 20.0;
const OIL_N_S_M: f64 = 200.0;

/// What the axis has beside its mass and friction.
#[derive(Clone, Copy, Default)]
struct Hidden {
    /// N
    constant_n: f64,
    /// Oil in the positive direction less that in the negative one, halved, N s/m.
    by_direction_n_s_m: f64,
    /// N/m about the middle of the stroke.
    spring_n_m: f64,
}

/// Moves with rests between them, each with a speed of its own: places over time, m.
fn wanted(rng: &mut StdRng) -> Vec<f64> {
    let mut places = Vec::new();
    let (mut here, mut side) = (0.0_f64, 1.0);
    while (places.len() as f64) < LASTS_S / STEP_S {
        let there = side * rng.random_range(0.04..0.11);
        let (speed, acceleration) = (rng.random_range(0.03..0.18), rng.random_range(0.6..1.5));
        let way = f64::abs(there - here);
        let speed = f64::min(speed, f64::sqrt(way * acceleration));
        let (ramp_s, cruise_s) = (speed / acceleration, way / speed - speed / acceleration);
        let lasts_s = 2.0 * ramp_s + cruise_s;
        for k in 0..(lasts_s / STEP_S) as usize {
            let t = k as f64 * STEP_S;
            let gone = if t < ramp_s {
                0.5 * acceleration * t * t
            } else if t < ramp_s + cruise_s {
                speed * (t - 0.5 * ramp_s)
            } else {
                way - 0.5 * acceleration * (lasts_s - t).powi(2)
            };
            places.push(here + (there - here).signum() * gone);
        }
        let rests = (rng.random_range(0.05..0.3) / STEP_S) as usize;
        places.extend(vec![there; rests]);
        (here, side) = (there, -side);
    }
    places
}

/// The axis led by a loop that is told places a thousand times a second.
fn recording(seed: u64, hidden: Hidden) -> Recording {
    let mut rng = StdRng::seed_from_u64(seed);
    let wanted = wanted(&mut rng);
    let every = (1.0 / (RATE_HZ * STEP_S)).round() as usize;
    let (mut place, mut speed, mut told_n) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (mut places, mut forces) = (Vec::new(), Vec::new());
    for (k, target) in wanted.iter().take((LASTS_S / STEP_S) as usize).enumerate() {
        if k % every == 0 {
            // Cascaded loops: a place's error makes a wanted speed.
            told_n = 8500.0 * (160.0 * (target - place) - speed);
            let noise = (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0;
            places.push((place / 5e-8).round() * 5e-8);
            forces.push(told_n + 0.5 * noise);
        }
        let oil = OIL_N_S_M + hidden.by_direction_n_s_m * speed.signum();
        let rest_n = told_n - oil * speed - hidden.constant_n - hidden.spring_n_m * place;
        let free = speed + rest_n / MASS_KG * STEP_S;
        // Dry friction stops it at most.
        let most = DRY_N / MASS_KG * STEP_S;
        speed = if free.abs() <= most { 0.0 } else { free - most * free.signum() };
        place += speed * STEP_S;
    }
    let channel = |name: &str, unit: &str, values| Channel { name: name.to_owned(), unit: unit.to_owned(), values };
    Recording {
        name: "an axis".to_owned(),
        time_s: Some((0..places.len()).map(|k| k as f64 / RATE_HZ).collect()),
        channels: vec![channel("q_m", "m", places), channel("f_N", "N", forces)],
        meta: Meta { task: Some(Task::Mechanism), ..Meta::default() },
        ..Recording::default()
    }
}

fn asked(seed: u64, hidden: Hidden, baseline: &str) -> Findings {
    let options = Options { baseline: Some(baseline.to_owned()), ..Options::default() };
    diagnose(&[recording(seed, hidden)], &options).expect("it can be diagnosed")
}

fn ids(found: &Findings) -> Vec<&str> {
    let mut ids: Vec<&str> = found.causes.iter().map(|c| c.id.as_str()).collect();
    ids.sort_unstable();
    ids
}

fn value(found: &Findings, id: &str) -> f64 {
    found.causes.iter().find(|c| c.id == id).map_or(f64::NAN, |c| c.parameters[0].value)
}

const SEEDS: [u64; 3] = [11, 12, 13];

#[test]
fn from_its_mass_alone_an_axis_gets_its_two_frictions_and_nothing_else() {
    for seed in SEEDS {
        let found = asked(seed, Hidden::default(), "mass");
        assert_eq!(ids(&found), ["coulomb-friction", "viscous-friction"], "{seed}");
        assert!((value(&found, "coulomb-friction") / DRY_N - 1.0).abs() < 0.05, "{seed}");
        assert!((value(&found, "viscous-friction") / OIL_N_S_M - 1.0).abs() < 0.05, "{seed}");
    }
}

#[test]
fn a_constant_beside_the_friction_makes_nothing_of_its_reversals() {
    for seed in SEEDS {
        let constant_n = 6.0;
        let found = asked(seed, Hidden { constant_n, ..Hidden::default() }, "mass+viscous+coulomb");
        assert_eq!(ids(&found), ["force-bias"], "{seed}");
        assert!((value(&found, "force-bias") - constant_n).abs() < 0.3, "{seed}: {:?}", found.causes[0].parameters);
        // Dry friction by direction is the very same.
        let other = found.alternatives.iter().find(|a| a.id == "friction-asymmetry").expect("it is listed");
        assert!((0.4..0.6).contains(&other.posterior), "{seed}: {other:?}");
        // … and there is no more left than without it.
        let plain = asked(seed, Hidden::default(), "mass+viscous+coulomb");
        assert!(found.noise_floor_n < 1.5 * plain.noise_floor_n, "{seed}");
    }
}

#[test]
fn a_spring_beside_the_friction_makes_nothing_of_its_reversals() {
    for seed in SEEDS {
        let spring_n_m = 120.0;
        let found = asked(seed, Hidden { spring_n_m, ..Hidden::default() }, "mass+viscous+coulomb");
        assert_eq!(ids(&found), ["return-spring"], "{seed}");
        assert!((value(&found, "return-spring") / spring_n_m - 1.0).abs() < 0.05, "{seed}");
    }
}

#[test]
fn what_takes_each_other_back_at_the_usual_speed_is_found_together() {
    for seed in SEEDS {
        let hidden = Hidden { constant_n: 3.2, by_direction_n_s_m: -37.0, ..Hidden::default() };
        let found = asked(seed, hidden, "mass");
        let named = ids(&found);
        assert_eq!(named, ["coulomb-friction", "force-bias", "friction-asymmetry", "viscous-friction"], "{seed}");
        let by_direction = value(&found, "friction-asymmetry");
        assert!((by_direction / hidden.by_direction_n_s_m - 1.0).abs() < 0.1, "{seed}: {by_direction}");
    }
}
