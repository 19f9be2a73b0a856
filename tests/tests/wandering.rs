//! The thesis's centre of the crank that wanders: a grasp that slips at once, one that creeps and one that is firm are told apart.
//!
//! The logs share no formula with the estimator: a hand's strokes as sums of waves, a handle on its circle, forces of a weight and of dry friction,
//! sensors with noise and steps. `TOUCHSTONE_SEED=20400 cargo test -p tests --test wandering` repeats a day.

use estimator::diagnose::{Findings, Options, diagnose};
use haptics::recording::{Channel, Meta, Recording, Task};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;
use std::time::{SystemTime, UNIX_EPOCH};

const RATE_HZ: f64 = 100.0;
const LASTS_S: f64 = 30.0;
const RADIUS_M: f64 = 0.022;
/// Usual size of the angle.
const ARC_RAD: f64 = 7.0;

/// How the fingertip moves on the handle.
#[derive(Clone, Copy)]
enum Grasp {
    Firm,
    /// From this time on it is elsewhere, by this much.
    Slips(f64, [f64; 2]),
    /// From the first time to the second it moves evenly, by this much.
    Creeps(f64, f64, [f64; 2]),
}

impl Grasp {
    fn away_m(self, time_s: f64) -> [f64; 2] {
        match self {
            Self::Slips(start_s, way) if time_s > start_s => way,
            Self::Creeps(from_s, to_s, way) => {
                let part = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
                way.map(|w| w * part)
            }
            _ => [0.0; 2],
        }
    }
}

/// Noise with a normal distribution, near enough: twelve even draws (Irwin & Hall 1927).
fn noise(rng: &mut StdRng, size: f64) -> f64 {
    size * ((0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.0)
}

/// A crank that is turned to and fro by some turns.
fn recording(rng: &mut StdRng, grasp: Grasp) -> Recording {
    let waves: Vec<(f64, f64, f64)> = [0.11, 0.23, 0.37]
        .iter()
        .map(|hz| (hz * rng.random_range(0.9..1.1), rng.random_range(0.2..0.35), rng.random_range(0.0..TAU)))
        .collect();
    let angle =
        |t: f64| ARC_RAD * waves.iter().map(|(hz, size, phase)| size * (TAU * hz * t + phase).sin()).sum::<f64>();
    let (weight_n, friction, step_m) = (0.16, 0.05, 1e-6);
    let samples = (LASTS_S * RATE_HZ) as usize;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); 4];
    for k in 0..samples {
        let t = k as f64 / RATE_HZ;
        let (a, rate) = (angle(t), (angle(t + 1e-5) - angle(t - 1e-5)) / 2e-5);
        let (sin, cos) = a.sin_cos();
        let away = grasp.away_m(t);
        let pull_n = 0.6 + 0.2 * (TAU * 0.31 * t).sin();
        // Against the weight, dry friction by the pull, and oil.
        let along_n = weight_n * cos + friction * pull_n * rate.signum() + 1.2 * RADIUS_M * rate;
        let place = [RADIUS_M * cos + away[0], -0.1 + RADIUS_M * sin + away[1]];
        let force = [pull_n * cos - along_n * sin, pull_n * sin + along_n * cos];
        for (axis, column) in columns.iter_mut().take(2).enumerate() {
            column.push(((place[axis] + noise(rng, 5e-6)) / step_m).round() * step_m);
        }
        for (axis, column) in columns.iter_mut().skip(2).enumerate() {
            column.push(((force[axis] + noise(rng, 5e-3)) * 1e3).round() * 1e-3);
        }
    }
    let names = [("x_m", "m"), ("y_m", "m"), ("fx_N", "N"), ("fy_N", "N")];
    let channel = |((name, unit), values): ((&str, &str), Vec<f64>)| Channel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values,
    };
    Recording {
        name: "a crank".to_owned(),
        time_s: Some((0..samples).map(|k| k as f64 / RATE_HZ).collect()),
        channels: names.into_iter().zip(columns).map(channel).collect(),
        meta: Meta { task: Some(Task::Crank), ..Meta::default() },
        ..Recording::default()
    }
}

fn asked(recording: &Recording) -> Findings {
    diagnose(std::slice::from_ref(recording), &Options::default()).expect("it can be diagnosed")
}

fn value(found: &Findings, name: &str) -> Option<[f64; 2]> {
    let slip = found.causes.iter().find(|c| c.id == "fingertip-slip")?;
    slip.parameters.iter().find(|p| p.name == name).map(|p| [p.value, p.std_error])
}

fn today() -> u64 {
    let days = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs() / 86_400);
    let seed = std::env::var("TOUCHSTONE_SEED").ok().and_then(|text| text.parse().ok()).unwrap_or_else(days);
    println!("TOUCHSTONE_SEED={seed}");
    seed
}

/// A way of the fingertip, m, any direction.
fn way(rng: &mut StdRng) -> [f64; 2] {
    let (size, direction) = (rng.random_range(5e-4..1.2e-3), rng.random_range(0.0..TAU));
    [size * direction.cos(), size * direction.sin()]
}

const DRAWS: usize = 6;

#[test]
fn a_grasp_that_slips_or_creeps_is_named_and_a_firm_one_is_not() {
    let mut rng = StdRng::seed_from_u64(today());
    for draw in 0..DRAWS {
        let firm = asked(&recording(&mut rng, Grasp::Firm));
        assert!(value(&firm, "dx").is_none(), "{draw}: {:?}", firm.causes);

        let (start_s, gone) = (rng.random_range(6.0..24.0), way(&mut rng));
        let slipped = asked(&recording(&mut rng, Grasp::Slips(start_s, gone)));
        let at =
            value(&slipped, "time").unwrap_or_else(|| panic!("{draw}: a slip at {start_s} s: {:?}", slipped.causes));
        // A way along the path shows when the handle has turned on: a stroke lasts some five seconds.
        assert!((at[0] - start_s).abs() < 5.0, "{draw}: {at:?} for {start_s} s");
        assert!(value(&slipped, "duration").is_none_or(|d| d[0] < 0.5 * LASTS_S), "{draw}: it went at once");

        let (from_s, lasts_s, gone) = (rng.random_range(0.0..10.0), rng.random_range(12.0..20.0), way(&mut rng));
        let crept = asked(&recording(&mut rng, Grasp::Creeps(from_s, from_s + lasts_s, gone)));
        let lasted =
            value(&crept, "duration").unwrap_or_else(|| panic!("{draw}: a creep of {lasts_s} s: {:?}", crept.causes));
        assert!(lasted[0] > 0.2 * LASTS_S, "{draw}: {lasted:?} s for {lasts_s} s");
    }
}
