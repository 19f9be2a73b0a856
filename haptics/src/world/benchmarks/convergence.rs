//! Convergence: scenes of every kind at shorter and shorter ticks, against one that is shorter still.

use super::super::*;
use super::AWAY;
use crate::Vec2;
use crate::law::{CoulombFriction, Effect, Inertia, ViscousFriction};

/// Runs a world for `seconds` in ticks of `dt_s` with the tips where `tips` says.
fn play(world: &World, state: &mut State, dt_s: f64, seconds: f64, tips: impl Fn(f64) -> [Vec2; 2]) {
    let ticks = (seconds / dt_s).round() as u32;
    for tick in 1..=ticks {
        let tip_in_world = tips(f64::from(tick) * dt_s);
        let before = tips(f64::from(tick - 1) * dt_s);
        let tip_velocity = [0, 1].map(|f| (tip_in_world[f] - before[f]) / dt_s);
        step(world, state, &Input { tip_in_world, tip_velocity }, dt_s);
    }
}

/// From 0 at `start_s` to 1 at `end_s`, without a jerk at either end (minimum-jerk: Flash & Hogan 1985).
fn smooth(time_s: f64, start_s: f64, end_s: f64) -> f64 {
    let u = ((time_s - start_s) / (end_s - start_s)).clamp(0.0, 1.0);
    u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
}

/// Place of a block after it was released on or over a table: its centre, and the way of a point 10 mm from it, m.
fn tossed(floor: Floor, start: Pose, velocity_m_s: Vec2, dt_s: f64, seconds: f64) -> Vec<f64> {
    let mut world = World::empty("convergence");
    world.floor = Some(Floor { height_m: 0.0, ..floor });
    world.blocks = vec![Block { start, ..Block::upright("block-1", 0.05, 0.03, 0.02, 0.0, 0.0) }];
    let mut state = State::new(&world, AWAY);
    state.bodies[0].velocity_m_s = velocity_m_s;
    play(&world, &mut state, dt_s, seconds, |_| AWAY);
    let body = state.bodies[0];
    vec![body.center_m.x, body.center_m.y, 0.01 * body.angle_rad]
}

fn fall_and_bounce(dt_s: f64) -> Vec<f64> {
    let start = Pose { center_m: Vec2::new(0.0, 0.0304), angle_rad: 0.0 };
    tossed(Floor::default(), start, Vec2::zeros(), dt_s, 0.1)
}

fn smooth_and_undamped(dt_s: f64) -> Vec<f64> {
    let start = Pose { center_m: Vec2::new(0.0, 0.0304), angle_rad: 0.35 };
    let floor = Floor { friction: 0.0, damping_n_s_m: 0.0, ..Floor::default() };
    tossed(floor, start, Vec2::new(0.1, 0.0), dt_s, 0.1)
}

fn corner_landing(dt_s: f64) -> Vec<f64> {
    let start = Pose { center_m: Vec2::new(0.0, 0.0304), angle_rad: 0.35 };
    tossed(Floor::default(), start, Vec2::new(0.1, 0.0), dt_s, 0.1)
}

fn slide_to_stop(dt_s: f64) -> Vec<f64> {
    let rest_m = 0.01 - 0.05 * 9.81 / 16_000.0;
    let start = Pose { center_m: Vec2::new(0.0, rest_m), angle_rad: 0.0 };
    tossed(Floor::default(), start, Vec2::new(0.3, 0.0), dt_s, 0.2)
}

fn pinch_and_lift(dt_s: f64) -> Vec<f64> {
    let mut world = World::empty("convergence");
    world.floor = Some(Floor { height_m: 0.0, ..Floor::default() });
    world.blocks = vec![Block::upright("block-1", 0.05, 0.02, 0.02, 0.0, 0.0)];
    let tips = |time_s: f64| {
        let half_m = 0.012 - 0.0028 * smooth(time_s, 0.0, 0.1);
        let up_m = 0.011 + 0.01 * smooth(time_s, 0.1, 0.3);
        [Vec2::new(-half_m, up_m), Vec2::new(half_m, up_m)]
    };
    let mut state = State::new(&world, tips(0.0));
    play(&world, &mut state, dt_s, 0.25, tips);
    let body = state.bodies[0];
    vec![body.center_m.x, body.center_m.y, 0.01 * body.angle_rad]
}

