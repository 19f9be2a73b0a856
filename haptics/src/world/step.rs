//! One tick of the world: contacts, laws, motion. Deterministic to the bit; allocates nothing.
//!
//! Bodies advance by half of a part, get the forces of that position, and advance with the new velocity (position
//! Verlet: second order, symplectic; Hairer, Lubich & Wanner 2003). Driven coordinates and fingers are taken at the end
//! of a part (semi-implicit Euler: first order), so that the force for a device is as young as can be.
//!
//! Touches are found once a tick. The forces between them follow in each of its parts from the motion of the surfaces
//! since (as in the small-step solvers of game physics, Macklin et al. 2019): finding them costs most.

use super::block::{Block, Shape};
use super::collide::collide;
use super::contact::{RESTING_M_S, Touch};
use super::contact_point::{Contact, Surface};
use super::driven::{handle, move_crank, move_switch, pierce};
use super::model::{Crank, World};
use super::scratch::{Scratch, Solid};
use super::state::{BodyState, Input, State};
use crate::Vec2;
use crate::law::{AddedConstraint, explicit_stiffness};

/// Advances the world by `dt_s` seconds under the fingers' new `input`.
///
/// The tick is divided into as many equal parts as the stiffest contact needs; the fingers move evenly through them. The tip
/// forces in the state are those of the tick's last part. The same inputs give the same bits, on any thread.
///
/// ```
/// use haptics::Vec2;
/// use haptics::world::{Input, State, presets, step};
///
/// let world = presets::stacking();
/// // Two fingers far above the table, which do not move: the blocks stay where they are.
/// let tips = [Vec2::new(-0.05, 0.05), Vec2::new(0.05, 0.05)];
/// let mut state = State::new(&world, tips);
/// let before = state.bodies.clone();
/// for _ in 0..1000 {
///     step(&world, &mut state, &Input { tip_in_world: tips, tip_velocity: [Vec2::zeros(); 2] }, 1e-3);
/// }
/// let moved_m = state.bodies.iter().zip(&before).map(|(a, b)| (a.center_m - b.center_m).norm()).fold(0.0, f64::max);
/// assert!(moved_m < 1e-4 && state.tip_force_n.iter().all(|force| force.norm() == 0.0));
/// ```
pub fn step(world: &World, state: &mut State, input: &Input, dt_s: f64) {
    collide(world, state, input, dt_s);
    let parts = parts_of(world, dt_s, state.scratch.deepest_pad_m);
    let part_s = dt_s / f64::from(parts);
    let part = Part {
        dt_s: part_s,
        finger_ahead_s: part_s - 0.5 * dt_s,
        body_ahead_s: 0.5 * (part_s - dt_s),
        gravity: world.gravity_vector(),
        tip_velocity: input.tip_velocity,
        // `tip_chord`: the anchors add up the way of the tips, whatever velocity the device reports.
        crank_kg: world.crank.as_ref().map_or(0.0, Crank::mass_at_handle_kg),
        tip_chord: [0, 1].map(|f| (input.tip_in_world[f] - state.input.tip_in_world[f]) / dt_s),
    };
    for index in 0..parts {
        for (tip, chord) in state.input.tip_in_world.iter_mut().zip(&part.tip_chord) {
            *tip += chord * part.dt_s;
        }
        advance(world, state, &part, index == 0);
    }
    state.input = *input;
    state.time_s += dt_s;
    state.tick += 1;
    keep_contacts(state);
}

/// Constants of all parts of a tick.
struct Part {
    dt_s: f64,
    /// From the middle of the tick, where touches are found, to where the first part presses them, s: for fingers and bodies.
    finger_ahead_s: f64,
    body_ahead_s: f64,
    gravity: Vec2,
    tip_velocity: [Vec2; 2],
    tip_chord: [Vec2; 2],
    crank_kg: f64,
}

