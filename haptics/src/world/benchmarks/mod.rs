//! Analytic benchmarks: the world against numbers computed by hand.

#![cfg(test)]

mod captured;
mod convergence;
mod crank;
mod details;
mod fixed;
mod grip;
mod heap;
mod impact;
mod rough;
mod strong;

use super::*;
use crate::Vec2;
use crate::law::contact::VelocityLoss;

const DT: f64 = 1e-3;
const AWAY: [Vec2; 2] = [Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0)];

fn single(width_m: f64, height_m: f64, base_y_m: f64) -> (World, State) {
    let mut world = World::empty("test");
    world.floor = Some(Floor { height_m: 0.0, ..Floor::default() });
    world.blocks = vec![Block::upright("block-1", 0.05, width_m, height_m, 0.0, base_y_m)];
    world.check().expect("a valid world");
    let state = State::new(&world, AWAY);
    (world, state)
}

fn run(world: &World, state: &mut State, seconds: f64) {
    let input = state.input;
    for _ in 0..(seconds / DT).round() as usize {
        step(world, state, &input, DT);
    }
}

#[test]
fn free_fall() {
    let (world, mut state) = single(0.02, 0.02, 1.0);
    run(&world, &mut state, 0.3);
    // A constant force is met exactly, whatever the tick.
    assert!((state.bodies[0].center_m.y - (1.01 - 0.5 * 9.81 * 0.09)).abs() < 1e-12);
    assert!((state.bodies[0].velocity_m_s.y + 9.81 * 0.3).abs() < 1e-12);
}

#[test]
fn rests_at_its_static_compression_without_creep() {
    let (world, mut state) = single(0.02, 0.02, 0.0);
    run(&world, &mut state, 2.0);
    let settled = state.bodies[0];
    let floor = world.floor.expect("there is one");
    let sunk = 0.01 - settled.center_m.y;
    assert!((sunk - 0.05 * 9.81 / (2.0 * floor.stiffness_n_m)).abs() < 1e-9);
    run(&world, &mut state, 10.0);
    assert!((state.bodies[0].center_m - settled.center_m).norm() < 1e-12);
}

/// Distance that a block slides in 3 s on a floor tilted by `angle_rad`, m. It settles on the flat floor first.
fn slope(angle_rad: f64, friction: f64) -> f64 {
    let (mut world, _) = single(0.03, 0.01, 0.0);
    world.floor = Some(Floor { height_m: 0.0, friction, ..Floor::default() });
    let mut state = State::new(&world, AWAY);
    // Tilting slowly keeps the anchors from being overloaded by a jerk.
    for percent in 1..=100 {
        world.tilt_rad = angle_rad.min(0.9 * friction.atan()) * f64::from(percent) / 100.0;
        run(&world, &mut state, 0.005);
    }
    world.tilt_rad = angle_rad;
    let start = state.bodies[0];
    run(&world, &mut state, 3.0);
    state.bodies[0].center_m.x - start.center_m.x
}

#[test]
fn slope_below_and_above_the_friction_angle() {
    let friction: f64 = 0.4;
    let limit = friction.atan();
    assert!(slope(0.97 * limit, friction).abs() < 2e-4, "sticks below the friction angle");
    // Above: s = g (sin − mu cos) t²/2.
    let angle = 1.5 * limit;
    let expected = 0.5 * 9.81 * (angle.sin() - friction * angle.cos()) * 9.0;
    let slid = slope(angle, friction);
    assert!((slid / expected - 1.0).abs() < 0.01, "slid {slid}, expected {expected}");
}

#[test]
fn tips_over_only_beyond_its_tipping_angle() {
    // 10 mm wide, 30 mm high: tips when the centre passes the corner, at atan(1/3) = 18.4 degrees.
    for (angle, falls) in [(0.9 * (1.0_f64 / 3.0).atan(), false), (1.1 * (1.0_f64 / 3.0).atan(), true)] {
        let (mut world, _) = single(0.01, 0.03, 0.0);
        // Balanced on its lower right corner: the centre is half a diagonal above it, turned by the angle.
        let corner_to_center = Vec2::new(-0.005, 0.015);
        let (sin, cos) = (-angle).sin_cos();
        let turned = Vec2::new(
            cos * corner_to_center.x - sin * corner_to_center.y,
            sin * corner_to_center.x + cos * corner_to_center.y,
        );
        world.blocks[0].start = Pose { center_m: turned, angle_rad: -angle };
        let mut state = State::new(&world, AWAY);
        run(&world, &mut state, 2.0);
        let lying = state.bodies[0].angle_rad.abs() > 1.2;
        assert_eq!(lying, falls, "angle {angle}, ended at {}", state.bodies[0].angle_rad);
    }
}

