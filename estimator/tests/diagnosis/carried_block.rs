//! One block that two fingers with soft pads carry several times.

use super::recorded::{reach, recorded};
use estimator::diagnose::{Diagnosis, Findings, Options, Verdict, diagnose};
use haptics::device::{Device as _, ScriptedOperator, Skill};
use haptics::recording::Recording;
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, presets};

const WEIGHT_N: f64 = 0.6;
const GRAVITY: f64 = 9.81;
const RATE_HZ: f64 = 250.0;
const CARRIES: u32 = 3;
const CARRY_S: f64 = 5.0;
const WIDTH_M: f64 = 0.02;

/// Hidden truth of a simulated recording.
#[derive(Clone, Copy, Default)]
struct Hidden {
    /// Give of a pad, m/N.
    give: f64,
    /// Weight that is lost, N/s.
    leak_n_s: f64,
    /// Delay of the forces after the motion, s.
    late_s: f64,
    /// Mass without weight, kg.
    mass_kg: f64,
    /// Relative gain error of all forces.
    gain: f64,
}

/// The second derivative of [`reach`], 1/s².
fn bend(t: f64, from: f64, to: f64) -> f64 {
    let u = ((t - from) / (to - from)).clamp(0.0, 1.0);
    60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (to - from).powi(2)
}

/// Place of the middle, force to the side, lift and grip.
fn at(t: f64, hidden: &Hidden) -> ([f64; 2], [f64; 3]) {
    let number = (t / CARRY_S).floor().min(f64::from(CARRIES - 1));
    let own = t - number * CARRY_S;
    // Back and forth: a block is picked up from where it was put down.
    let (start_m, side) = if number % 2.0 == 0.0 { (0.0, 1.0) } else { (0.04, -1.0) };
    let of = |shape: &dyn Fn(f64, f64, f64) -> f64| {
        [side * 0.04 * shape(own, 2.0, 2.6), 0.03 * (shape(own, 1.4, 1.9) - shape(own, 2.9, 3.4))]
    };
    let (way, acceleration) = (of(&reach), of(&bend));
    let grip_n =
        1.6 * (reach(own, 0.6, 0.9) - reach(own, 4.0, 4.3)) + 0.5 * (reach(own, 1.0, 1.2) - reach(own, 1.6, 2.4));
    let carried = reach(own, 1.2, 1.4) - reach(own, 3.4, 3.6);
    let weight_n = WEIGHT_N - hidden.leak_n_s * t;
    let mass_kg = weight_n / GRAVITY + hidden.mass_kg;
    let [side_n, lift_n] = [mass_kg * acceleration[0], weight_n + mass_kg * acceleration[1]].map(|f| carried * f);
    ([start_m + way[0], -0.1 + way[1]], [side_n, lift_n, grip_n])
}

fn recording(seed: u64, hidden: &Hidden) -> Recording {
    recorded(seed, (RATE_HZ, f64::from(CARRIES) * CARRY_S), 5e-3, &|t| {
        let ([x, y], [.., grip_n]) = at(t, hidden);
        let own = t % CARRY_S;
        let open_m = 0.008 * (1.0 - reach(own, 0.2, 0.6) + reach(own, 4.3, 4.8));
        let half_m = 0.5 * WIDTH_M + open_m - hidden.give * grip_n;
        let (_, forces) = at((t - hidden.late_s).max(0.0), hidden);
        let [side_n, lift_n, grip_n] = forces.map(|f| (1.0 + hidden.gain) * f);
        let [side_n, lift_n] = [0.5 * side_n, 0.5 * lift_n];
        [x - half_m, y, x + half_m, y, grip_n + side_n, lift_n, -grip_n + side_n, lift_n]
    })
}

fn found(seed: u64, hidden: &Hidden) -> Findings {
    diagnose(&[recording(seed, hidden)], &Options::default()).expect("a block was carried")
}

fn value(found: &Diagnosis, id: &str, name: &str) -> f64 {
    let cause = found.causes.iter().find(|c| c.id == id).unwrap_or_else(|| panic!("{id}: {:?}", found.causes));
    cause.parameters.iter().find(|p| p.name == name).map_or(f64::NAN, |p| p.value)
}

#[test]
fn the_mass_of_a_weight_is_no_cause() {
    for seed in 0..4 {
        let found = found(seed, &Hidden::default());
        assert!(found.verdict == Verdict::None, "seed {seed}: {:?}", found.causes);
    }
}

