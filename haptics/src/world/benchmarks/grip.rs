//! Held between the fingers: friction cone, creep, hardening pads.

use super::super::*;
use super::run;
use crate::Vec2;
use crate::law::contact::FingertipSlip;

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
fn a_pad_gets_hard_towards_its_thickness_and_stays_calm_there() {
    // 2 mm of 2500 N/m: at 1.5 mm the foam is as it was, 3.75 N. At 2 mm 5 N and 1.05 N of closing cells; at 2.5 mm 6.25 N and
    // 7.5 kN/m from 1.86 mm on, 4.8 N.
    for (pressed_m, force_n) in [(1.5e-3, 3.75), (2.0e-3, 6.05), (2.5e-3, 11.05)] {
        let (world, state) = pinched(pressed_m, 0.9);
        assert!((state.tip_force_n[0].x - force_n).abs() < 1e-6, "{pressed_m} m: {:?}", state.tip_force_n);
        assert!(state.bodies[0].velocity_m_s.norm() < 1e-9, "{pressed_m} m: it rings");
        assert!((world.pad.elastic().depth_m(force_n) - pressed_m).abs() < 1e-9);
    }
    // A finger that has it thicker has the linear pad again; a file from before has the foam of the thesis.
    let (mut world, _) = pinched(0.5e-3, 0.9);
    let text = world.to_json().replace("    \"thickness_m\": 0.002,\n", "");
    assert!(!text.contains("thickness") && World::from_json(&text).expect("an older file") == world);
    world.pad.thickness_m = 0.004;
    let mut state = State::new(&world, [Vec2::new(-0.0075, 0.0), Vec2::new(0.0075, 0.0)]);
    run(&world, &mut state, 3.0);
    assert!((state.tip_force_n[0].x - 6.25).abs() < 1e-6, "{:?}", state.tip_force_n);
    world.pad.thickness_m = 0.0;
    assert!(world.check().expect_err("no pad at all").to_string().contains("thickness_m"));
}

#[test]
fn a_light_block_is_stable_between_pads_that_are_pressed_to_their_end() {
    // A block of 1 g between two closed foams swings at √(2 · 10 kN/m / 1 g) = 4472 rad/s. At 1 kHz it needs the tick
    // divided by the stiffness of the pads there, not at rest. Without damping nothing else would calm it.
    let mut world = World::empty("pinch");
    world.floor = None;
    (world.pad.damping_n_s_m, world.pad.shear_damping_n_s_m) = (0.0, 0.0);
    world.blocks = vec![Block::upright("block-1", 1e-3, 0.02, 0.02, 0.0, -0.01)];
    world.blocks[0].stiffness_n_m = 100.0;
    (world.pad.shear_stiffness_n_m, world.gravity_m_s2) = (10.0, 0.0);
    world.check().expect("it can be stepped");
    let mut state = State::new(&world, [Vec2::new(-0.0075, 0.0), Vec2::new(0.0075, 0.0)]);
    // 0.1 mm aside: x = 1e-4 cos ω t, for ever.
    state.bodies[0].center_m.x = 1e-4;
    let input = state.input;
    let (mut most_m, mut late_m) = (0.0_f64, 0.0_f64);
    for tick in 0..20_000 {
        step(&world, &mut state, &input, 1e-3);
        most_m = most_m.max(state.bodies[0].center_m.x.abs());
        late_m = if tick > 19_000 { late_m.max(state.bodies[0].center_m.x.abs()) } else { 0.0 };
    }
    assert!((most_m / 1e-4 - 1.0).abs() < 0.05 && (late_m / 1e-4 - 1.0).abs() < 0.05, "{most_m} m, later {late_m} m");
}

