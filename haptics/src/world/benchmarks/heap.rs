//! Many blocks: towers, heaps, and a plank that leans.

use super::super::*;
use super::{AWAY, DT, run};
use crate::Vec2;

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

fn thirty(arrange: impl Fn(usize) -> Pose) -> (World, State) {
    let mut world = World::empty("thirty blocks");
    world.floor = Some(Floor { height_m: 0.0, ..Floor::default() });
    world.blocks = (0..30)
        .map(|i| {
            let mut block = Block::upright(&format!("block-{}", i + 1), 0.04, 0.02, 0.015, 0.0, 0.0);
            block.start = arrange(i);
            block
        })
        .collect();
    world.check().expect("a valid world");
    let state = State::new(&world, AWAY);
    (world, state)
}

#[test]
fn thirty_blocks_stand_in_towers_without_creep() {
    let place = |i: usize| Vec2::new(0.03 * (i / 5) as f64, 0.0075 + 0.015 * (i % 5) as f64);
    let (world, mut state) = thirty(|i| Pose { center_m: place(i), angle_rad: 0.0 });
    run(&world, &mut state, 5.0);
    let settled = state.bodies.clone();
    run(&world, &mut state, 60.0);
    for (i, (now, then)) in state.bodies.iter().zip(&settled).enumerate() {
        assert!((now.center_m - then.center_m).norm() < 1e-8, "block {i} creeps");
        assert!((now.center_m - place(i)).norm() < 1e-3 && now.angle_rad.abs() < 1e-3, "block {i}: {now:?}");
    }
}

#[test]
fn thirty_blocks_fall_into_a_heap_and_come_to_rest() {
    // Rows of tilted blocks rain down; nothing may end inside anything else, fly off or keep rattling.
    let (world, mut state) = thirty(|i| Pose {
        center_m: Vec2::new(0.024 * (i % 5) as f64 + 0.003 * (i / 5) as f64, 0.02 + 0.03 * (i / 5) as f64),
        angle_rad: 0.7 * (i as f64 * 1.7).sin(),
    });
    run(&world, &mut state, 20.0);
    for (i, body) in state.bodies.iter().enumerate() {
        assert!(body.center_m.y > 0.005 && body.center_m.norm() < 0.6, "block {i} at {:?}", body.center_m);
        assert!(body.velocity_m_s.norm() < 1e-4, "block {i} still moves at {} m/s", body.velocity_m_s.norm());
    }
    // The most that the whole weight could press one contact in is 30 · 0.39 N / 4000 N/m = 3 mm; in a heap it is far less.
    let deepest = state.contacts.iter().map(|c| c.depth_m).fold(0.0, f64::max);
    assert!(deepest < 1e-3, "{deepest} m");
    let mut again = state.clone();
    run(&world, &mut again, 60.0);
    for (now, then) in again.bodies.iter().zip(&state.bodies) {
        assert!((now.center_m - then.center_m).norm() < 1e-6, "the heap creeps");
    }
}

/// True if a thin plank leaning on a heavy block stays up. Floor and wall have the same friction mu: it holds above tan
/// θ = (1 − mu²)/(2 mu).
fn leaning_plank_stays(angle_rad: f64, friction: f64) -> bool {
    let mut world = World::empty("plank");
    world.floor = Some(Floor { height_m: 0.0, friction, ..Floor::default() });
    let mut wall = Block::upright("wall", 5.0, 0.2, 0.2, 0.1, 0.0);
    let mut plank = Block::upright("plank", 0.05, 0.1, 0.001, 0.0, 0.0);
    // The wall stands where its weight has pressed it to: it must not bounce under the plank.
    wall.start.center_m.y -= wall.mass_kg * 9.81 / (2.0 * 8000.0);
    let (sin, cos) = angle_rad.sin_cos();
    // Lower end on the floor, upper right corner on the wall's left face at x = 0.
    let center_m = Vec2::new(-0.05 * cos - 0.0005 * sin.abs(), 0.05 * sin + 0.0005 * cos);
    plank.start = Pose { center_m, angle_rad };
    world.blocks = vec![wall, plank];
    let mut state = State::new(&world, AWAY);
    // It settles on rough surfaces first: a plank that is just let go slides from the jolt.
    for percent in 0..=100 {
        let now = 2.0 + (friction - 2.0) * f64::from(percent) / 100.0;
        world.floor.as_mut().expect("there is one").friction = now;
        world.blocks.iter_mut().for_each(|b| b.block_friction = now);
        run(&world, &mut state, 0.02);
    }
    run(&world, &mut state, 2.0);
    (state.bodies[1].angle_rad - angle_rad).abs() < 0.02
}

#[test]
fn a_plank_wedges_against_a_wall_above_the_ladder_angle_only() {
    let friction: f64 = 0.5;
    let limit = ((1.0 - friction * friction) / (2.0 * friction)).atan();
    assert!(leaning_plank_stays(1.05 * limit, friction), "held above {limit} rad");
    assert!(!leaning_plank_stays(0.95 * limit, friction), "slides below it");
}

#[test]
fn a_block_wedged_between_two_hands_carries_more_than_its_weight_by_friction() {
    // Two side blocks pressed together by the fingers hold a third between them: a chain of four friction contacts. Each
    // finger presses 2 N; the middle block hangs if mu 2 · 2 N exceeds its weight, with mu = 0.5: 2 N against 0.49 N.
    let mut world = World::empty("wedge");
    world.floor = None;
    let mut block = |x: f64, mass: f64| {
        let mut block = Block::upright("b", mass, 0.02, 0.02, x, -0.01);
        block.finger_friction = 1.0;
        world.blocks.push(block);
    };
    block(-0.02, 0.02);
    block(0.0, 0.05);
    block(0.02, 0.02);
    let press = 2.0 / world.pad.stiffness_n_m;
    let mut state = State::new(&world, [Vec2::new(-0.03 + press, 0.0), Vec2::new(0.03 - press, 0.0)]);
    let input = state.input;
    for _ in 0..10_000 {
        step(&world, &mut state, &input, DT);
    }
    assert!(state.bodies[1].center_m.y.abs() < 2e-3, "the middle one hangs: {:?}", state.bodies[1]);
}