/// Most parts of a tick; worlds that need more at 1 kHz are refused by their check, with a spare factor of two for slower servos.
pub const MAX_PARTS: u32 = 256;

/// Number of parts that a tick of `dt_s` is divided into: ω h ≤ 0.5 and damping h / m ≤ 1 for the stiffest body, ω h ≤
/// 0.6 for a driven coordinate.
///
/// The scheme is stable up to ω h = 2 without damping; at a quarter of that an undamped, tumbling block loses less than four
/// thousandths of its energy at a bounce and gains less than one. Handle and knob do not tumble, and their own laws brake them.
///
/// A fingertip that is pressed to the end of its foam is much stiffer than usual: a tick in which one is takes more parts.
pub fn substeps(world: &World, dt_s: f64) -> u32 {
    parts_of(world, dt_s, 0.0)
}

/// The same with the deepest fingertip at `pad_m`.
fn parts_of(world: &World, dt_s: f64, pad_m: f64) -> u32 {
    ((dt_s * part_rate(world, pad_m).0).ceil() as u32).clamp(1, MAX_PARTS)
}

/// Parts a second that the world needs with the deepest fingertip at `pad_m`, and the body that needs them.
pub(super) fn part_rate(world: &World, pad_m: f64) -> (f64, &str) {
    const LIMIT: f64 = 0.5;
    const DAMPING_LIMIT: f64 = 1.0;
    const DRIVEN: f64 = (0.5 / 0.6) * (0.5 / 0.6);
    // Rotation is up to three times as stiff as translation: contact at the corners of a body of inertia m(w²+h²)/12.
    const ROTATION: f64 = 3.0;
    let mut most = (0.0_f64, "nothing");
    let mut needs = |who, stiffness: f64, damping: f64, mass_kg: f64| {
        // Squares are compared: one root for the winner.
        let rate = (stiffness / mass_kg / (LIMIT * LIMIT)).max((damping / mass_kg / DAMPING_LIMIT).powi(2));
        if rate > most.0 {
            most = (rate, who);
        }
    };
    // A pad that hardens while it is open counts as it is at its full thickness.
    let pad = world.pad.elastic();
    let pad_stiffness_n_m = pad.spring.stiffness_n_m(world.pad.thickness_m) + pad.end.stiffness_n_m(pad_m);
    let pads = 2.0 * (pad_stiffness_n_m + world.pad.shear_stiffness_n_m);
    let pad_damping = 2.0 * (world.pad.damping_n_s_m + world.pad.shear_damping_n_s_m);
    let (floor_stiffness, floor_damping) =
        world.floor.as_ref().map_or((0.0, 0.0), |f| (2.0 * f.stiffness_n_m, 2.0 * f.damping_n_s_m));
    let (plane_stiffness, plane_damping) =
        world.plane.as_ref().map_or((0.0, 0.0), |p| (2.0 * p.stiffness_n_m, 2.0 * p.damping_n_s_m));
    let ground = (floor_stiffness + plane_stiffness, floor_damping + plane_damping);
    for block in &world.blocks {
        // Content that may run out counts as gone: the step must not change as it leaks.
        let mass_kg = block.mass_kg - block.content.map_or(0.0, |c| c.mass_kg);
        let turning = if block.keeps_upright() { 1.0 } else { ROTATION };
        let (held, held_damping) = held_by(world, block);
        let stiffness = ground.0.max(block.stiffness_n_m) + pads + held;
        let damping = ground.1.max(block.damping_n_s_m) + pad_damping + held_damping;
        needs(&block.name, turning * stiffness, turning * damping, mass_kg);
    }
    if let Some(crank) = &world.crank {
        let laws = explicit_stiffness(&crank.effects, std::f64::consts::TAU * crank.radius_m);
        let stiffness = pads + crank.constraint_stiffness_n_m.unwrap_or(0.0) + laws;
        needs("the crank's handle", DRIVEN * stiffness, pad_damping, crank.mass_at_handle_kg());
    }
    if let Some(switch) = &world.switch {
        needs("the switch's knob", DRIVEN * pads, pad_damping, switch.mass_kg);
    }
    (most.0.sqrt(), most.1)
}

