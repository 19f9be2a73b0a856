//! Details of the world that nothing else would miss, each against a number computed by hand.

use super::super::*;
use super::{AWAY, DT, run, single};
use crate::Vec2;
use crate::law::contact::VelocityLoss;
use crate::law::{Effect, Inertia, Weight};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

const FINE: f64 = 1e-5;

fn run_finely(world: &World, state: &mut State, seconds: f64) {
    let input = state.input;
    for _ in 0..(seconds / FINE).round() as usize {
        step(world, state, &input, FINE);
    }
}

#[test]
fn blocks_rub_with_the_geometric_mean_of_their_frictions() {
    // 0.8 on 0.2: √0.16 = 0.4 (their mean would be 0.5, the smaller 0.2). Above the friction angle of 21.8° the upper block
    // slides by g (sin − mu cos) t²/2 on a long, heavy one that sticks to the floor.
    let mut world = World::empty("test");
    // Stiff and nearly critically damped under the heavy one: it must not sway.
    world.floor =
        Some(Floor { height_m: 0.0, friction: 5.0, stiffness_n_m: 20_000.0, damping_n_s_m: 150.0, ..Floor::default() });
    world.blocks = vec![
        Block { block_friction: 0.8, ..Block::upright("block-1", 0.05, 0.03, 0.01, 0.0, 0.01) },
        Block { block_friction: 0.2, ..Block::upright("block-2", 1.0, 2.0, 0.01, 0.0, 0.0) },
    ];
    world.check().expect("a valid world");
    let mut state = State::new(&world, AWAY);
    let apart = |state: &State| state.bodies[0].center_m.x - state.bodies[1].center_m.x;
    let limit = 0.4_f64.atan();
    run(&world, &mut state, 1.0);
    for percent in 1..=100 {
        world.tilt_rad = 0.95 * limit * f64::from(percent) / 100.0;
        run(&world, &mut state, 0.005);
    }
    let start = apart(&state);
    run(&world, &mut state, 0.5);
    assert!((apart(&state) - start).abs() < 2e-4, "sticks below the friction angle: {}", apart(&state) - start);
    let (angle, start) = (1.5 * limit, apart(&state));
    world.tilt_rad = angle;
    run(&world, &mut state, 0.5);
    let expected = 0.5 * 9.81 * (angle.sin() - 0.4 * angle.cos()) * 0.25;
    let slid = apart(&state) - start;
    assert!((slid / expected - 1.0).abs() < 0.02, "slid {slid}, expected {expected}");
}

/// A crank of 50 g at the handle with nothing but a weight, N.
fn bare_crank(weight_n: f64, start_rad: f64, stiffness_n_m: Option<f64>) -> (World, State) {
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    crank.effects = vec![Effect::new(&Inertia, &[0.05]), Effect::new(&Weight, &[weight_n])];
    (crank.start_rad, crank.constraint_stiffness_n_m) = (start_rad, stiffness_n_m);
    let state = State::new(&world, AWAY);
    (world, state)
}

#[test]
fn the_arm_carries_the_part_of_the_weight_along_it() {
    // Outwards: W sin θ. On top the arm carries the whole weight, level with the axis none of it, below it pulls inwards.
    for (angle, expected_n) in [(FRAC_PI_2, 0.5), (FRAC_PI_6, 0.25), (0.0, 0.0), (-FRAC_PI_2, -0.5)] {
        let (world, mut state) = bare_crank(0.5, angle, None);
        let input = state.input;
        // Too short to gain speed: 1 µs of 10 m/s².
        step(&world, &mut state, &input, 1e-6);
        let found_n = state.crank.constraint_force_n;
        assert!((found_n - expected_n).abs() < 1e-5, "{found_n} N at {angle}, not {expected_n}");
    }
}

#[test]
fn the_arm_holds_the_handle_on_its_circle_by_m_v2_over_r() {
    for stiffness in [None, Some(8000.0)] {
        let (world, mut state) = bare_crank(0.0, 0.0, stiffness);
        let radius = world.crank.as_ref().expect("there is one").radius_m;
        state.crank.rate_rad_s = 0.6 / radius;
        run(&world, &mut state, 1.0);
        let expected_n = -0.05 * 0.6 * 0.6 / radius;
        let found_n = state.crank.constraint_force_n;
        assert!((found_n / expected_n - 1.0).abs() < 1e-3, "{stiffness:?}: {found_n} N, not {expected_n}");
        // An arm that yields is longer by that.
        let given_m = stiffness.map_or(0.0, |k| -expected_n / k);
        assert!((state.crank.radial_m - given_m).abs() < 1e-3 * given_m + 1e-12, "{}", state.crank.radial_m);
    }
}

