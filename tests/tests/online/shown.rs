//! The motion that is named for a parameter shows it: whoever does it knows the parameter better than who goes on as before.

use crate::online::enough_for;
use crate::online::information::{Enough, Motion, Wanted};
use estimator::pipeline::{Analysis, Options, analyse};
use haptics::device::Skill;
use haptics::recording::{Channel, Recording, Task};
use haptics::servo::recorder::SensorModel;
use haptics::world::{World, presets};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use std::slice::from_ref;
use tests::generate::perform;

/// A motion: value and its first two derivatives over time, and the pull outward, N.
type Way<'a> = &'a dyn Fn(f64) -> ([f64; 3], f64);

/// Even for the first half; then the other way, from where it had come to.
fn then(even: Way<'_>, half_s: f64, other: Way<'_>, t: f64) -> ([f64; 3], f64) {
    if t < half_s {
        return even(t);
    }
    let ([from, ..], _) = even(half_s);
    let ([start, ..], _) = other(0.0);
    let ([value, rate, bend], pull) = other(t - half_s);
    ([from + value - start, rate, bend], pull)
}

fn channels(columns: Vec<(&str, &str, Vec<f64>)>) -> Vec<Channel> {
    let channel =
        |(name, unit, values): (&str, &str, Vec<f64>)| Channel { name: name.into(), unit: unit.into(), values };
    columns.into_iter().map(channel).collect()
}