/// Stiffness and damping of one body's constraints besides contacts: cable, guide and membrane, N/m and N s/m.
fn held_by(world: &World, block: &Block) -> (f64, f64) {
    let (mut stiffness, mut damping) = block.cable.map_or((0.0, 0.0), |c| (c.stiffness_n_m, c.damping_n_s_m));
    if let Some(guide) = &block.guide {
        stiffness += guide.stiffness_n_m;
        damping += guide.steepest_n_s_m();
    }
    if let (Shape::Needle, Some(membrane)) = (block.shape, &world.membrane) {
        stiffness += membrane.law.stiffness_n_m(membrane.law.puncture_depth_m()) + membrane.side_stiffness_n_m;
        damping += membrane.law.drag_n_s_m;
    }
    (stiffness, damping)
}

fn advance(world: &World, state: &mut State, part: &Part, first: bool) {
    for solid in &mut state.scratch.solids {
        (solid.force_n, solid.moment_n_m) = (Vec2::zeros(), 0.0);
    }
    state.tip_force_n = [Vec2::zeros(); 2];
    let handle_m = world.crank.as_ref().map(|crank| handle(crank, &state.crank, &mut state.scratch.arm));
    let knob_m = world.switch.as_ref().map(|switch| switch.knob_in_world(state.switch.at_m));

    let (on_handle, on_knob) = press_all(world, state, part, first, (handle_m, knob_m));
    hold(world, state, part.dt_s);
    move_bodies(world, state, part);
    if let Some(crank) = &world.crank {
        let State { crank: moving, scratch, time_s, .. } = state;
        move_crank((crank, part.crank_kg), moving, &mut scratch.arm, on_handle, *time_s, part.dt_s);
    }
    if let Some(switch) = &world.switch {
        move_switch(switch, &mut state.switch, on_knob, part.gravity, part.dt_s);
    }
}

/// Presses all touches and adds their forces to the bodies. Returns the force on the crank's handle and on the switch's
/// knob, N.
fn press_all(
    world: &World,
    state: &mut State,
    part: &Part,
    first: bool,
    (handle_m, knob_m): (Option<Vec2>, Option<Vec2>),
) -> (Vec2, Vec2) {
    let State { scratch: Scratch { touches, solids, .. }, bodies, .. } = state;
    let driven = (state.crank.handle_velocity, state.switch.knob_velocity);
    let (mut on_handle, mut on_knob) = (Vec2::zeros(), Vec2::zeros());
    for touch in touches {
        let by = velocity_by(touch, bodies, driven);
        let (on, way_on) = velocity_on(touch, bodies, part);
        let normal = touch.contact.normal;
        match (touch.contact.by, handle_m, knob_m) {
            (Surface::Handle, Some(handle_m), _) => on_curve(world, touch, &state.input, handle_m),
            (Surface::Knob, _, Some(knob_m)) => on_curve(world, touch, &state.input, knob_m),
            _ if first => {
                let finger = matches!(touch.contact.on, Surface::Finger(_));
                let ahead_s = if finger { part.finger_ahead_s } else { part.body_ahead_s };
                touch.contact.depth_m -= (way_on * ahead_s - by * part.body_ahead_s).dot(&normal);
            }
            _ => touch.contact.depth_m -= (way_on - by).dot(&normal) * part.dt_s,
        }
        let relative = on - by;
        let meets = !touch.met;
        let way_along_m = (way_on - by).dot(&touch.contact.tangent()) * part.dt_s;
        let force = touch.press(relative, way_along_m, part.dt_s);
        if meets && touch.met {
            let closing = touch.contact.met_m_s;
            if closing > RESTING_M_S && closing > state.impact_m_s {
                (state.impact_m_s, state.impact_in_world) = (closing, touch.contact.point_m);
            }
        }
        match touch.contact.on {
            // A finger feels the reaction; its sensor reads its own force.
            Surface::Finger(finger) => state.tip_force_n[usize::from(finger)] -= force,
            Surface::Block(index) => load(&mut solids[usize::from(index)], touch.arm_on_m, force),
            _ => {}
        }
        match touch.contact.by {
            Surface::Block(index) => {
                let index = usize::from(index);
                load(&mut solids[index], touch.arm_by_m, -force);
                if world.pad.face_m > 0.0 && matches!(touch.contact.on, Surface::Finger(_)) {
                    solids[index].moment_n_m +=
                        world.pad.righting_n_m(&touch.contact, &solids[index].rect, &bodies[index]);
                }
            }
            Surface::Handle => on_handle -= force,
            Surface::Knob => on_knob -= force,
            _ => {}
        }
    }
    (on_handle, on_knob)
}

