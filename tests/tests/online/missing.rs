//! Which motion is missing: recordings that lack one are told so.

use crate::generator::until;
use crate::online::Online;
use crate::online::information::{Enough, Motion};
use crate::online::{Settings, replay};
use haptics::device::Skill;
use haptics::recording::{Recording, Task};
use haptics::servo::recorder::SensorModel;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};
use tests::generate::{crank_world, perform, stacking_world};

fn judged(recording: &Recording, task: Task) -> Vec<Enough> {
    let settings = Settings { memory_s: f64::INFINITY, ..Settings::default() };
    replay(std::slice::from_ref(recording), task, &settings).expect("fed").report().enough
}

fn of<'a>(all: &'a [Enough], name: &str) -> &'a Enough {
    all.iter().find(|e| e.name == name).unwrap_or_else(|| panic!("{name} is judged: {all:?}"))
}

/// The recording from a time on, s.
fn from(recording: &Recording, start_s: f64) -> Recording {
    let first = recording.time_s.as_ref().map_or(0, |t| t.partition_point(|t| *t < start_s));
    let mut part = recording.clone();
    part.time_s = recording.time_s.as_ref().map(|t| t[first..].to_vec());
    for channel in &mut part.channels {
        channel.values.drain(..first);
    }
    part.labels = None;
    part
}

/// First time of a state in the labels, s.
fn first(recording: &Recording, state: &str) -> f64 {
    let labels = recording.labels.as_ref().expect("generated");
    let at = (0..labels.len()).find(|i| labels.get(*i) == Some(state)).expect("the state comes");
    recording.time_s.as_ref().expect("generated")[at]
}

#[test]
fn a_hand_that_never_let_go_is_asked_to() {
    for seed in 71_000..71_008 {
        let (world, _) = stacking_world(seed);
        let recording = perform(&world, seed, Skill::default(), 5, &SensorModel::TYPICAL).recording;
        let lifted = first(&recording, "hold-above-ground");
        let part = until(&from(&recording, lifted - 0.1), lifted + 1.2);
        let all = judged(&part, Task::BlockStack);
        let weight = of(&all, "weight_N");
        assert_eq!(weight.missing.as_ref().map(|m| m.motion), Some(Motion::LetGo), "seed {seed}: {weight:?}");
        assert_eq!(weight.share, 0.0);
    }
}

#[test]
fn a_whole_task_needs_nothing_but_a_slip() {
    let (world, _) = stacking_world(71_100);
    let recording = perform(&world, 71_100, Skill::default(), 5, &SensorModel::TYPICAL).recording;
    let all = judged(&recording, Task::BlockStack);
    for name in ["weight_N", "width_m"] {
        assert!(of(&all, name).share >= 1.0 && of(&all, name).missing.is_none(), "{all:?}");
    }
    let friction = of(&all, "friction");
    assert_eq!(friction.missing.as_ref().map(|m| m.motion), Some(Motion::LoosenUntilItSlides));
}

#[test]
fn information_grows_along_a_crank_and_its_forecast_is_about_right() {
    let (mut checked, mut right) = (0, 0);
    for seed in 71_200..71_216 {
        let (world, _) = crank_world(seed);
        let recording = perform(&world, seed, Skill::default(), 5, &SensorModel::TYPICAL).recording;
        let end_s = *recording.time_s.as_ref().and_then(|t| t.last()).expect("not empty");
        let turned = first(&recording, "turning");
        // When half of the turning is over, what is said of the rest?
        let half = judged(&until(&recording, 0.5 * (turned + end_s)), Task::Crank);
        let whole = judged(&recording, Task::Crank);
        for name in ["friction_mu", "viscous_N_s_m", "coulomb_N", "inertia_kg_m2"] {
            let (before, after) = (of(&half, name), of(&whole, name));
            let (Some(e1), Some(e2)) = (before.std_error, after.std_error) else { continue };
            checked += 1;
            right += usize::from(e2 < 1.05 * e1);
        }
    }
    assert!(checked >= 24 && right * 10 >= checked * 9, "{right} of {checked} errors shrank");
}

