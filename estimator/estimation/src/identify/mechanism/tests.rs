//! Recovery: known parameters are simulated and must come back within their own stated uncertainty; parameters that the
//! motion cannot show must be reported as such.

use super::*;
use haptics::recording::{Channel, Meta};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
use rand_distr::StandardNormal;

/// A motion q(t) with its first two derivatives.
type Motion = fn(f64) -> [f64; 3];

/// Truth: inertia, viscous, Coulomb, offset, gravity moment.
#[derive(Clone, Copy)]
struct Truth {
    inertia: f64,
    viscous: f64,
    coulomb: f64,
    offset: f64,
    gravity: f64,
}

const SLIDE: Truth = Truth { inertia: 3.0, viscous: 12.0, coulomb: 4.0, offset: 0.7, gravity: 0.0 };

struct Setup {
    rate_hz: f64,
    seconds: f64,
    position_noise: f64,
    force_noise: f64,
    angular: bool,
}

const PLAIN: Setup = Setup { rate_hz: 500.0, seconds: 20.0, position_noise: 2e-6, force_noise: 0.2, angular: false };

fn two_tones(t: f64) -> [f64; 3] {
    let (a, b) = (2.1_f64, 5.3_f64);
    [
        0.15 * (a * t).sin() + 0.04 * (b * t).sin(),
        0.15 * a * (a * t).cos() + 0.04 * b * (b * t).cos(),
        -0.15 * a * a * (a * t).sin() - 0.04 * b * b * (b * t).sin(),
    ]
}

fn record(truth: Truth, setup: &Setup, motion: Motion, seed: u64) -> Recording {
    let n = (setup.rate_hz * setup.seconds) as usize;
    record_at((0..n).map(|i| i as f64 / setup.rate_hz).collect(), truth, setup, motion, seed)
}

fn record_at(time: Vec<f64>, truth: Truth, setup: &Setup, motion: Motion, seed: u64) -> Recording {
    let mut rng = StdRng::seed_from_u64(seed);
    let mut noise = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
    let (mut position, mut force) = (Vec::new(), Vec::new());
    for &t in &time {
        let [q, v, a] = motion(t);
        let drive = truth.inertia * a
            + truth.viscous * v
            + truth.coulomb * if v == 0.0 { 0.0 } else { v.signum() }
            + truth.offset
            + truth.gravity * q.sin();
        position.push(q + noise(setup.position_noise));
        force.push(drive + noise(setup.force_noise));
    }
    let channel = |name: &str, values: Vec<f64>| Channel { name: name.to_owned(), unit: String::new(), values };
    let (q, f) = if setup.angular { ("q_rad", "tau_Nm") } else { ("q_m", "f_N") };
    Recording {
        name: "made".to_owned(),
        time_s: Some(time),
        channels: vec![channel(q, position), channel(f, force)],
        ..Recording::default()
    }
}

fn demand(fit: &Fit, name: &str, truth: f64, relative: f64) {
    let parameter = fit.parameter(OBJECT, name).unwrap_or_else(|| panic!("{name} is missing: {fit:#?}"));
    let value = parameter.value.unwrap_or_else(|| panic!("{name} is not identified: {}", parameter.how));
    let error = parameter.std_error.expect("an identified value has an error");
    println!("{name}: {value} ± {error} (truth {truth})");
    assert!((value - truth).abs() <= relative * truth.abs(), "{name}: {value} against {truth}");
    assert!((value - truth).abs() <= 4.0 * error, "{name}: {value} ± {error} against {truth}");
}

fn refuses(fit: &Fit, name: &str, reason: &str) {
    let parameter = fit.parameter(OBJECT, name).unwrap_or_else(|| panic!("{name} is missing"));
    assert!(!parameter.identified && parameter.value.is_none(), "{name} must not be identified: {parameter:?}");
    assert!(parameter.how.contains(reason), "{name}: {}", parameter.how);
}

