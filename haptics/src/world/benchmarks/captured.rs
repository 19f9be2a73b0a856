//! Membrane, barrel and switch against their laws and numbers computed by hand.

use super::super::*;
use super::{DT, run};
use crate::Vec2;
use crate::law::object::MembranePhase;
use crate::law::{Effect, MassChange, Motion};

/// Moves both tips evenly by `way` in `seconds`.
fn carry(world: &World, state: &mut State, way: Vec2, seconds: f64, mut seen: impl FnMut(&State)) {
    let start = state.input.tip_in_world;
    let ticks = (seconds / DT).round() as u32;
    for tick in 1..=ticks {
        let share = f64::from(tick) / f64::from(ticks);
        let input = Input { tip_in_world: start.map(|t| t + way * share), tip_velocity: [way / seconds; 2] };
        step(world, state, &input, DT);
        seen(state);
    }
}

/// The fingers close on block 0 with `pinch_n`, at the height of its centre.
fn grasp(world: &World, pinch_n: f64) -> State {
    let (block, mut state) = (&world.blocks[0], State::resting(world));
    run(world, &mut state, 1.0);
    let stiffness =
        block.wall.map_or(world.pad.stiffness_n_m, |w| 1.0 / (1.0 / w.stiffness_n_m + 1.0 / world.pad.stiffness_n_m));
    let half = Vec2::new(0.5 * block.width_m - pinch_n / stiffness, 0.0);
    let middle = state.bodies[0].center_m;
    state.input.tip_in_world = [middle - half, middle + half];
    run(world, &mut state, 1.0);
    state
}

#[test]
fn a_needle_is_felt_as_the_membrane_says() {
    let world = presets::needle();
    let (law, weight) = (world.membrane.expect("there is one").law, world.blocks[0].mass_kg * 9.81);
    let mut state = grasp(&world, 2.0);
    carry(&world, &mut state, Vec2::new(0.0, 0.004), 2.0, |_| {});
    let (mut highest, mut after, mut phases) = (0.0_f64, 0.0, vec![state.membrane.phase]);
    carry(&world, &mut state, Vec2::new(0.0, -0.020), 10.0, |s| {
        let down = -(s.tip_force_n[0].y + s.tip_force_n[1].y) + weight;
        highest = highest.max(down);
        after = down;
        let held = &s.membrane;
        // 2 mm/s: quasi-static, but the needle hangs in the pads, so the force is that of its own insertion. It has rested on
        // the sheet before: the first millimetre remembers that.
        if held.phase == MembranePhase::Insertion && held.insertion_m > 1e-3 {
            assert!((down - law.loading_n(held.insertion_m)).abs() < 0.02, "{down} at {}", held.insertion_m);
        }
        // The sudden drop throws the needle back for an instant: only the order in which phases are first met counts.
        if !phases.contains(&held.phase) {
            phases.push(held.phase);
        }
    });
    assert!((highest / law.puncture_n - 1.0).abs() < 0.02, "pierced at {highest} N");
    let dragging = law.friction_n + law.drag_n_s_m * 0.002;
    assert!((after - dragging).abs() < 0.01, "then {after} N");
    carry(&world, &mut state, Vec2::new(0.0, 0.010), 5.0, |s| {
        after = -(s.tip_force_n[0].y + s.tip_force_n[1].y) + weight;
    });
    assert!((after + dragging).abs() < 0.01, "on the way out {after} N");
    assert_eq!(state.membrane.phase, MembranePhase::Extraction);
    carry(&world, &mut state, Vec2::new(0.0, 0.014), 5.0, |_| {});
    assert_eq!(state.membrane.phase, MembranePhase::Free);
    assert_eq!(phases[..3], [MembranePhase::Free, MembranePhase::Insertion, MembranePhase::Penetration]);
    // In again at the same place: no second puncture. A needle's width beside it: as new.
    let mut same = 0.0_f64;
    carry(&world, &mut state, Vec2::new(0.0, -0.014), 5.0, |s| same = same.max(s.membrane.force_n));
    assert!(same < 1.2 * dragging, "the hole is open: {same} N");
    carry(&world, &mut state, Vec2::new(0.0, 0.014), 5.0, |_| {});
    carry(&world, &mut state, Vec2::new(0.003, 0.0), 1.0, |_| {});
    let mut beside = 0.0_f64;
    carry(&world, &mut state, Vec2::new(0.0, -0.014), 5.0, |s| beside = beside.max(s.membrane.force_n));
    assert!(beside > 0.95 * law.puncture_n, "beside it the sheet is whole: {beside} N");
    assert_eq!(state.membrane.touched, 2);
}