#[test]
fn mass_that_weighs_nothing_is_named() {
    let found = found(1, &Hidden { mass_kg: 0.03, ..Hidden::default() });
    assert_eq!(found.causes[0].id, "inertia", "{:?}", found.causes);
    let total_kg: f64 = found.causes[0].parameters.iter().map(|p| p.value).sum::<f64>();
    let mean_kg = total_kg / found.causes[0].parameters.len() as f64;
    assert!((mean_kg - 0.03).abs() < 3e-3, "{mean_kg}");
}

#[test]
fn what_runs_out_over_several_carries_is_one_leak() {
    for seed in 0..4 {
        let found = found(seed, &Hidden { leak_n_s: 0.008, ..Hidden::default() });
        assert_eq!(found.causes.len(), 1, "seed {seed}: {:?}", found.causes);
        let rate = value(&found, "mass-change", "rate");
        assert!((rate + 0.008).abs() < 8e-4, "seed {seed}: {rate}");
        assert!(found.causes[0].parameters.iter().all(|p| p.name != "block"), "it is of all carries");
    }
}

#[test]
fn late_forces_are_put_back() {
    for late_s in [-0.03, 0.02, 0.05, 0.09] {
        let found = found(2, &Hidden { late_s, ..Hidden::default() });
        let tau = value(&found, "time-delay", "tau");
        assert!((tau - late_s).abs() < 3e-3, "{late_s}: {tau}");
        assert_eq!(found.causes.len(), 1, "{late_s}: {:?}", found.causes);
    }
}

/// Pad compliance, in metres, may be the stronger cause. The gain of a delay is still that of the force.
#[test]
fn figures_of_a_delay_are_of_the_force_beside_stronger_pads() {
    let found = found(2, &Hidden { late_s: 0.06, give: 1.0 / 1500.0, ..Hidden::default() });
    let ids: Vec<&str> = found.causes.iter().map(|c| c.id.as_str()).collect();
    assert_eq!(ids, ["time-delay", "pad-compliance"]);
    assert_eq!(found.baseline.unit.as_deref(), Some("N"));
    // Two sensors of 5 mN, a window of eight samples.
    let gain = &found.causes[0].gain;
    assert!((1e-3..8e-3).contains(&gain.heldout_rms_after), "{gain:?}");
    assert!(
        (1e-3..8e-3).contains(&found.end.heldout_rms_n) && (1e-3..8e-3).contains(&found.noise_floor_n),
        "{found:?}"
    );
}

/// The filter mixes the approach to the block and the grip on it at their boundary.
#[test]
fn pads_are_as_soft_as_within_the_grip() {
    for (seed, k) in [(0, 1500.0), (1, 3000.0), (2, 6000.0)] {
        let found = found(seed, &Hidden { give: 1.0 / k, ..Hidden::default() });
        let seen = value(&found, "pad-compliance", "k");
        assert!((seen / k - 1.0).abs() < 0.05, "{k}: {seen}");
        assert_eq!(found.causes.len(), 1, "{k}: {:?}", found.causes);
    }
}

#[test]
fn a_weight_that_is_stated_without_a_number_is_that_of_all_carries() {
    let mut recording = recording(3, &Hidden { gain: 0.08, ..Hidden::default() });
    recording.meta.known.insert("mass_kg".to_owned(), WEIGHT_N / GRAVITY);
    let found = diagnose(&[recording], &Options::default()).expect("a block was carried");
    assert!((value(&found, "force-gain", "g - 1") - 0.08).abs() < 5e-3);
}

/// A barrel on its cable, carried by the scripted operator in the stepped world.
fn barrel(seed: u64) -> Recording {
    let world = presets::barrel();
    let state = State::resting(&world);
    let operator = ScriptedOperator::new(&world, &state, Skill::default(), seed);
    let limits = Limits { max_force_n: operator.spec().max_force_n, ..Limits::default() };
    let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(operator), limits);
    let mut ticks = Vec::new();
    while !servo.finished() {
        ticks.push(servo.tick(1e-3));
    }
    to_recording("barrel", &world, &ticks, 1, &SensorModel::TYPICAL, seed)
}

#[test]
fn what_a_cable_leaves_over_is_no_cause_of_its_own() {
    for seed in 1..=3 {
        let found = diagnose(&[barrel(seed)], &Options::default()).expect("an answer");
        let ids: Vec<&str> = found.causes.iter().map(|c| c.id.as_str()).collect();
        assert!(ids.contains(&"added-constraint"), "{ids:?}");
        assert!(ids.iter().all(|id| !["inertia", "force-cross-axis"].contains(id)), "{ids:?}");
    }
}