#[test]
fn a_slide_is_recovered_from_20_hz_to_4_khz() {
    for (rate_hz, position_noise, tolerance) in
        [(20.0, 1e-5, 0.04), (100.0, 1e-5, 0.02), (1000.0, 1e-6, 0.01), (4000.0, 1e-6, 0.01)]
    {
        let setup = Setup { rate_hz, position_noise, ..PLAIN };
        let fit = fit(&[record(SLIDE, &setup, two_tones, 3)]).expect("fits");
        println!("{rate_hz} Hz: {:?}", fit.quality);
        demand(&fit, "mass_kg", 3.0, tolerance);
        demand(&fit, "viscous_N_s_m", 12.0, tolerance);
        demand(&fit, "coulomb_N", 4.0, tolerance);
        demand(&fit, "offset_N", 0.7, 3.0 * tolerance);
        let quality = fit.quality.expect("a held-out figure");
        assert!(quality.heldout_rms < 0.6 && quality.heldout_relative < 0.1, "{quality:?}");
    }
}

#[test]
fn a_revolute_axis_with_gravity_is_recovered_in_torque() {
    let truth = Truth { inertia: 0.02, viscous: 0.05, coulomb: 0.08, offset: 0.0, gravity: 0.9 };
    let setup = Setup { angular: true, force_noise: 0.01, position_noise: 1e-4, ..PLAIN };
    let swing: Motion = |t| two_tones(t).map(|v| 6.0 * v);
    let fit = fit(&[record(truth, &setup, swing, 5)]).expect("fits");
    demand(&fit, "inertia_kg_m2", 0.02, 0.03);
    demand(&fit, "viscous_Nm_s", 0.05, 0.05);
    demand(&fit, "coulomb_Nm", 0.08, 0.05);
    demand(&fit, "gravity_moment_Nm", 0.9, 0.01);
}

#[test]
fn without_gravity_none_is_invented() {
    let truth = Truth { inertia: 0.02, viscous: 0.05, coulomb: 0.08, offset: 0.01, gravity: 0.0 };
    let setup = Setup { angular: true, force_noise: 0.01, position_noise: 1e-4, ..PLAIN };
    let swing: Motion = |t| two_tones(t).map(|v| 6.0 * v);
    for seed in 0..10 {
        let fit = fit(&[record(truth, &setup, swing, seed)]).expect("fits");
        refuses(&fit, "gravity_moment_Nm", "no gravity moment");
        demand(&fit, "offset_Nm", 0.01, 0.5);
    }
}

#[test]
fn what_the_motion_does_not_show_is_not_given_a_number() {
    let steady: Motion = |t| [0.05 * t, 0.05, 0.0];
    let one_way = fit(&[record(SLIDE, &PLAIN, steady, 1)]).expect("fits");
    refuses(&one_way, "coulomb_N", "never reverses");
    refuses(&one_way, "offset_N", "never reverses");
    refuses(&one_way, "viscous_N_s_m", "speed hardly varies");
    refuses(&one_way, "mass_kg", "acceleration");
    let sum = one_way.value(OBJECT, "resistance_N").expect("the sum is known");
    assert!((sum - (4.0 + 0.7 + 12.0 * 0.05)).abs() < 0.05, "{sum}");

    let wavering: Motion = |t| [0.2 * t + 0.02 * (5.0 * t).sin(), 0.2 + 0.1 * (5.0 * t).cos(), -0.5 * (5.0 * t).sin()];
    let one_way = fit(&[record(SLIDE, &PLAIN, wavering, 1)]).expect("fits");
    refuses(&one_way, "coulomb_N", "never reverses");
    demand(&one_way, "viscous_N_s_m", 12.0, 0.1);
    demand(&one_way, "mass_kg", 3.0, 0.1);

    // With stops: the holding force there is anything up to the friction, and a filter rings back by a hair when the
    // motion sets in.
    let halting: Motion = |t| {
        let (w, turns) = (1.5, (1.5 * t / std::f64::consts::TAU).floor());
        let phase = w * t - std::f64::consts::TAU * turns;
        if phase > std::f64::consts::PI {
            return [0.1 * (turns + 1.0), 0.0, 0.0];
        }
        let (s, c) = (2.0 * phase).sin_cos();
        [
            0.1 * turns + 0.1 / std::f64::consts::PI * (phase - 0.5 * s),
            0.1 * w / std::f64::consts::PI * (1.0 - c),
            0.2 * w * w / std::f64::consts::PI * s,
        ]
    };
    let one_way = fit(&[record(SLIDE, &PLAIN, halting, 1)]).expect("fits");
    refuses(&one_way, "coulomb_N", "never reverses");
    refuses(&one_way, "offset_N", "never reverses");
    demand(&one_way, "resistance_N", 4.7, 0.05);

    let triangle: Motion = |t| {
        let phase = (t / 2.0).fract();
        let forth = phase < 0.5;
        let v = if forth { 0.1 } else { -0.1 };
        [0.2 * if forth { phase } else { 1.0 - phase }, v, 0.0]
    };
    let both_ways = fit(&[record(SLIDE, &PLAIN, triangle, 1)]).expect("fits");
    refuses(&both_ways, "viscous_N_s_m", "speed hardly varies");
    refuses(&both_ways, "coulomb_N", "speed hardly varies");
    demand(&both_ways, "offset_N", 0.7, 0.15);

    let rest: Motion = |_| [0.1, 0.0, 0.0];
    let still = fit(&[record(SLIDE, &PLAIN, rest, 1)]).expect("fits");
    for name in ["mass_kg", "viscous_N_s_m", "coulomb_N", "offset_N"] {
        refuses(&still, name, "does not move");
    }
}