/// A crank turned about the origin by a formula: angle over time with its two derivatives, and the pull outward, N. Half of the pull of
/// 0.3 N of weight, 0.05 of the pull, 1.2 N s/m and 0.06 N constant; 0.05 kg at the handle.
fn turned(seed: u64, seconds: f64, way: impl Fn(f64) -> ([f64; 3], f64)) -> Online {
    const RADIUS: f64 = 0.02;
    let mut rng = StdRng::seed_from_u64(seed);
    let mut online =
        Online::new(Task::Crank, 1e-3, Settings { memory_s: f64::INFINITY, ..Settings::default() }).expect("a crank");
    for i in 0..((2.0 + seconds) * 1e3) as usize {
        let t = 1e-3 * i as f64;
        let ([angle, rate, bend], pull) = way((t - 2.0).max(0.0));
        let (s, c) = angle.sin_cos();
        let held = t > 2.0;
        let (v, a) = if held { (RADIUS * rate, RADIUS * bend) } else { (0.0, 0.0) };
        let along = 0.3 * c + (0.05 * pull.abs() + 0.06) * v.signum() + 1.2 * v + 0.05 * a;
        let (fx, fy) = if held { (pull * c - along * s, pull * s + along * c) } else { (0.0, 0.0) };
        let grip = if held { 3.0 } else { 0.0 };
        let mut noise = |sigma: f64| sigma * (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
        let (x, y, vx, vy) = (RADIUS * c, RADIUS * s, -v * s, v * c);
        let sample = [
            x - 0.005 + noise(1e-5),
            y + noise(1e-5),
            x + 0.005 + noise(1e-5),
            y + noise(1e-5),
            vx + noise(8e-4),
            vy + noise(8e-4),
            vx + noise(8e-4),
            vy + noise(8e-4),
            grip + 0.5 * fx + noise(0.01),
            0.5 * fy + noise(0.01),
            -grip + 0.5 * fx + noise(0.01),
            0.5 * fy + noise(0.01),
        ];
        online.push(t, &sample);
    }
    online
}

#[test]
fn an_even_turn_one_way_asks_for_what_it_lacks() {
    // Always the same speed, direction and pull: friction is one number, inertia is none.
    let all = turned(1, 12.0, |t| ([5.0 * t, 5.0, 0.0], 1.0)).report().enough;
    let asked = |name: &str| of(&all, name).missing.as_ref().map(|m| m.motion);
    assert_eq!(asked("inertia_kg_m2"), Some(Motion::Accelerate));
    assert_eq!(asked("viscous_N_s_m"), Some(Motion::OtherSpeeds));
    assert_eq!(asked("friction_mu"), Some(Motion::PushAndPull));
    // Constant friction hides behind both and needs two motions: the others' are named, its own may not be.
    assert_eq!(of(&all, "coulomb_N").share, 0.0);
    assert!(of(&all, "radius_m").share >= 1.0 && of(&all, "radius_m").missing.is_none());
}

#[test]
fn a_lively_turn_asks_for_nothing() {
    let way = |t: f64| {
        let (s, c) = (1.3 * t).sin_cos();
        let (fast, quick) = (9.0 * t).sin_cos();
        let angle = [7.0 * s + 0.25 * fast, 9.1 * c + 2.25 * quick, -11.8 * s - 20.0 * fast];
        (angle, 1.5 * (2.1 * t).sin())
    };
    let online = turned(2, 40.0, way);
    let report = online.report();
    let lacking: Vec<_> = report.enough.iter().filter(|e| e.missing.is_some()).collect();
    assert!(lacking.is_empty(), "{lacking:?}");
    for (name, truth) in [("weight_N", 0.3), ("friction_mu", 0.05), ("viscous_N_s_m", 1.2), ("coulomb_N", 0.06)] {
        let p = report.parameters.iter().find(|p| p.name == name).expect("reported");
        let (value, error) = (p.value.expect("shown"), p.std_error.expect("shown"));
        assert!((value - truth).abs() < 4.0 * error && error < 0.1 * truth, "{name}: {value} ± {error}, truly {truth}");
    }
}