/// Velocity of the surface that presses, m/s. `driven` is that of handle and knob.
#[inline]
fn velocity_by(touch: &Touch, bodies: &[BodyState], driven: (Vec2, Vec2)) -> Vec2 {
    match touch.contact.by {
        Surface::Block(index) => velocity_at(&bodies[usize::from(index)], touch.arm_by_m),
        Surface::Handle => driven.0,
        Surface::Knob => driven.1,
        _ => Vec2::zeros(),
    }
}

/// Velocity of the surface that is pressed for the damper, and its way since the part before, as a velocity, for springs, m/s.
#[inline]
fn velocity_on(touch: &Touch, bodies: &[BodyState], part: &Part) -> (Vec2, Vec2) {
    match touch.contact.on {
        Surface::Finger(finger) => (part.tip_velocity[usize::from(finger)], part.tip_chord[usize::from(finger)]),
        Surface::Block(index) => {
            let velocity = velocity_at(&bodies[usize::from(index)], touch.arm_on_m);
            (velocity, velocity)
        }
        _ => (Vec2::zeros(), Vec2::zeros()),
    }
}

/// Depth of a finger in handle or knob, whose middle is at `middle_m` now.
fn on_curve(world: &World, touch: &mut Touch, input: &Input, middle_m: Vec2) {
    let Surface::Finger(finger) = touch.contact.on else { return };
    let away = input.tip_in_world[usize::from(finger)] - middle_m;
    match (touch.contact.by, &world.crank, &world.switch) {
        (Surface::Handle, Some(crank), _) => {
            touch.contact.depth_m = 0.5 * crank.handle_width_m - away.dot(&touch.contact.normal);
        }
        (Surface::Knob, _, Some(switch)) => {
            let distance = away.norm();
            touch.contact.depth_m = switch.knob_radius_m - distance;
            if distance > 1e-9 {
                touch.contact.normal = away / distance;
            }
        }
        _ => {}
    }
}

fn load(solid: &mut Solid, arm_m: Vec2, force: Vec2) {
    solid.force_n += force;
    solid.moment_n_m += arm_m.perp(&force);
}

fn velocity_at(body: &BodyState, arm_m: Vec2) -> Vec2 {
    body.velocity_m_s + Vec2::new(-arm_m.y, arm_m.x) * body.rate_rad_s
}