#[test]
fn known_parameters_are_taken_as_given() {
    let mut recording = record(SLIDE, &PLAIN, two_tones, 2);
    recording.meta.known.insert("mass_kg".to_owned(), 3.0);
    let fit = fit(&[recording]).expect("fits");
    let mass = fit.parameter(OBJECT, "mass_kg").expect("listed");
    assert!(mass.value == Some(3.0) && mass.how.contains("not estimated"));
    demand(&fit, "coulomb_N", 4.0, 0.01);
}

#[test]
fn several_recordings_share_their_parameters() {
    // One shows the mass, the other the friction; neither alone shows both well.
    let slow: Motion = |t| [0.2 * (0.5 * t).sin(), 0.1 * (0.5 * t).cos(), -0.05 * (0.5 * t).sin()];
    let fast: Motion = |t| [0.004 * (25.0 * t).sin(), 0.1 * (25.0 * t).cos(), -2.5 * (25.0 * t).sin()];
    let both = [record(SLIDE, &PLAIN, slow, 1), record(SLIDE, &PLAIN, fast, 2)];
    let fit = fit(&both).expect("fits");
    demand(&fit, "mass_kg", 3.0, 0.01);
    demand(&fit, "coulomb_N", 4.0, 0.02);
}

#[test]
fn intervals_hold_the_truth() {
    let (mut hits, mut all) = (0, 0);
    for seed in 0..100 {
        let setup = Setup { rate_hz: 200.0, seconds: 8.0, ..PLAIN };
        let fit = fit(&[record(SLIDE, &setup, two_tones, seed)]).expect("fits");
        for (name, truth) in [("mass_kg", 3.0), ("viscous_N_s_m", 12.0), ("coulomb_N", 4.0), ("offset_N", 0.7)] {
            let parameter = fit.parameter(OBJECT, name).expect("listed");
            let (value, error) = (parameter.value.expect("shown"), parameter.std_error.expect("shown"));
            hits += u32::from((value - truth).abs() < 1.96 * error);
            all += 1;
        }
    }
    println!("coverage {hits} of {all}");
    assert!(f64::from(hits) > 0.9 * f64::from(all), "{hits} of {all}");
}

/// Errors in standard errors over seeds 0 … 19, one row a seed, for the named parameters.
fn scores(names: &[(&str, f64)], make: impl Fn(u64) -> Recording) -> Vec<Vec<f64>> {
    let score = |seed: u64| {
        let fit = fit(&[make(seed)]).expect("fits");
        let one = |&(name, truth): &(&str, f64)| {
            let parameter = fit.parameter(OBJECT, name).expect("listed");
            let value = parameter.value.unwrap_or_else(|| panic!("{name}: {}", parameter.how));
            (value - truth) / parameter.std_error.expect("identified")
        };
        names.iter().map(one).collect()
    };
    let all: Vec<Vec<f64>> = (0..20).map(score).collect();
    println!("{names:?}: {all:.2?}");
    all
}