fn crank_spin_down(dt_s: f64) -> Vec<f64> {
    let mut world = presets::crank();
    let crank = world.crank.as_mut().expect("there is one");
    crank.effects = vec![
        Effect::new(&Inertia, &[0.05]),
        Effect::new(&CoulombFriction, &[0.05]),
        Effect::new(&ViscousFriction, &[0.1]),
    ];
    let radius_m = crank.radius_m;
    let mut state = State::new(&world, AWAY);
    state.crank.rate_rad_s = 0.3 / radius_m;
    play(&world, &mut state, dt_s, 0.3, |_| AWAY);
    vec![radius_m * state.crank.angle_rad]
}

fn needle_through_the_membrane(dt_s: f64) -> Vec<f64> {
    let world = presets::needle();
    let start_m = world.blocks[0].start.center_m;
    let tips = |time_s: f64| {
        let half = Vec2::new(0.003 - 0.0008 * smooth(time_s, 0.0, 0.05), 0.0);
        let middle = start_m - Vec2::new(0.0, 0.010 * smooth(time_s, 0.05, 0.25));
        [middle - half, middle + half]
    };
    let mut state = State::new(&world, tips(0.0));
    play(&world, &mut state, dt_s, 0.2, tips);
    assert!(state.membrane.holes[0].history.punctured, "it is through");
    vec![state.bodies[0].center_m.x, state.bodies[0].center_m.y]
}

fn switch_thrown(dt_s: f64) -> Vec<f64> {
    let world = presets::switch();
    let knob = world.switch.as_ref().expect("there is one").knob_in_world(-8e-3);
    let tips = |time_s: f64| {
        let left = knob + Vec2::new(-0.007 + 0.0135 * smooth(time_s, 0.0, 0.2), 0.0);
        [left, Vec2::new(0.04, knob.y)]
    };
    let mut state = State::new(&world, tips(0.0));
    play(&world, &mut state, dt_s, 0.16, tips);
    let on_its_way = state.switch.at_m;
    play(&world, &mut state, dt_s, 0.14, |t| tips(0.16 + t));
    assert!(state.switch.at_m > 6e-3, "it snapped over: {}", state.switch.at_m);
    vec![on_its_way, state.switch.at_m]
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

#[test]
fn every_scene_converges_with_the_order_of_its_scheme() {
    // Bodies move by a second-order scheme; dampers, friction, fingers and driven coordinates are of first order. The
    // error at 1 kHz is that of places, m: after a bounce, on the way, where it came to rest. The needle happens to be
    // better at 1 kHz than its order; a switch on its way goes at a metre a second, so a millisecond is a millimetre.
    type Scene = fn(f64) -> Vec<f64>;
    let scenes: [(&str, Scene, f64, f64); 8] = [
        ("a block that bounces without friction or damping", smooth_and_undamped, 2.0, 1e-4),
        ("a fall with a bounce", fall_and_bounce, 1.0, 1.5e-4),
        ("a landing on a corner", corner_landing, 1.0, 8e-4),
        ("a slide to a stop", slide_to_stop, 1.0, 2e-7),
        ("a pinch and a lift", pinch_and_lift, 1.0, 1.5e-5),
        ("a crank that spins down", crank_spin_down, 1.0, 2e-4),
        ("a needle through the membrane", needle_through_the_membrane, 1.0, 5e-6),
        ("a switch that is thrown", switch_thrown, 1.0, 2e-3),
    ];
    for (name, scene, order, at_1_khz_m) in scenes {
        let reference = scene(1e-3 / 1024.0);
        // From a quarter of a millisecond on all of them take one part a tick: only there does half a tick mean half a step.
        let errors: Vec<f64> =
            [1_u32, 4, 8, 16, 32, 64].iter().map(|n| distance(&scene(1e-3 / f64::from(*n)), &reference)).collect();
        assert!(errors[0] < at_1_khz_m, "{name}: {} m at 1 kHz", errors[0]);
        assert!(errors[1..].windows(2).all(|pair| pair[1] < 0.75 * pair[0]), "{name}: {errors:?}");
        let found = (errors[1] / errors[5]).log2() / 4.0;
        assert!(found > 0.9 * order, "{name} is of order {found}: {errors:?}");
    }
}