/// Forces on bodies besides contacts: cables, guides and the membrane; and the loss of mass by leaks.
fn hold(world: &World, state: &mut State, dt_s: f64) {
    let State { scratch: Scratch { touches, solids, .. }, bodies, membrane, time_s, .. } = state;
    for (index, block) in world.blocks.iter().enumerate() {
        let (body, solid) = (&mut bodies[index], &mut solids[index]);
        if let Some(cable) = &block.cable {
            let way = body.center_m + 0.5 * dt_s * body.velocity_m_s - cable.anchor_m;
            let length_m = way.norm();
            if length_m > cable.length_m && length_m > 0.0 {
                let along = way / length_m;
                let spring = AddedConstraint::cable_n(cable.stiffness_n_m, cable.length_m, length_m);
                body.cable_n = (spring + cable.damping_n_s_m * body.velocity_m_s.dot(&along)).max(0.0);
                load(solid, Vec2::zeros(), -along * body.cable_n);
            } else {
                body.cable_n = 0.0;
            }
        }
        if let (Shape::Needle, Some(sheet)) = (block.shape, &world.membrane) {
            let point_m = body.center_m + 0.5 * dt_s * body.velocity_m_s - Vec2::new(0.0, 0.5 * block.height_m);
            let force = pierce(sheet, membrane, point_m, body.velocity_m_s);
            load(solid, Vec2::zeros(), force);
        }
        if let Some(guide) = &block.guide {
            let point_m = body.center_m + 0.5 * dt_s * body.velocity_m_s;
            body.guided = guide.hold(body.guided.at, point_m, body.velocity_m_s);
            load(solid, Vec2::zeros(), body.guided.force_n);
        }
        if block.content.is_some() {
            leak(block, body, touches, index, *time_s, dt_s);
        }
    }
}

/// Breaks an overloaded wall and lets the content run out: the law of `mass-change` with rate −g · leak, as a mass.
fn leak(block: &Block, body: &mut BodyState, touches: &[Touch], index: usize, time_s: f64, dt_s: f64) {
    let Some(content) = &block.content else { return };
    if let Some(strength_n) = block.wall.and_then(|wall| wall.strength_n) {
        let this = Surface::Block(index as u16);
        let squeezed = |t: &Touch| t.contact.by == this && matches!(t.contact.on, Surface::Finger(_));
        body.broken |= touches.iter().any(|t| squeezed(t) && t.contact.normal_force_n > strength_n);
    }
    if body.broken || content.leaks_from_s.is_some_and(|from_s| time_s >= from_s) {
        let before_kg = body.leaked_kg;
        body.leaked_kg = (before_kg + content.leak_kg_s * dt_s).min(content.mass_kg);
        if body.leaked_kg > before_kg {
            let share = (body.leaked_kg - before_kg) / body.leaked_kg;
            body.spilled_x_m += (body.center_m.x - body.spilled_x_m) * share;
        }
    }
}

fn move_bodies(world: &World, state: &mut State, part: &Part) {
    let dt_s = part.dt_s;
    for (body, (solid, block)) in state.bodies.iter_mut().zip(state.scratch.solids.iter().zip(&world.blocks)) {
        let gained = (solid.force_n * solid.inverse_mass + part.gravity) * dt_s;
        let spun = solid.moment_n_m * solid.inverse_inertia * dt_s;
        body.center_m += (body.velocity_m_s + 0.5 * gained) * dt_s;
        body.angle_rad += (body.rate_rad_s + 0.5 * spun) * dt_s;
        body.velocity_m_s += gained;
        body.rate_rad_s += spun;
        debug_assert!(block.mass_kg > body.leaked_kg);
    }
}

/// Keeps the touches that press for the next tick, for pictures and for labels.
fn keep_contacts(state: &mut State) {
    let State { scratch, contacts, input, .. } = state;
    contacts.clear();
    contacts.extend(scratch.touches.iter().filter(|t| t.met).map(|t| {
        let point_m = match t.contact.on {
            Surface::Finger(finger) => input.tip_in_world[usize::from(finger)],
            _ => t.contact.point_m,
        };
        Contact { point_m, ..t.contact }
    }));
}

/// A copy of the contacts between finger `finger` (0, 1) and anything, for pictures and labels.
pub fn finger_contacts(state: &State, finger: u8) -> impl Iterator<Item = &Contact> {
    state.contacts.iter().filter(move |c| c.on == Surface::Finger(finger))
}
