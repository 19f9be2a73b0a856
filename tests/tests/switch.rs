//! A switch thrown to and fro: what its curve is like comes back within the stated errors, whatever rate, noise and sensor offset.
//!
//! The recordings come from the stepped world with the scripted operator, with curves, levers, knobs, pads and stops drawn anew
//! for every log. Truth is looked at by the assertions alone.

use estimator::estimate::Fit;
use estimator::pipeline::{Analysis, Options, analyse};
use estimator::simulate::simulate;
use haptics::device::{ScriptedOperator, Skill};
use haptics::recording::{Recording, Task};
use haptics::servo::recorder::{SensorModel, to_recording};
use haptics::servo::safety::Limits;
use haptics::servo::{Loop, Swap};
use haptics::world::{State, World, presets};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use tests::captured::{draw_curve, switch_truth};

/// A switch as the built-in one, but with everything about it drawn.
fn drawn(seed: u64) -> World {
    let mut rng = StdRng::seed_from_u64(seed);
    let mut world = presets::switch();
    let switch = world.switch.as_mut().expect("it has one");
    draw_curve(switch, &mut rng);
    switch.curve.stop_n_m = rng.random_range(2500.0..15_000.0);
    switch.lever_m = rng.random_range(0.024..0.045);
    switch.knob_radius_m = rng.random_range(0.005..0.007);
    world.pad.stiffness_n_m = rng.random_range(2000.0..3500.0);
    world
}

/// What the operator's hand recorded: `every` of a second's 2000 ticks, `noise` times the usual noise, an offset on every force.
fn recorded(world: &World, seed: u64, every: usize, noise: f64, until_s: f64) -> Recording {
    let state = State::resting(world);
    let device = ScriptedOperator::new(world, &state, Skill::default(), seed);
    let ticks = (device.duration_s().min(until_s) * 2000.0) as usize;
    let mut servo = Loop::new(Swap::at(world.clone(), state), Box::new(device), Limits::default());
    let ticks: Vec<_> = (0..ticks).map(|_| servo.tick(5e-4)).collect();
    let sensor = SensorModel::TYPICAL.noisier(noise);
    let mut recording = to_recording(&format!("switch {seed}"), world, &ticks, every, &sensor, seed);
    recording.meta.task = Some(Task::Switch);
    let mut rng = StdRng::seed_from_u64(seed + 1);
    for channel in recording.channels.iter_mut().filter(|c| c.name.starts_with('f')) {
        let offset = rng.random_range(-0.1..0.1);
        channel.values.iter_mut().for_each(|v| *v += offset);
    }
    recording
}

fn analysed(recording: &Recording) -> Analysis {
    analyse(std::slice::from_ref(recording), &Options::default()).expect("fits")
}

fn score(fit: &Fit, name: &str, truth: f64) -> f64 {
    let parameter = fit.parameter("switch", name).unwrap_or_else(|| panic!("{name} is listed"));
    let (Some(value), Some(error)) = (parameter.value, parameter.std_error) else { return f64::INFINITY };
    (value - truth) / error
}

/// The truth in the terms of the fit.
fn truth(world: &World) -> Vec<(&'static str, f64)> {
    switch_truth(world.switch.as_ref().expect("it has one"), world.gravity_m_s2)
}

#[test]
fn intervals_of_95_percent_hold_the_truth() {
    let mut scores: std::collections::BTreeMap<&str, Vec<f64>> = std::collections::BTreeMap::new();
    for seed in 0..80_u64 {
        let world = drawn(71_000 + seed);
        let every = [1, 2, 8, 20][seed as usize % 4];
        let noise = if seed % 8 < 4 { 1.0 } else { 3.0 };
        let recording = recorded(&world, 71_000 + seed, every, noise, 60.0);
        let fit = analysed(&recording).fit;
        for (name, truth) in truth(&world) {
            scores.entry(name).or_default().push(score(&fit, name, truth));
        }
    }
    for (name, scores) in &scores {
        let held = scores.iter().filter(|z| z.abs() <= 1.96).count();
        let n = scores.len() as f64;
        let finite: Vec<f64> = scores.iter().copied().filter(|z| z.is_finite()).collect();
        let rms = (finite.iter().map(|z| z * z).sum::<f64>() / finite.len().max(1) as f64).sqrt();
        println!("{name}: {held} of {n} held, {} found, rms {rms:.2}", finite.len());
        assert!(held as f64 >= 0.88 * n, "{name}: {scores:.1?}");
        assert!(rms > 0.2, "{name}: errors are stated much larger than they are ({rms:.2})");
    }
}