/// Creep of the platform notes' grip, m from 5 s to the end: 0.2 kg, friction 0.9, 2.4 N pinch (margin 2.2).
fn creep_m(dt_s: f64, seconds: f64) -> f64 {
    let mut world = World::empty("grip");
    world.floor = None;
    let mut block = Block::upright("block-1", 0.2, 0.03, 0.03, 0.0, 0.0);
    block.finger_friction = 0.9;
    block.start.center_m = Vec2::zeros();
    world.blocks = vec![block];
    let grip = 2.4 / world.pad.stiffness_n_m;
    let mut state = State::new(&world, [Vec2::new(-0.015 + grip, 0.0), Vec2::new(0.015 - grip, 0.0)]);
    let input = state.input;
    let mut held = None;
    for _ in 0..(seconds / dt_s).round() as usize {
        step(&world, &mut state, &input, dt_s);
        if state.time_s > 5.0 {
            held.get_or_insert(state.bodies[0].center_m);
        }
    }
    (state.bodies[0].center_m - held.expect("longer than 5 s")).norm()
}

#[test]
fn a_grip_holds_for_ten_minutes_at_1_khz_and_at_10_khz() {
    for dt_s in [1e-3, 1e-4] {
        let creep_m = creep_m(dt_s, 600.0);
        assert!(creep_m < 1e-7, "at {dt_s} s it crept by {creep_m} m, 0.1 mm are allowed");
    }
}

#[test]
fn a_trembling_grip_does_not_let_the_block_walk() {
    // 10 Hz, 0.06 mm up and down, well inside the cone: the block follows and stays where it is in the grasp.
    let (world, mut state) = pinched(0.0008, 0.9);
    let grasp = |state: &State| state.bodies[0].center_m.y - state.input.tip_in_world[0].y;
    let start = grasp(&state);
    let tips = state.input.tip_in_world;
    for tick in 1..=600_000_u32 {
        let phase = std::f64::consts::TAU * 10.0 * f64::from(tick) * 1e-3;
        let shake = Vec2::new(0.0, 0.06e-3 * phase.sin());
        let velocity = Vec2::new(0.0, 0.06e-3 * std::f64::consts::TAU * 10.0 * phase.cos());
        let input = Input { tip_in_world: tips.map(|t| t + shake), tip_velocity: [velocity; 2] };
        step(&world, &mut state, &input, 1e-3);
    }
    assert!((grasp(&state) - start).abs() < 5e-6, "walked by {}", grasp(&state) - start);
}

#[test]
fn a_slip_at_a_given_time_lowers_what_is_held_by_its_way() {
    let (mut world, mut state) = pinched(0.0008, 0.9);
    let before = state.bodies[0].center_m.y;
    let slip = FingertipSlip { way_m: Vec2::new(0.0, 2e-3), t0_s: 4.0, duration_s: 1.0 };
    world.pad.slip = Some(slip);
    run(&world, &mut state, 5.0);
    // The grasp point climbs 2 mm on the object, so the object is 2 mm lower under the same load.
    let sunk = before - state.bodies[0].center_m.y;
    assert!((sunk - 2e-3).abs() < 1e-6, "{sunk}");
    assert!((state.tip_force_n[0].y + state.tip_force_n[1].y - 0.05 * 9.81).abs() < 1e-6);
}

#[test]
fn identified_foam_and_blocks_are_stable_at_1_khz() {
    // The worlds that the built-in recordings were calibrated to, and the stiffest that a recording could have told.
    for (file, factor) in [("demo-blocks", 1.0), ("demo-blocks", 20.0)] {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../assets/worlds/{file}.json"));
        let mut world = World::load(&path).expect("a built-in world");
        world.pad.stiffness_n_m *= factor;
        world.pad.shear_stiffness_n_m *= factor;
        let mut state = State::resting(&world);
        run(&world, &mut state, 1.0);
        let (upper, width_m) = (state.bodies[0].center_m, world.blocks[0].width_m);
        let half = Vec2::new(0.5 * width_m - 1.5 / world.pad.stiffness_n_m, 0.0);
        state.input.tip_in_world = [upper - half, upper + half];
        run(&world, &mut state, 3.0);
        assert!((state.tip_force_n[0].x - 1.5).abs() < 0.05, "{factor}: {:?}", state.tip_force_n);
        let still = state.bodies.iter().all(|b| b.velocity_m_s.norm() < 1e-9 && b.rate_rad_s.abs() < 1e-7);
        assert!(still, "{factor}: it rings: {:?}", state.bodies);
    }
}
