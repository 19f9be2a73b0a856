//! Tests of protections of the operator and of the energy account that no other test would miss.

use super::config::ServoConfig;
use super::control_loop::Loop;
use super::coupling::{Coupling, Proxy};
use super::safety::Limits;
use super::swap::Swap;
use super::thread::Servo;
use crate::Vec2;
use crate::device::{Command, Device, DeviceSpec, Sample};
use crate::world::{Input, State, World, presets, step};
use std::time::{Duration, Instant};

const T: f64 = 1e-3;

fn spec(force_feedback: bool, max_force_n: f64) -> DeviceSpec {
    DeviceSpec {
        name: "Held".to_owned(),
        force_feedback,
        max_force_n,
        damping_n_s_m: 0.5,
        coulomb_n: 0.0,
        resolution_m: 0.0,
    }
}

/// Fingers that are pressed into the table, up and down by a little, whatever the force.
struct Held {
    spec: DeviceSpec,
    deep_m: f64,
    swing_m: f64,
    time_s: f64,
}

/// Still, so deep in the table, m.
fn held(spec: DeviceSpec, deep_m: f64) -> Held {
    Held { spec, deep_m, swing_m: 0.0, time_s: 0.0 }
}

fn table_m() -> f64 {
    presets::table().floor.expect("a table").height_m
}

impl Device for Held {
    fn spec(&self) -> &DeviceSpec {
        &self.spec
    }

    fn exchange(&mut self, _: &Command, dt_s: f64) -> Sample {
        self.time_s += dt_s;
        let (sin, cos) = (10.0 * self.time_s).sin_cos();
        let tip = |x: f64| Vec2::new(x, table_m() - self.deep_m + self.swing_m * sin);
        let velocity = Vec2::new(0.0, 10.0 * self.swing_m * cos);
        Sample { tip_in_world: [tip(-0.03), tip(0.03)], tip_velocity: [velocity; 2], fresh: [true; 2] }
    }

    fn make_safe(&mut self) {}
}

/// A table under pads that are so soft that a device of 0.5 N s/m renders them directly.
fn soft() -> World {
    let mut world = presets::table();
    (world.pad.stiffness_n_m, world.pad.shear_stiffness_n_m) = (60.0, 40.0);
    (world.pad.damping_n_s_m, world.pad.shear_damping_n_s_m) = (0.02, 0.02);
    world
}

#[test]
fn a_device_that_is_weaker_than_the_limit_is_never_told_more_than_it_can() {
    // 1.5 mm of the pad's 2500 N/m is far beyond both limits' lower one; the device can make 0.5 N, the servo allows 4 N.
    let config = ServoConfig { real_time: false, ..ServoConfig::at(1000.0) };
    assert!(config.limits.max_force_n > 3.0);
    let device = Box::new(held(spec(false, 0.5), 1.5e-3));
    let mut servo = Servo::start(Swap::new(presets::table()), device, config).expect("a thread");
    let begun = Instant::now();
    while servo.newest().state.tick < 800 && begun.elapsed() < Duration::from_secs(20) {
        std::thread::yield_now();
    }
    let mut ticks = Vec::new();
    servo.drain(&mut ticks);
    let most = ticks.iter().flat_map(|tick| tick.sent_force_n).map(|force| force.norm()).fold(0.0, f64::max);
    assert!(ticks.len() >= 800 && most > 0.49, "the world presses: {most} N");
    assert!(most < 0.5 + 1e-9, "{most} N");
    assert!(ticks.iter().any(|tick| tick.flags.saturated), "and it is said");
}

#[test]
fn a_swap_to_a_stiffer_world_couples_the_device_and_one_to_a_softer_world_frees_it() {
    let device = Box::new(held(spec(true, 4.0), 1e-3));
    let mut servo = Loop::new(Swap::new(soft()), device, Limits::default());
    servo.tick(T);
    assert_eq!(servo.coupling(), None, "the soft pads are rendered directly");
    servo.swap(Swap::new(presets::table()));
    servo.tick(T);
    assert_eq!(servo.coupling(), Some(Coupling::passive(&spec(true, 4.0), T, 0.0)));
    servo.swap(Swap::new(soft()));
    servo.tick(T);
    assert_eq!(servo.coupling(), None);
}

