//! Analytic benchmarks: the world against numbers worked out on paper.

#![cfg(test)]

use super::*;
use crate::Vec2;

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
    // Semi-implicit Euler falls g t dt/2 further per part than t²g/2.
    let part_s = DT / f64::from(substeps(&world, DT));
    let expected = 1.01 - 0.5 * 9.81 * 0.3 * (0.3 + part_s);
    assert!((state.bodies[0].center_m.y - expected).abs() < 1e-9);
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

/// How far a block slides in 3 s on a floor tilted by `angle_rad`, m. It settles on the flat floor first.
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
        // Semi-implicit Euler conserves a nearby energy: it may ripple by a small share, never pump.
        assert!(now <= highest + 0.02 * start, "energy rose from {highest} to {now} at {}", state.time_s);
        highest = highest.min(now);
    }
}

fn pinched(grip_m: f64, friction: f64) -> (World, State) {
    let mut world = World::empty("pinch");
    world.floor = None;
    let mut block = Block::upright("block-1", 0.05, 0.02, 0.02, 0.0, 0.0);
    block.finger_friction = friction;
    block.start.center_m = Vec2::zeros();
    world.blocks = vec![block];
    let mut state = State::new(&world, [Vec2::new(-0.01 + grip_m, 0.0), Vec2::new(0.01 - grip_m, 0.0)]);
    run(&world, &mut state, 3.0);
    (world, state)
}

#[test]
fn a_pinch_holds_within_the_friction_cone_only() {
    // 0.4905 N needs mu · 2 · K · x: with K = 2500 N/m and x = 0.5 mm, mu must exceed 0.1962.
    let (world, state) = pinched(0.0005, 0.5);
    let sag = -state.bodies[0].center_m.y;
    assert!((sag - 0.05 * 9.81 / (2.0 * world.pad.shear_stiffness_n_m)).abs() < 1e-6, "hangs in the pads: {sag}");
    assert!((state.tip_force_n[0].x - 1.25).abs() < 1e-6 && (state.tip_force_n[1].x + 1.25).abs() < 1e-6);
    assert!((state.tip_force_n[0].y + state.tip_force_n[1].y - 0.4905).abs() < 1e-6);
    let (world, mut held) = pinched(0.0005, 0.2);
    let before = held.bodies[0].center_m.y;
    run(&world, &mut held, 10.0);
    assert!((held.bodies[0].center_m.y - before).abs() < 1e-9, "just inside the cone it sticks");
    let (_, dropped) = pinched(0.0005, 0.19);
    assert!(dropped.bodies[0].center_m.y < -0.05, "outside the cone it falls");
}

#[test]
fn a_grip_with_margin_two_does_not_creep() {
    // The grip of the platform notes: 0.2 kg, friction 0.9, 2.4 N pinch: margin 2.2.
    let mut world = World::empty("grip");
    world.floor = None;
    let mut block = Block::upright("block-1", 0.2, 0.03, 0.03, 0.0, 0.0);
    block.finger_friction = 0.9;
    block.start.center_m = Vec2::zeros();
    world.blocks = vec![block];
    let grip = 2.4 / world.pad.stiffness_n_m;
    let mut state = State::new(&world, [Vec2::new(-0.015 + grip, 0.0), Vec2::new(0.015 - grip, 0.0)]);
    run(&world, &mut state, 5.0);
    let held = state.bodies[0];
    run(&world, &mut state, 60.0);
    assert!((state.bodies[0].center_m - held.center_m).norm() < 1e-7);
}

#[test]
fn stacked_blocks_stand() {
    let mut world = World::empty("tower");
    world.floor = Some(Floor { height_m: 0.0, ..Floor::default() });
    world.blocks = (0..10)
        .map(|i| Block::upright(&format!("block-{}", i + 1), 0.04, 0.02, 0.015, 0.0, 0.015 * f64::from(i)))
        .collect();
    let mut state = State::new(&world, AWAY);
    run(&world, &mut state, 5.0);
    for (i, body) in state.bodies.iter().enumerate() {
        assert!(body.center_m.x.abs() < 1e-4 && body.angle_rad.abs() < 1e-3, "block {i}: {body:?}");
        assert!((body.center_m.y - (0.0075 + 0.015 * i as f64)).abs() < 3e-3);
    }
}