#[test]
fn a_barrel_gives_under_the_fingers_and_hangs_on_its_cable() {
    let world = presets::barrel();
    let barrel = world.blocks[0].clone();
    let mut state = grasp(&world, 2.5);
    // Pad and wall in series: the pinch is the wanted one.
    assert!((state.tip_force_n[0].x - 2.5).abs() < 1e-3, "{:?} {:?}", state.tip_force_n, state.bodies[0]);
    carry(&world, &mut state, Vec2::new(0.0, 0.010), 2.0, |_| {});
    run(&world, &mut state, 3.0);
    let lifted = state.tip_force_n[0].y + state.tip_force_n[1].y;
    assert!((lifted - barrel.mass_kg * 9.81).abs() < 1e-3, "the cable is slack: {lifted} N");
    assert_eq!(state.bodies[0].cable_n, 0.0);
    carry(&world, &mut state, Vec2::new(0.020, 0.0), 2.0, |_| {});
    run(&world, &mut state, 3.0);
    // Taut: fingers, weight and cable balance.
    let cable = barrel.cable.expect("it has one");
    let away = state.bodies[0].center_m - cable.anchor_m;
    let pull = cable.stiffness_n_m * (away.norm() - cable.length_m);
    assert!(pull > 0.1 && (state.bodies[0].cable_n - pull).abs() < 1e-6, "{pull} N");
    let carried = state.tip_force_n[0] + state.tip_force_n[1];
    let expected = away / away.norm() * pull + Vec2::new(0.0, barrel.mass_kg * 9.81);
    assert!((carried - expected).norm() < 1e-3, "{carried:?} against {expected:?}");
}

#[test]
fn a_barrel_squeezed_too_hard_breaks_and_leaks_as_the_law_of_mass_change_says() {
    let mut world = presets::barrel();
    world.blocks[0].cable = None;
    let content = world.blocks[0].content.expect("it has one");
    let mut whole = grasp(&world, 4.5);
    run(&world, &mut whole, 2.0);
    assert!(!whole.bodies[0].broken && whole.bodies[0].leaked_kg == 0.0, "below its strength it holds");
    let mut state = grasp(&world, 5.5);
    assert!(state.bodies[0].broken);
    carry(&world, &mut state, Vec2::new(0.0, 0.01), 1.0, |_| {});
    run(&world, &mut state, 10.0);
    let broke_s = state.time_s - state.bodies[0].leaked_kg / content.leak_kg_s;
    let law = Effect::new(&MassChange, &[world.blocks[0].mass_kg * 9.81, -content.leak_kg_s * 9.81, broke_s]);
    let weight = law.force(&Motion { time_s: state.time_s, up_along: 1.0, ..Motion::default() });
    let carried = state.tip_force_n[0].y + state.tip_force_n[1].y;
    assert!((carried - weight).abs() < 1e-3, "{carried} against {weight}");
    run(&world, &mut state, 60.0);
    assert!((state.bodies[0].leaked_kg - content.mass_kg).abs() < 1e-12, "no more than there was");
    // It fell where the barrel was held.
    assert!((state.bodies[0].spilled_x_m - state.bodies[0].center_m.x).abs() < 1e-3);
    let spilled_x_m = state.bodies[0].spilled_x_m;
    carry(&world, &mut state, Vec2::new(0.01, 0.0), 1.0, |_| {});
    assert_eq!(state.bodies[0].spilled_x_m, spilled_x_m, "the puddle stays");
}

#[test]
fn a_switch_snaps_over_at_the_captured_force_and_back() {
    let world = presets::switch();
    let switch = world.switch.as_ref().expect("there is one");
    let mut state = State::resting(&world);
    run(&world, &mut state, 1.0);
    let rest = state.switch.at_m;
    assert!((rest + 8e-3).abs() < 1e-3, "it rests on the left: {rest}");
    // The left finger pushes the knob to the right, the right one stays away.
    let knob = switch.knob_in_world(rest);
    state.input.tip_in_world = [knob - Vec2::new(0.0065, 0.0), Vec2::new(0.035, -0.07)];
    let start = state.input.tip_in_world[0];
    let mut highest = 0.0_f64;
    for tick in 1..=8_000 {
        let mut input = state.input;
        input.tip_in_world[0] = start + Vec2::new(0.012, 0.0) * f64::from(tick) / 8_000.0;
        input.tip_velocity[0] = Vec2::new(0.0015, 0.0);
        step(&world, &mut state, &input, DT);
        // Only the part of the force along its arc drives the lever.
        let (sin, cos) = (state.switch.at_m / switch.lever_m).sin_cos();
        highest = highest.max(state.tip_force_n[0].dot(&Vec2::new(cos, -sin)));
    }
    // 1.2 N at −3.5 mm; the knob's own weight, leaning left, adds 0.12 N · sin(3.5/30) = 0.014 N.
    assert!((highest - 1.214).abs() < 0.02, "snapped at {highest} N");
    assert!(state.switch.at_m > 6e-3, "it went over: {}", state.switch.at_m);
    // Let go: it stays on the right.
    state.input.tip_in_world[0] = Vec2::new(-0.035, -0.07);
    run(&world, &mut state, 2.0);
    assert!((state.switch.at_m - 8e-3).abs() < 1e-3, "{}", state.switch.at_m);
    assert!(state.switch.rate_m_s.abs() < 1e-9);
}