#[test]
fn energy_never_rises_without_work() {
    let (world, mut state) = single(0.02, 0.02, 0.05);
    state.bodies[0].angle_rad = 0.3;
    state.bodies[0].velocity_m_s.x = 0.2;
    let input = state.input;
    let floor = world.floor.expect("there is one");
    let energy = |state: &State| {
        let (block, body) = (&world.blocks[0], &state.bodies[0]);
        let stored: f64 = state
            .contacts
            .iter()
            .map(|c| {
                0.5 * floor.stiffness_n_m * c.depth_m.powi(2)
                    + 0.5 * floor.stiffness_n_m * 2.0 / 3.0 * c.shear_m.powi(2)
            })
            .sum();
        0.5 * block.mass_kg * body.velocity_m_s.norm_squared()
            + 0.5 * block.inertia_kg_m2() * body.rate_rad_s.powi(2)
            + block.mass_kg * 9.81 * body.center_m.y
            + stored
    };
    let mut highest = energy(&state);
    let start = highest;
    for _ in 0..3_000 {
        step(&world, &mut state, &input, DT);
        let now = energy(&state);
        // The stored energy is known for the middle of a part, the rest for its end: a ripple, never a pump.
        assert!(now <= highest + 0.005 * start, "energy rose from {highest} to {now} at {}", state.time_s);
        highest = highest.min(now);
    }
}

#[test]
fn the_same_inputs_give_the_same_bits_on_any_thread() {
    let play = || {
        let world = presets::stacking();
        let mut state = State::resting(&world);
        for tick in 0..4_000_i32 {
            let t = f64::from(tick) * DT;
            let mut input = state.input;
            for (finger, tip) in input.tip_in_world.iter_mut().enumerate() {
                let side = if finger == 0 { -1.0 } else { 1.0 };
                *tip = Vec2::new(-0.014 + side * (0.012 - 0.006 * (t - 0.5).clamp(0.0, 1.0)), -0.11 + 0.01 * t.sin());
            }
            step(&world, &mut state, &input, DT);
        }
        state
    };
    let here = play();
    let there = std::thread::spawn(play).join().expect("the thread finishes");
    assert_eq!(here, there);
    assert!(!here.contacts.is_empty());
}

/// Speed after a flat landing at 0.3 m/s, over that before it.
fn restitution(floor: Floor, dt_s: f64) -> f64 {
    let (mut world, mut state) = single(0.02, 0.02, 0.002);
    world.floor = Some(floor);
    // Without gravity the formula is exact.
    world.gravity_m_s2 = 0.0;
    state.bodies[0].velocity_m_s.y = -0.3;
    let input = state.input;
    for _ in 0..(0.1 / dt_s) as usize {
        step(&world, &mut state, &input, dt_s);
    }
    state.bodies[0].velocity_m_s.y / 0.3
}

#[test]
fn a_bounce_leaves_what_the_damping_says() {
    // Two corners: k = 16 kN/m, b = 12 N s/m, m = 50 g, so ζ = b/(2 √(k m)) = 0.2121 and
    // e = exp(−2 ζ acos ζ/√(1 − ζ²)) (Schwager & Pöschel 2007) = 0.552.
    let floor = Floor { height_m: 0.0, ..Floor::default() };
    let zeta: f64 = 12.0 / (2.0 * (16_000.0_f64 * 0.05).sqrt());
    let expected = (-2.0 * zeta * zeta.acos() / (1.0 - zeta * zeta).sqrt()).exp();
    let fine = restitution(floor, 1e-5);
    assert!((fine - expected).abs() < 0.005, "{fine} against {expected}");
    // At 1 kHz the whole contact lasts five ticks: the damper is half a part late.
    let coarse = restitution(floor, DT);
    assert!((coarse - expected).abs() < 0.02, "{coarse} against {expected}");
}

#[test]
fn a_measured_loss_stands_in_for_damping_and_friction() {
    for e in [0.05, 0.2, 0.5, 0.9] {
        let floor = Floor { height_m: 0.0, loss: Some(VelocityLoss { e, mu: 0.3 }), ..Floor::default() };
        let left = restitution(floor, 1e-5);
        assert!((left - e).abs() < 0.02, "{left} of {e}");
    }
}

#[test]
fn a_block_on_a_slope_of_ten_degrees_does_not_creep_in_ten_minutes() {
    let (mut world, _) = single(0.03, 0.02, 0.0);
    world.floor = Some(Floor { height_m: 0.0, friction: 0.3, ..Floor::default() });
    world.tilt_rad = 10.0_f64.to_radians();
    let mut state = State::new(&world, AWAY);
    run(&world, &mut state, 2.0);
    let settled = state.bodies[0];
    run(&world, &mut state, 600.0);
    let crept = (state.bodies[0].center_m - settled.center_m).norm();
    assert!(crept < 1e-9, "{crept} m");
}