#[test]
fn crank_spins_down_under_coulomb_and_viscous_friction() {
    // m dv/dt = −Fc − c v stops at t = (m/c) ln(1 + c v0/Fc).
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    let (mass, coulomb, viscous, speed) = (0.05, 0.01, 0.1, 0.3);
    crank.effects = vec![
        crate::law::Effect::new(&crate::law::Inertia, &[mass]),
        crate::law::Effect::new(&crate::law::CoulombFriction, &[coulomb]),
        crate::law::Effect::new(&crate::law::ViscousFriction, &[viscous]),
    ];
    let radius = crank.radius_m;
    let mut state = State::new(&world, AWAY);
    state.crank.rate_rad_s = speed / radius;
    let input = state.input;
    let mut ticks = 0;
    while state.crank.rate_rad_s != 0.0 && ticks < 10_000 {
        step(&world, &mut state, &input, DT);
        ticks += 1;
    }
    let expected = mass / viscous * (1.0 + viscous * speed / coulomb).ln();
    assert!((f64::from(ticks) * DT - expected).abs() < 2.0 * DT, "{} against {expected}", f64::from(ticks) * DT);
}

#[test]
fn crank_swings_with_the_pendulum_period() {
    // A handle whose weight is m g swings like a mathematical pendulum: T = 2π sqrt(R/g) for small angles.
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    crank.effects = vec![
        crate::law::Effect::new(&crate::law::Inertia, &[0.05]),
        crate::law::Effect::new(&crate::law::Weight, &[0.05 * 9.81]),
    ];
    crank.start_rad = -std::f64::consts::FRAC_PI_2 + 0.05;
    let expected = std::f64::consts::TAU * (crank.radius_m / 9.81).sqrt();
    let mut state = State::new(&world, AWAY);
    let input = state.input;
    let (mut crossings, mut last) = (Vec::new(), 1.0);
    while crossings.len() < 21 {
        step(&world, &mut state, &input, 1e-4);
        let swing = state.crank.angle_rad + std::f64::consts::FRAC_PI_2;
        if swing.signum() != last {
            crossings.push(state.time_s);
        }
        last = swing.signum();
    }
    let period = (crossings[20] - crossings[0]) / 10.0;
    assert!((period / expected - 1.0).abs() < 1e-3, "{period} against {expected}");
}

#[test]
fn finer_ticks_converge() {
    // A bounce with friction and rotation, at three tick lengths: the error against the finest falls at first order.
    let land = |dt: f64| {
        let (world, mut state) = single(0.02, 0.02, 0.01);
        state.bodies[0].angle_rad = 0.2;
        let input = state.input;
        for _ in 0..(0.05 / dt).round() as usize {
            step(&world, &mut state, &input, dt);
        }
        state.bodies[0].center_m
    };
    let reference = land(1e-6);
    let (coarse, fine) = ((land(1e-4) - reference).norm(), (land(1e-5) - reference).norm());
    assert!(fine < 0.2 * coarse && coarse < 2e-4, "{coarse} then {fine}");
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

#[test]
fn a_hardening_pad_presses_harder() {
    // 0.5 mm: 2500 N/m give 1.25 N, 4e9 N/m³ another 0.5 N; a world without hardening keeps its file as it was.
    let (mut world, _) = pinched(0.0005, 0.9);
    assert!(!world.to_json().contains("cubic"));
    world.pad.cubic_n_m3 = 4e9;
    let mut state = State::new(&world, [Vec2::new(-0.0095, 0.0), Vec2::new(0.0095, 0.0)]);
    run(&world, &mut state, 3.0);
    assert!((state.tip_force_n[0].x - 1.75).abs() < 1e-6, "{:?}", state.tip_force_n);
    assert_eq!(World::from_json(&world.to_json()).expect("reads back"), world);
}

#[test]
fn a_crank_remembers_its_presliding_and_hangs_in_it() {
    // A handle of 0.16 N level with the axis hangs in presliding friction of 0.4 N and 800 N/m: Fc z = W, so z = 0.4 and it
    // sinks by l ln(1/(1 − 0.4)), l = 0.5 mm, along its path (cos θ = 1 to 1e-4), and stays there.
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    crank.effects = vec![
        crate::law::Effect::new(&crate::law::Inertia, &[0.05]),
        crate::law::Effect::new(&crate::law::Weight, &[0.16]),
        crate::law::Effect::new(&crate::law::Hysteresis, &[0.4, 800.0]),
        // Enough to come to rest without overshoot: 2 √(k m) = 13 N s/m.
        crate::law::Effect::new(&crate::law::ViscousFriction, &[20.0]),
    ];
    crank.start_rad = 0.0;
    let radius = crank.radius_m;
    let mut state = State::new(&world, AWAY);
    run(&world, &mut state, 3.0);
    let sunk = -radius * state.crank.angle_rad;
    assert!((sunk / (5e-4 * (1.0_f64 / 0.6).ln()) - 1.0).abs() < 2e-3, "{sunk}");
    run(&world, &mut state, 10.0);
    assert!((-radius * state.crank.angle_rad - sunk).abs() < 1e-9);
}