/// Root mean square of one column of normalised errors: 1 if the stated errors are right.
fn spread(scores: &[Vec<f64>], column: usize) -> f64 {
    (scores.iter().map(|s| s[column].powi(2)).sum::<f64>() / scores.len() as f64).sqrt()
}

#[test]
fn noise_in_the_acceleration_does_not_attenuate_inertia_and_gravity() {
    // One slow swing with a little of another: acceleration and sine of the angle are nearly one.
    let truth = Truth { inertia: 0.02, viscous: 0.01, coulomb: 0.04, offset: -0.02, gravity: 0.55 };
    let swing: Motion = |t| {
        let (a, b) = (5.0_f64, 5.6_f64);
        let of = |w: f64| [(w * t).sin(), w * (w * t).cos(), -w * w * (w * t).sin()];
        let (x, y) = (of(a), of(b));
        [0, 1, 2].map(|i| 0.5 * x[i] + 0.08 * y[i])
    };
    let setup = Setup { rate_hz: 200.0, seconds: 10.0, position_noise: 2e-4, force_noise: 0.003, angular: true };
    let names = [("inertia_kg_m2", truth.inertia), ("gravity_moment_Nm", truth.gravity)];
    let all = scores(&names, |seed| record(truth, &setup, swing, seed));
    assert!(spread(&all, 0) < 1.6 && spread(&all, 1) < 1.6);
}

/// A hand that goes from place to place and waits, about `middle`, with a little tremor.
fn reaching(t: f64, middle: f64, size: f64) -> [f64; 3] {
    let of =
        |a: f64, w: f64, p: f64| [a * (w * t + p).sin(), a * w * (w * t + p).cos(), -a * w * w * (w * t + p).sin()];
    let parts = [of(size, 2.3, 0.0), of(0.5 * size, 3.7, 1.0), of(0.3 * size, 6.1, 2.0), of(0.004 * size, 50.0, 0.5)];
    let sum = |i: usize| parts.iter().map(|p| p[i]).sum::<f64>();
    [middle + sum(0), sum(1), sum(2)]
}

#[test]
fn a_moment_that_is_largest_in_the_middle_of_the_arc_is_not_taken_for_an_offset() {
    let truth = Truth { inertia: 0.04, viscous: 0.04, coulomb: 0.035, offset: -0.003, gravity: 0.33 };
    let setup = Setup { rate_hz: 100.0, seconds: 10.0, position_noise: 1e-4, force_noise: 0.004, angular: true };
    let motion: Motion = |t| reaching(t, 1.5, 0.5);
    let names = [("offset_Nm", truth.offset), ("gravity_moment_Nm", truth.gravity)];
    let all = scores(&names, |seed| record(truth, &setup, motion, seed));
    assert!(spread(&all, 0) < 1.6 && spread(&all, 1) < 1.6);
}

#[test]
fn over_a_short_arc_an_offset_may_be_gravity_and_its_error_says_so() {
    let truth = Truth { inertia: 0.04, viscous: 0.04, coulomb: 0.035, offset: 0.0, gravity: 0.33 };
    let setup = Setup { rate_hz: 100.0, seconds: 10.0, position_noise: 1e-4, force_noise: 0.02, angular: true };
    let motion: Motion = |t| reaching(t, 1.5, 0.06);
    let fit = fit(&[record(truth, &setup, motion, 1)]).expect("fits");
    let offset = fit.parameter(OBJECT, "offset_Nm").expect("listed");
    println!("{offset:?}");
    assert!(offset.value.is_none_or(|v| v.abs() < 3.0 * offset.std_error.expect("identified")), "{offset:?}");
}