/// A crank that one tool turns, let go of for two seconds first; weight, frictions and inertia as in `missing.rs`. 200 Hz, no velocity.
fn tool(seconds: f64, way: Way<'_>) -> Recording {
    const RADIUS_M: f64 = 0.02;
    let mut rng = StdRng::seed_from_u64(7);
    let mut noise = |sigma: f64| sigma * (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
    let mut columns = [(); 5].map(|()| Vec::new());
    for i in 0..((2.0 + seconds) * 200.0) as usize {
        let t = i as f64 / 200.0;
        let held = t > 2.0;
        let ([angle, rate, bend], pull) = way((t - 2.0).max(0.0));
        let (s, c) = angle.sin_cos();
        let v = RADIUS_M * rate;
        let along = 0.3 * c + (0.05 * pull.abs() + 0.06) * v.signum() + 1.2 * v + 0.05 * RADIUS_M * bend;
        let share = if held { 1.0 } else { 0.0 };
        let row = [
            t,
            RADIUS_M * c + noise(1e-5),
            RADIUS_M * s + noise(1e-5),
            share * (pull * c - along * s) + noise(0.01),
            share * (pull * s + along * c) + noise(0.01),
        ];
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    let [time, x, y, fx, fy] = columns;
    let mut recording = Recording {
        name: "one tool".to_owned(),
        channels: channels(vec![("x_m", "m", x), ("y_m", "m", y), ("fx_N", "N", fx), ("fy_N", "N", fy)]),
        time_s: Some(time),
        ..Recording::default()
    };
    recording.meta.task = Some(Task::Crank);
    recording
}

fn fitted(recording: &Recording) -> (Analysis, Vec<Enough>) {
    let analysis = analyse(from_ref(recording), &Options::default()).expect("it can be fitted");
    let enough = enough_for(from_ref(recording), analysis.task, &analysis.fit, &Wanted::default());
    (analysis, enough)
}

/// Standard error of a parameter; without a value it is infinite.
fn error(analysis: &Analysis, object: &str, name: &str) -> f64 {
    let parameter = analysis.fit.parameter(object, name).unwrap_or_else(|| panic!("{object}.{name} is told"));
    parameter.std_error.filter(|_| parameter.identified).unwrap_or(f64::INFINITY)
}

fn asked(all: &[Enough], name: &str) -> Option<Motion> {
    let one = all.iter().find(|e| e.name == name).unwrap_or_else(|| panic!("{name} is judged: {all:?}"));
    one.missing.as_ref().map(|m| m.motion)
}

/// Nothing that is not known as well as wanted stays without a word.
fn all_have_words(all: &[Enough]) {
    let silent = all.iter().filter(|e| e.share < 1.0 && e.missing.is_none() && e.more_seconds.is_none());
    assert_eq!(silent.count(), 0, "{all:?}");
}

#[test]
fn a_crank_on_one_tool_is_told_what_to_do_and_doing_it_helps() {
    let even = |t: f64| ([5.0 * t, 5.0, 0.0], 1.0);
    let (_, enough) = fitted(&tool(12.0, &even));
    all_have_words(&enough);
    let (went_on, _) = fitted(&tool(24.0, &even));
    let quick = |t: f64| ([5.0 * t + 0.5 * (9.0 * t).sin(), 5.0 + 4.5 * (9.0 * t).cos(), -40.5 * (9.0 * t).sin()], 1.0);
    let speeds =
        |t: f64| ([5.0 * t + 7.0 * (0.5 * t).sin(), 5.0 + 3.5 * (0.5 * t).cos(), -1.75 * (0.5 * t).sin()], 1.0);
    let pulled = |t: f64| ([5.0 * t, 5.0, 0.0], 1.0 + 1.5 * (2.1 * t).sin());
    let cases: [(&str, Motion, Way<'_>); 3] = [
        ("inertia_kg_m2", Motion::Accelerate, &quick),
        ("viscous_N_s_m", Motion::OtherSpeeds, &speeds),
        ("friction_mu", Motion::PushAndPull, &pulled),
    ];
    for (name, motion, way) in cases {
        assert_eq!(asked(&enough, name), Some(motion), "{name}: {enough:?}");
        let (did_it, _) = fitted(&tool(24.0, &|t| then(&even, 12.0, way, t)));
        let (before, after) = (error(&went_on, "crank", name), error(&did_it, "crank", name));
        assert!(after < 0.8 * before, "{name}: {after} after {motion:?}, {before} without");
    }
}

/// A slide of 2 kg with friction, driven along `way`. 500 Hz.
fn slide(seconds: f64, way: Way<'_>) -> Recording {
    let mut rng = StdRng::seed_from_u64(8);
    let mut noise = |sigma: f64| sigma * (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
    let time: Vec<f64> = (0..(seconds * 500.0) as usize).map(|i| i as f64 / 500.0).collect();
    let motion: Vec<[f64; 3]> = time.iter().map(|t| way(*t).0).collect();
    let force = motion.iter().map(|[_, v, a]| 2.0 * a + 5.0 * v + 0.8 * v.signum() + noise(0.02)).collect();
    let place = motion.iter().map(|m| m[0] + noise(2e-6)).collect();
    Recording {
        name: "slide".to_owned(),
        channels: channels(vec![("q_m", "m", place), ("f_N", "N", force)]),
        time_s: Some(time),
        ..Recording::default()
    }
}

#[test]
fn a_mechanism_is_told_what_to_do_and_doing_it_helps() {
    // One way, hardly any change of speed.
    let even =
        |t: f64| ([0.05 * t + 1e-4 * (2.0 * t).sin(), 0.05 + 2e-4 * (2.0 * t).cos(), -4e-4 * (2.0 * t).sin()], 0.0);
    let (_, enough) = fitted(&slide(8.0, &even));
    all_have_words(&enough);
    let (went_on, _) = fitted(&slide(16.0, &even));
    let quick =
        |t: f64| ([0.05 * t + 4e-3 * (8.0 * t).sin(), 0.05 + 0.032 * (8.0 * t).cos(), -0.256 * (8.0 * t).sin()], 0.0);
    let speeds =
        |t: f64| ([0.08 * t + 0.06 * (0.9 * t).sin(), 0.08 + 0.054 * (0.9 * t).cos(), -0.0486 * (0.9 * t).sin()], 0.0);
    let back = |t: f64| ([0.05 * (1.2 * t).sin(), 0.06 * (1.2 * t).cos(), -0.072 * (1.2 * t).sin()], 0.0);
    let cases: [(&str, Motion, Way<'_>); 3] = [
        ("mass_kg", Motion::ChangeSpeed, &quick),
        ("viscous_N_s_m", Motion::MoveAtOtherSpeeds, &speeds),
        ("coulomb_N", Motion::Reverse, &back),
    ];
    for (name, motion, way) in cases {
        assert_eq!(asked(&enough, name), Some(motion), "{name}: {enough:?}");
        let (did_it, _) = fitted(&slide(16.0, &|t| then(&even, 8.0, way, t)));
        let (before, after) = (error(&went_on, "mechanism", name), error(&did_it, "mechanism", name));
        assert!(after < 0.8 * before, "{name}: {after} after {motion:?}, {before} without");
    }
}

/// Recordings of an object by the scripted operator, who does the named motions.
fn performed(world: &World, task: Task, count: u64) -> Vec<Recording> {
    let one = |seed: u64| {
        let mut recording = perform(world, seed, Skill::default(), 5, &SensorModel::TYPICAL).recording;
        recording.meta.task = Some(task);
        recording
    };
    (20..20 + count).map(one).collect()
}

/// Who does them three times knows more than who did them once.
#[test]
fn needles_and_switches_are_known_better_after_more_of_the_named_motion() {
    let needle = ("needle", ["stiffness_N_m", "puncture_force_N", "shaft_friction_N"]);
    let switch = ("switch", ["peak_force_N", "travel_m", "friction_N"]);
    let tasks = [(presets::needle(), needle, Task::Needle), (presets::switch(), switch, Task::Switch)];
    for (world, (object, names), task) in tasks {
        let recordings = performed(&world, task, 3);
        let alone: Vec<_> = recordings.iter().map(fitted).collect();
        let together = analyse(&recordings, &Options::default()).expect("they can be fitted");
        for (_, enough) in &alone {
            all_have_words(enough);
        }
        for name in names {
            // One recording's own error is a matter of luck: the mean square of three.
            let square = alone.iter().map(|(one, _)| error(one, object, name).powi(2)).sum::<f64>() / 3.0;
            let (before, after) = (square.sqrt(), error(&together, object, name));
            assert!(after < 0.8 * before, "{object}.{name}: {after} after all of it, {before} after a third");
        }
    }
}
