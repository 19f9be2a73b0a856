//! Needle, barrel and switch, each in a state that the world really came to.

use super::Plate;
use haptics::Vec2;
use haptics::world::{Input, State, World, presets, step};
use render::{Camera, ViewOptions};

/// One tick, s.
const DT_S: f64 = 1e-3;
/// Nothing that the fingers do here takes longer, ticks.
const PATIENCE: u32 = 20_000;

pub fn plates() -> Vec<Plate> {
    vec![
        plate("needle", presets::needle(), push_in),
        plate("pierced", presets::needle(), pierce),
        plate("barrel", presets::barrel(), lift_barrel),
        plate("broken", presets::barrel(), break_barrel),
        plate("switch", presets::switch(), reach_for_switch),
        plate("switch-mid", presets::switch(), push_switch),
        haunted(),
        from_above(),
    ]
}

/// The pierced cup from the side and from above.
fn from_above() -> Plate {
    let mut plate = plate("cup-above", presets::needle(), pierce);
    plate.options.camera.orbit(0.6, 0.45);
    plate
}

fn plate(name: &'static str, world: World, play: fn(&World, &mut State)) -> Plate {
    let mut state = State::resting(&world);
    play(&world, &mut state);
    let options = ViewOptions { camera: Camera::workspace(), show_contacts: true, ..ViewOptions::default() };
    Plate { name, world, state, options }
}

/// The lifted barrel, with a ghost of where it stood.
fn haunted() -> Plate {
    let mut plate = plate("barrel-ghost", presets::barrel(), lift_barrel);
    let mut ghost = State::resting(&plate.world);
    grasp(&plate.world, &mut ghost, 0.0, 1.0);
    plate.options.ghost = Some(ghost);
    plate
}

/// Moves the tips evenly until something has happened; gives up after [`PATIENCE`] ticks.
fn go(world: &World, state: &mut State, velocity: [Vec2; 2], until: impl Fn(&State) -> bool) {
    for _ in 0..PATIENCE {
        if until(state) {
            return;
        }
        let tips = state.input.tip_in_world;
        let input = Input { tip_in_world: [0, 1].map(|i| tips[i] + velocity[i] * DT_S), tip_velocity: velocity };
        step(world, state, &input, DT_S);
    }
}

fn both(x: f64, y: f64) -> [Vec2; 2] {
    [Vec2::new(x, y); 2]
}

fn rest(world: &World, state: &mut State, seconds: f64) {
    let end_s = state.time_s + seconds;
    go(world, state, both(0.0, 0.0), |state| state.time_s >= end_s);
}

/// Closes the fingers on the first body, `above` its middle, until both press with `force_n`.
fn grasp(world: &World, state: &mut State, above: f64, force_n: f64) {
    let (half, middle) = (0.5 * world.blocks[0].width_m + 0.001, state.bodies[0].center_m + Vec2::new(0.0, above));
    state.input.tip_in_world = [middle - Vec2::new(half, 0.0), middle + Vec2::new(half, 0.0)];
    let squeezes = move |state: &State| state.tip_force_n[0].x > force_n;
    go(world, state, [Vec2::new(0.004, 0.0), Vec2::new(-0.004, 0.0)], squeezes);
}

fn push_in(world: &World, state: &mut State) {
    grasp(world, state, 0.008, 2.0);
    go(world, state, both(0.0, -0.010), |state| state.membrane.insertion_m >= 0.003);
}

fn pierce(world: &World, state: &mut State) {
    let through = |state: &State| state.membrane.insertion_m >= 0.008;
    grasp(world, state, 0.008, 2.0);
    go(world, state, both(0.0, -0.010), through);
    go(world, state, both(0.0, 0.010), |state| state.membrane.insertion_m < -0.002);
    let x = state.bodies[0].center_m.x;
    go(world, state, both(0.010, 0.0), |state| state.bodies[0].center_m.x > x + 0.008);
    go(world, state, both(0.0, -0.010), through);
}

fn lift_barrel(world: &World, state: &mut State) {
    grasp(world, state, 0.0, 3.4);
    go(world, state, both(0.006, 0.012), |state| state.bodies[0].cable_n > 1.5);
    rest(world, state, 0.2);
}

fn break_barrel(world: &World, state: &mut State) {
    grasp(world, state, 0.004, 1.0);
    go(world, state, [Vec2::new(0.004, 0.0), Vec2::new(-0.004, 0.0)], |state| state.bodies[0].broken);
    let away = state.time_s + 0.3;
    go(world, state, [Vec2::new(-0.03, 0.01), Vec2::new(0.03, 0.01)], |state| state.time_s > away);
    rest(world, state, 13.3);
}

fn reach_for_switch(world: &World, state: &mut State) {
    rest(world, state, 0.3);
    beside_knob(world, state, 0.012);
    go(world, state, [Vec2::new(0.003, 0.0), Vec2::zeros()], |state| state.tip_force_n[0].x > 0.4);
}

/// Half way, held from both sides: it would snap over.
fn push_switch(world: &World, state: &mut State) {
    rest(world, state, 0.3);
    beside_knob(world, state, 0.0005);
    go(world, state, [Vec2::new(0.003, 0.0), Vec2::new(-0.003, 0.0)], |state| state.tip_force_n[0].x > 1.2);
    go(world, state, both(0.008, 0.0), |state| state.switch.at_m > 0.0);
}

/// Puts a finger to each side of the knob, the right one with a gap of `right_m`.
fn beside_knob(world: &World, state: &mut State, right_m: f64) {
    let Some(switch) = &world.switch else { return };
    let (knob, away) = (switch.knob_in_world(state.switch.at_m), switch.knob_radius_m + 0.0005);
    state.input.tip_in_world = [knob - Vec2::new(away, 0.0), knob + Vec2::new(away + right_m, 0.0)];
}