#[test]
fn uneven_sampling_does_not_bias_friction() {
    // Many reversals: each one shows how sharp the direction is against the force.
    let motion: Motion = |t| {
        let [q, v, a] = reaching(1.6 * t, 0.0, 0.06);
        [q, 1.6 * v, 2.56 * a]
    };
    for rate_hz in [100.0, 1000.0] {
        let setup = Setup { rate_hz, seconds: 10.0, position_noise: 5e-6, force_noise: 0.02, ..PLAIN };
        let truth = Truth { inertia: 1.5, viscous: 3.5, coulomb: 1.7, offset: -1.0, gravity: 0.0 };
        let uneven = |seed: u64| {
            let mut rng = StdRng::seed_from_u64(1000 + seed);
            let mut now = 0.0;
            let time = (0..(setup.seconds * rate_hz) as usize).map(|_| {
                now += (0.5 + rng.random::<f64>()) / rate_hz;
                now
            });
            record_at(time.collect(), truth, &setup, motion, seed)
        };
        let names = [("mass_kg", truth.inertia), ("viscous_N_s_m", truth.viscous), ("coulomb_N", truth.coulomb)];
        let all = scores(&names, uneven);
        for (column, (name, _)) in names.iter().enumerate() {
            assert!(spread(&all, column) < 1.6, "{name} at {rate_hz} Hz");
        }
    }
}

/// A free pendulum by semi-implicit Euler at 20 kHz: the laws' own integrator.
fn pendulum(truth: Truth, start_rad: f64, hanging_at: f64, rate_hz: f64, noise: f64) -> Recording {
    use haptics::law::{CoulombFriction, EccentricMass, Effect, Inertia, Motion, ViscousFriction, step_coordinate};
    let effects = [
        Effect::new(&Inertia, &[truth.inertia]),
        Effect::new(&ViscousFriction, &[truth.viscous]),
        Effect::new(&CoulombFriction, &[truth.coulomb]),
        Effect::new(&EccentricMass, &[truth.gravity]),
    ];
    let mut rng = StdRng::seed_from_u64(9);
    let mut state = Motion { position: start_rad, ..Motion::default() };
    let inner = 20_000.0;
    let every = (inner / rate_hz) as usize;
    let (mut time, mut angle) = (Vec::new(), Vec::new());
    for i in 0..(20.0 * inner) as usize {
        if i % every == 0 {
            time.push(i as f64 / inner);
            angle.push(state.position + hanging_at + noise * rng.sample::<f64, _>(StandardNormal));
        }
        (state.position, state.velocity) = step_coordinate(&effects, &state, 0.0, 0.0, 1.0 / inner);
    }
    let channel = Channel { name: "q_rad".to_owned(), unit: "rad".to_owned(), values: angle };
    Recording { name: "pendulum".to_owned(), time_s: Some(time), channels: vec![channel], ..Recording::default() }
}

#[test]
fn a_free_pendulum_is_recovered_from_its_known_gravity_moment() {
    let (mass, arm) = (0.107, 0.23);
    let truth = Truth { inertia: 0.0076, viscous: 4e-4, coulomb: 8e-4, offset: 0.0, gravity: mass * arm * 9.81 };
    for hanging_at in [0.0, 0.3] {
        let mut recording = pendulum(truth, 1.2, hanging_at, 200.0, 2e-4);
        recording.meta.known = [("mass_kg".to_owned(), mass), ("com_m".to_owned(), arm)].into();
        let fit = fit(std::slice::from_ref(&recording)).expect("fits");
        demand(&fit, "inertia_kg_m2", truth.inertia, 1e-4);
        demand(&fit, "viscous_Nm_s", truth.viscous, 0.02);
        demand(&fit, "coulomb_Nm", truth.coulomb, 0.02);
        assert!((fit.value(OBJECT, PHASE).expect("hanging") - hanging_at).abs() < 1e-3);
        recording.meta = Meta::default();
        let blind = super::fit(&[recording]).expect("fits");
        refuses(&blind, "inertia_kg_m2", "only ratios");
        let ratio = blind.value(OBJECT, "viscous_per_inertia_1_s").expect("a ratio");
        assert!((ratio / (truth.viscous / truth.inertia) - 1.0).abs() < 0.02);
    }
}

#[test]
fn a_fitted_world_predicts_the_force() {
    let recording = record(SLIDE, &PLAIN, two_tones, 4);
    let fit = fit(std::slice::from_ref(&recording)).expect("fits");
    let mechanism = world(&fit, &recording);
    let force = predict(&mechanism, &recording).expect("predicts").force;
    let measured = recording.channel("f_N").expect("there");
    let n = force.len();
    assert_eq!(n, measured.len());
    let rms = (force.iter().zip(measured).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / n as f64).sqrt();
    assert!(rms < 0.35, "noise 0.2 and a few reversal samples: {rms}");
}

