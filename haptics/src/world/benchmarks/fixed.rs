//! Fixed objects are solid for fingertips, and a needle is only inserted by a hand that holds it.

use super::super::*;
use super::{DT, run};
use crate::Vec2;

/// Waiting position of the right finger.
const ASIDE: Vec2 = Vec2::new(0.045, -0.06);

/// Moves the left finger to a place in 0.4 s; the force that it exerts there, N.
fn go(world: &World, state: &mut State, to: Vec2) -> Vec2 {
    let from = state.input.tip_in_world[0];
    for part in 1..=400 {
        let tip = from + (to - from) * f64::from(part) / 400.0;
        let input = Input { tip_in_world: [tip, ASIDE], tip_velocity: [Vec2::zeros(); 2] };
        step(world, state, &input, DT);
    }
    state.tip_force_n[0]
}

#[test]
fn the_wall_of_the_cup_holds_a_finger_back() {
    let world = presets::needle();
    let sheet = world.membrane.expect("there is one");
    // The wall leans by 0.13 · 18 mm over 22 mm; 10 mm below the sheet it is 1.0636 mm outside of its rim.
    let lean = 0.13 * 0.018 / 0.022;
    for side in [-1.0, 1.0] {
        let normal = Vec2::new(side, lean) / (1.0_f64 + lean * lean).sqrt();
        let place = sheet.center_m + Vec2::new(side * (0.018 + 0.001_063_6), -0.010);
        let mut state = State::new(&world, [place + normal * 0.005, ASIDE]);
        assert_eq!(go(&world, &mut state, place + normal * 1e-4), Vec2::zeros(), "outside it is free");
        let pressed = go(&world, &mut state, place - normal * 1e-3);
        assert!((pressed + normal * 2.5).norm() < 1e-3, "1 mm of pad is 2.5 N: {pressed:?}");
        let deeper = go(&world, &mut state, place - normal * 1.2e-3);
        assert!(deeper.norm() > pressed.norm() && deeper.dot(&normal) < 0.0, "no way through: {deeper:?}");
        assert_eq!(go(&world, &mut state, place + normal * 0.005), Vec2::zeros());
    }
}

#[test]
fn the_base_of_the_switch_holds_a_finger_back() {
    let world = presets::switch();
    let switch = world.switch.as_ref().expect("there is one");
    let half = Vec2::from(SWITCH_BASE_HALF) * switch.lever_m;
    let middle = switch.pivot_m + Vec2::new(0.0, half.y);
    for (normal, reach) in [(Vec2::new(-1.0, 0.0), half.x), (Vec2::new(0.0, 1.0), half.y)] {
        // Not under the knob.
        let place = middle + normal * reach - Vec2::new(if normal.x == 0.0 { 0.012 } else { 0.0 }, 0.0);
        let mut state = State::new(&world, [place + normal * 0.004, ASIDE]);
        let pressed = go(&world, &mut state, place - normal * 1e-3);
        assert!((pressed + normal * 2.5).norm() < 1e-3, "1 mm of pad is 2.5 N: {pressed:?}");
        let deeper = go(&world, &mut state, place - normal * 1.4e-3);
        assert!(deeper.norm() > pressed.norm() && deeper.dot(&normal) < 0.0, "no way through: {deeper:?}");
    }
}

#[test]
fn a_needle_that_nobody_holds_is_not_inserted() {
    let world = presets::needle();
    let mut state = State::resting(&world);
    run(&world, &mut state, 1.0);
    assert!(state.membrane.insertion_m > 0.0, "it stands on the sheet by its weight");
    assert_eq!(true_label(&world, &state), "free-motion");
    // A finger leans on the table: that is no state of the task.
    state.input.tip_in_world = [Vec2::new(-0.04, world.floor.expect("a table").height_m - 1e-3), ASIDE];
    run(&world, &mut state, 0.01);
    assert_eq!(true_label(&world, &state), "no-state");
    // Both hold it where it stands.
    let middle = state.bodies[0].center_m;
    let half = Vec2::new(0.003 - 0.0005, 0.0);
    state.input.tip_in_world = [middle - half, middle + half];
    run(&world, &mut state, 0.5);
    // The label shows its last direction: it sprang back a little when it came to stand on the sheet.
    assert!(["insertion", "extraction"].contains(&true_label(&world, &state)), "{}", true_label(&world, &state));
}
