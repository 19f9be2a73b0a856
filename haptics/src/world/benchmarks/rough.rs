//! Rough handling: nothing may become infinite under any motion of the fingers in any world, and the same motion makes
//! the same bits.

use super::super::*;
use crate::Vec2;
use proptest::prelude::*;

fn worlds() -> [World; 6] {
    let mut crank = presets::crank();
    crank.crank.as_mut().expect("there is one").constraint_stiffness_n_m = Some(8000.0);
    [presets::stacking(), presets::crank(), crank, presets::needle(), presets::barrel(), presets::switch()]
}

/// A finger that jumps: places in and around the workspace, each held for some ticks.
fn jumps() -> impl Strategy<Value = Vec<([f64; 4], usize)>> {
    let place = [-0.06..0.06, -0.15..-0.04, -0.06..0.06, -0.15..-0.04_f64];
    prop::collection::vec((place, 1..60_usize), 1..25)
}

fn handle(world: &World, jumps: &[([f64; 4], usize)], dt_s: f64) -> State {
    let mut state = State::resting(world);
    for ([x1, y1, x2, y2], ticks) in jumps {
        for tick in 0..*ticks {
            // A device that reports any velocity at all, right or wrong.
            let speed = Vec2::new(*x1, *y2) * if tick == 0 { 50.0 } else { 0.0 };
            let input =
                Input { tip_in_world: [Vec2::new(*x1, *y1), Vec2::new(*x2, *y2)], tip_velocity: [speed, -speed] };
            step(world, &mut state, &input, dt_s);
        }
    }
    state
}

fn is_finite(state: &State) -> bool {
    let bodies = state.bodies.iter().flat_map(|b| [b.center_m.x, b.center_m.y, b.velocity_m_s.x, b.angle_rad]);
    let fixed = [state.crank.angle_rad, state.crank.radial_m, state.switch.at_m, state.switch.rate_m_s];
    let tips = state.tip_force_n.iter().flat_map(|f| [f.x, f.y]);
    bodies.chain(fixed).chain(tips).chain([state.membrane.force_n]).all(f64::is_finite)
}

/// Mechanical energy of the bodies above their highest rest, J, with that of cables and pressed contacts.
fn energy(world: &World, state: &State) -> f64 {
    let floor_m = world.floor.map_or(0.0, |f| f.height_m);
    let bodies = world.blocks.iter().zip(&state.bodies).map(|(block, body)| {
        let mass_kg = block.mass_kg - body.leaked_kg;
        let stretch_m = block.cable.map_or(0.0, |c| ((body.center_m - c.anchor_m).norm() - c.length_m).max(0.0));
        0.5 * mass_kg * body.velocity_m_s.norm_squared()
            + 0.5 * block.inertia_kg_m2() * body.rate_rad_s.powi(2)
            + mass_kg * 9.81 * (body.center_m.y - floor_m)
            + block.cable.map_or(0.0, |c| 0.5 * c.stiffness_n_m * stretch_m * stretch_m)
    });
    let pressed = state.contacts.iter().map(|c| 0.5 * c.normal_force_n * c.depth_m);
    let sheet = world.membrane.as_ref().zip(state.membrane.active).map_or(0.0, |(membrane, index)| {
        let side_m = state.bodies[0].center_m.x - membrane.center_m.x - state.membrane.holes[index].along_m;
        let give_m = state.membrane.insertion_m.min(membrane.law.puncture_depth_m());
        0.5 * membrane.side_stiffness_n_m * side_m.powi(2) + membrane.law.loading_n(give_m) * give_m
    });
    bodies.chain(pressed).sum::<f64>() + sheet
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn nothing_becomes_infinite_and_the_bits_repeat(jumps in jumps(), slow in any::<bool>()) {
        let dt_s = if slow { 1e-3 } else { 2.5e-4 };
        for world in worlds() {
            let state = handle(&world, &jumps, dt_s);
            prop_assert!(is_finite(&state), "{}: {:?}", world.name, state);
            prop_assert_eq!(&state, &handle(&world, &jumps, dt_s));
            // Let go: from when the contacts have sprung back, nothing gains energy any more.
            let mut rest = state.clone();
            let away = Input { tip_in_world: [Vec2::new(-0.5, 0.5), Vec2::new(0.5, 0.5)], ..Input::default() };
            let mut energy_j = f64::INFINITY;
            for tick in 0..4_000 {
                step(&world, &mut rest, &away, 1e-3);
                if tick == 200 {
                    energy_j = energy(&world, &rest);
                }
            }
            let later_j = energy(&world, &rest);
            prop_assert!(later_j < 1.05 * energy_j + 0.005, "{}: from {energy_j} J to {later_j} J", world.name);
            prop_assert!(rest.switch.rate_m_s.abs() < 1e-3);
        }
    }
}