#[test]
fn the_observer_counts_the_way_of_the_device_and_not_that_of_the_tips() {
    let device = Box::new(Held { spec: spec(true, 4.0), deep_m: 2e-3, swing_m: 1e-3, time_s: 0.0 });
    let limits = Limits { ramp_s: T, ..Limits::default() };
    let mut servo = Loop::new(Swap::new(presets::table()), device, limits);
    let mut last = servo.tick(T);
    let (mut by_device_j, mut by_tips_j) = (0.0, 0.0);
    // A quarter of a swing: work goes in and has not come back.
    for _ in 0..470 {
        let now = servo.tick(T);
        for finger in 0..2 {
            let held_n = -last.sent_force_n[finger];
            by_device_j += held_n.dot(&(now.device_in_world[finger] - last.device_in_world[finger]));
            by_tips_j += held_n.dot(&(now.input.tip_in_world[finger] - last.input.tip_in_world[finger]));
        }
        last = now;
    }
    assert!(servo.coupling().is_some());
    assert!((by_device_j - by_tips_j).abs() > 1e-4, "they differ: {by_device_j} J and {by_tips_j} J");
    assert!((last.energy_j - by_device_j).abs() < 1e-9, "{} J, should be {by_device_j} J", last.energy_j);
}

#[test]
fn after_a_force_test_the_world_comes_back_softly() {
    let mut servo = Loop::new(Swap::new(presets::table()), Box::new(held(spec(false, 4.0), 1.2e-3)), Limits::default());
    let mut run = |ticks: usize, test: Option<[Vec2; 2]>| {
        servo.test_force(test);
        (0..ticks).map(|_| servo.tick(T).sent_force_n[0].y).collect::<Vec<_>>()
    };
    let pressed = run(1_000, None)[999];
    assert!(pressed > 2.0, "{pressed} N");
    let tested = run(1_000, Some([Vec2::new(0.0, 0.2); 2]))[999];
    assert!((tested - 0.2).abs() < 1e-9, "{tested} N");
    let back = run(1_000, None);
    let steepest = back.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max);
    // The start ramp takes half a second, and the test's last force fades under it: together no more than twice as steep. The
    // slew limit alone would allow 2 N a tick.
    assert!(steepest < 2.0 * pressed * T / Limits::default().ramp_s, "{steepest} N a tick");
    assert!((back[999] - pressed).abs() < 1e-6, "{} N", back[999]);
}

#[test]
fn a_world_that_has_blown_up_leaves_the_tips_at_the_fingers() {
    let world = presets::table();
    let at = [Vec2::new(-0.03, table_m() + 0.01), Vec2::new(0.03, table_m() + 0.01)];
    let mut state = State::new(&world, at);
    let mut proxy = Proxy::new(Coupling::passive(&spec(true, 4.0), T, 0.0), Input { tip_in_world: at, ..state.input });
    let moved = at.map(|tip| tip + Vec2::new(0.002, 0.001));
    let device = Sample { tip_in_world: moved, tip_velocity: [Vec2::new(0.1, 0.0); 2], fresh: [true; 2] };
    state.tip_force_n = [Vec2::new(f64::NAN, 0.0), Vec2::new(0.0, f64::INFINITY)];
    let tips = proxy.follow(&device, &world, &state, T);
    assert_eq!((tips.tip_in_world, tips.tip_velocity), (moved, [Vec2::zeros(); 2]));
    assert_eq!(proxy.force_n(&device).map(|force| force.norm() < 0.1), [true; 2], "no force is made of it");
    // And on it goes, in a world that is in order again.
    let mut state = State::new(&world, moved);
    let tips = proxy.follow(&device, &world, &state, T);
    step(&world, &mut state, &tips, T);
    assert!(tips.tip_in_world.iter().zip(moved).all(|(tip, finger)| (tip - finger).norm() < 1e-3));
}