#[test]
fn a_taut_cable_takes_what_its_damping_says() {
    // A body that runs into its cable is a bounce: k = 600 N/m, b = 2 N s/m, m = 50 g, ζ = b/(2 √(k m)) = 0.1826, and
    // e = exp(−2 ζ acos ζ/√(1 − ζ²)) (Schwager & Pöschel 2007) = 0.596.
    let (mut world, _) = single(0.02, 0.02, 0.0);
    (world.gravity_m_s2, world.floor) = (0.0, None);
    let anchor_m = world.blocks[0].start.center_m - Vec2::new(0.04, 0.0);
    world.blocks[0].cable = Some(Cable { anchor_m, length_m: 0.04, stiffness_n_m: 600.0, damping_n_s_m: 2.0 });
    let mut state = State::new(&world, AWAY);
    state.bodies[0].velocity_m_s.x = 0.3;
    run_finely(&world, &mut state, 0.1);
    let zeta: f64 = 2.0 / (2.0 * (600.0_f64 * 0.05).sqrt());
    let expected = (-2.0 * zeta * zeta.acos() / (1.0 - zeta * zeta).sqrt()).exp();
    let left = -state.bodies[0].velocity_m_s.x / 0.3;
    assert_eq!(state.bodies[0].cable_n, 0.0, "it is slack again");
    assert!((left - expected).abs() < 0.005, "{left} against {expected}");
}

#[test]
fn a_heavy_knob_leans_on_its_stop_with_its_weight() {
    for tilt_rad in [0.0, -0.2] {
        let mut world = presets::switch();
        world.tilt_rad = tilt_rad;
        let switch = world.switch.as_mut().expect("there is one");
        // 2.943 N on a lever of 30 mm.
        switch.mass_kg = 0.3;
        let lever_m = switch.lever_m;
        let mut state = State::new(&world, AWAY);
        run(&world, &mut state, 3.0);
        assert!(state.switch.rate_m_s.abs() < 1e-6, "it rests");
        // The hold along its arc is W sin of the lever's lean, the more of it the more the set-up is tilted.
        let lean_rad = state.switch.at_m / lever_m + tilt_rad;
        let expected_n = 0.3 * 9.81 * lean_rad.sin();
        assert!(expected_n < -0.7, "it leans to the left: {expected_n} N");
        assert!((state.switch.force_n / expected_n - 1.0).abs() < 1e-3, "{} N, not {expected_n}", state.switch.force_n);
    }
}

#[test]
fn an_oblique_landing_loses_mu_times_what_turns_round() {
    // A flat plate cannot turn: friction acts half a millimetre below its middle. Sliding throughout, it loses
    // mu (1 + e) v = 0.2 · 1.5 · 0.3 = 0.09 m/s along the floor (Routh 1877), whatever the floor's own friction.
    let loss = VelocityLoss { e: 0.5, mu: 0.2 };
    let (mut world, mut state) = single(0.2, 0.001, 0.0005);
    world.floor = Some(Floor { height_m: 0.0, friction: 0.9, loss: Some(loss), ..Floor::default() });
    world.gravity_m_s2 = 0.0;
    state.bodies[0].velocity_m_s = Vec2::new(0.8, -0.3);
    run_finely(&world, &mut state, 0.1);
    let after = state.bodies[0].velocity_m_s;
    let (expected_y, expected_x) = loss.after(-0.3, 0.8);
    assert!((after.y - expected_y).abs() < 0.006, "{} against {expected_y}", after.y);
    let lost = 0.8 - after.x;
    assert!((lost - 0.09).abs() < 0.004 && (expected_x - 0.71).abs() < 1e-12, "{lost} m/s");
    // And a coarse tick takes the same.
    let (_, mut coarse) = single(0.2, 0.001, 0.0005);
    coarse.bodies[0].velocity_m_s = Vec2::new(0.8, -0.3);
    run(&world, &mut coarse, 0.1);
    let lost = 0.8 - coarse.bodies[0].velocity_m_s.x;
    assert!((lost - 0.09).abs() < 0.004, "{lost} m/s in ticks of {DT} s");
}