#[test]
fn uneven_time_and_gaps_are_taken() {
    let mut recording = record(SLIDE, &PLAIN, two_tones, 4);
    let keep: Vec<usize> = (0..recording.len()).filter(|i| i % 7 != 3 && !(3000..3600).contains(i)).collect();
    let pick = |values: &[f64]| keep.iter().map(|&i| values[i]).collect::<Vec<f64>>();
    recording.time_s = recording.time_s.as_deref().map(pick);
    for channel in &mut recording.channels {
        channel.values = pick(&channel.values);
    }
    let fit = fit(std::slice::from_ref(&recording)).expect("fits");
    demand(&fit, "mass_kg", 3.0, 0.03);
    demand(&fit, "coulomb_N", 4.0, 0.03);
    assert_eq!(predict(&world(&fit, &recording), &recording).expect("predicts").force.len(), recording.len());
}

#[test]
fn nothing_to_fit_is_one_sentence() {
    assert!(fit(&[]).is_err());
    let empty = Recording { name: "a".to_owned(), time_s: Some(Vec::new()), ..Recording::default() };
    assert!(fit(&[empty]).expect_err("no columns").to_string().contains("q_m"));
    let short = record(SLIDE, &Setup { seconds: 0.02, ..PLAIN }, two_tones, 1);
    assert!(fit(&[short]).expect_err("ten samples").to_string().contains("only 10 usable samples"));
}

#[test]
fn a_force_that_never_changes_shows_no_mass() {
    let constant = |level: f64, extent_m: f64, seed: u64| {
        let nothing = Truth { inertia: 0.0, viscous: 0.0, coulomb: 0.0, offset: level, gravity: 0.0 };
        let quiet = Setup { force_noise: 0.0, position_noise: 0.01 * extent_m, ..PLAIN };
        let mut made = record(nothing, &quiet, two_tones, seed);
        made.channels[0].values.iter_mut().for_each(|q| *q *= extent_m);
        made
    };
    for (seed, extent_m) in [(1, 1e-6), (2, 1e-3), (3, 1.0)] {
        for level in [2.0, -0.3, 0.0] {
            let made = constant(level, extent_m, seed);
            let fit = fit(std::slice::from_ref(&made)).expect("fits");
            for name in ["mass_kg", "viscous_N_s_m", "coulomb_N", "offset_N"] {
                refuses(&fit, name, "the force is");
            }
            assert_eq!(fit.parameters.len(), 4, "{fit:?}");
        }
    }
    // A mechanism under one constant force moves as its mass says, if nothing else is in the force.
    let mut drawn = constant(2.0, 1.0, 4);
    let time = drawn.time_s.clone().expect("a clock");
    drawn.channels[0].values = time.iter().map(|t| 0.5 * (2.0 - 0.4) / 3.0 * t * t).collect();
    drawn.meta.known = [("offset_N".to_owned(), 0.0), ("coulomb_N".to_owned(), 0.4)].into();
    demand(&fit(&[drawn]).expect("fits"), "mass_kg", 3.0, 0.01);
}

#[test]
fn a_mass_that_may_as_well_be_none_is_not_identified() {
    let tiny = Truth { inertia: 1e-3, viscous: 0.0, coulomb: 0.0, offset: 2.0, gravity: 0.0 };
    let hardly: Motion = |t| two_tones(t).map(|v| 1e-3 * v);
    for seed in 0..6 {
        let setup = Setup { position_noise: 1e-7, force_noise: 0.02, seconds: 6.0, ..PLAIN };
        let fit = fit(&[record(tiny, &setup, hardly, seed)]).expect("fits");
        let mass = fit.parameter(OBJECT, "mass_kg").expect("there");
        assert!(!mass.identified || mass.value > mass.std_error, "{mass:?}");
    }
    let pushed = record(SLIDE, &PLAIN, two_tones, 7);
    let mut mirrored = pushed;
    mirrored.channels[1].values.iter_mut().for_each(|f| *f = -*f);
    refuses(&fit(&[mirrored]).expect("fits"), "mass_kg", "check the sign");
}