/// A knob that resists the faster it moves has no more friction for that, and no higher peaks.
#[test]
fn damping_and_mass_of_the_knob_are_not_taken_for_friction() {
    let (mut held, mut count) = (0, 0);
    for seed in 0..6_u64 {
        for (damping_n_s_m, mass_kg) in [(0.0, 0.004), (1.0, 0.012)] {
            let mut world = drawn(75_000 + seed);
            let switch = world.switch.as_mut().expect("it has one");
            (switch.damping_n_s_m, switch.mass_kg) = (damping_n_s_m, mass_kg);
            let fit = analysed(&recorded(&world, 75_000 + seed, 2, 1.0, 60.0)).fit;
            let truth = truth(&world);
            for name in ["friction_N", "peak_force_N", "return_peak_force_N"] {
                let wanted = truth.iter().find(|(n, _)| *n == name).expect("drawn").1;
                let (z, error) = (score(&fit, name, wanted), fit.parameter("switch", name).and_then(|p| p.std_error));
                println!("seed {seed} damping {damping_n_s_m}: {name} {z:.1} errors of {error:?} N");
                assert!(error.is_some_and(|e| e < 0.06), "seed {seed} {name}: {error:?}");
                count += 1;
                held += usize::from(z.abs() < 1.96);
            }
        }
    }
    assert!(held * 100 >= 86 * count, "{held} of {count}");
}

#[test]
fn a_throw_only_one_way_shows_half_of_the_curve() {
    for seed in 0..4_u64 {
        let world = drawn(72_000 + seed);
        // The operator's first throw ends before the second begins.
        let fit = analysed(&recorded(&world, 72_000 + seed, 2, 1.0, 4.0)).fit;
        assert!(fit.parameter("switch", "peak_force_N").expect("listed").identified, "seed {seed}");
        for name in ["return_peak_force_N", "return_snap_position_m", "left_end_position_m", "travel_m", "friction_N"] {
            let p = fit.parameter("switch", name).expect("listed");
            assert!(!p.identified && p.value.is_none() && !p.how.is_empty(), "seed {seed}: {p:?}");
        }
        assert!(fit.warnings.iter().any(|w| w.contains("to the left")), "{:?}", fit.warnings);
    }
}

#[test]
fn the_fitted_world_reproduces_the_force_and_can_be_felt() {
    let mut felt = 0;
    for seed in 0..6_u64 {
        let world = if seed == 0 { presets::switch() } else { drawn(73_000 + seed) };
        let recording = recorded(&world, 73_000 + seed, 2, 1.0, 60.0);
        let fitted = analysed(&recording).world;
        fitted.check().expect("can be run");
        // Where the operator never pressed the knob against a stop, its place is not known and there is nothing to feel.
        let Some(found) = fitted.switch.as_ref() else { continue };
        felt += 1;
        assert!(found.curve.fault().is_none());
        // The same operator, other motion: the fitted world beside the true one.
        let again = recorded(&world, 74_000 + seed, 2, 1.0, 60.0);
        let simulated = simulate(&fitted, &again).expect("runs");
        let bare = simulate(&world, &again).expect("runs");
        for finger in ["fx1_N", "fx2_N"] {
            let column = |s: &estimator::simulate::Simulation| {
                s.predicted.iter().find(|c| c.name == finger).expect("predicted").values.clone()
            };
            let (ours, truth) = (column(&simulated), column(&bare));
            let rms = |v: &mut dyn Iterator<Item = f64>| (v.map(|x| x * x).sum::<f64>() / truth.len() as f64).sqrt();
            let (off, size) = (rms(&mut ours.iter().zip(&truth).map(|(a, b)| a - b)), rms(&mut truth.iter().copied()));
            println!("seed {seed} {finger}: {off:.3} N off of {size:.3} N");
            assert!(off < 0.3 * size, "seed {seed} {finger}: {off} of {size}");
        }
    }
    assert!(felt >= 5, "{felt} of 6 recordings gave a switch");
}
