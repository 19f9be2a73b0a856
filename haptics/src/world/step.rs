//! One tick of the world: contacts, laws, semi-implicit Euler. Deterministic to the bit; allocates nothing.

use super::contact::{Material, Overlap, Rect, point_in_rect, rect_rect, resolve};
use super::model::{Block, Crank, World};
use super::state::{BodyState, Contact, Input, State, Surface};
use crate::Vec2;
use crate::law::{Motion, Role, step_coordinate_with};

/// Half the height of a flat finger pad, m: how far off its middle it still touches the crank's handle.
pub const PAD_HALF_HEIGHT_M: f64 = 0.008;

/// Thickness of the foam on a fingertip, m (thesis): a hardening pad is as stiff as at this depth for the choice of the step.
const PAD_THICKNESS_M: f64 = 0.002;

/// Impact speeds below this are resting contact, m/s.
const IMPACT_THRESHOLD_M_S: f64 = 0.01;

/// Advances the world by `dt_s` seconds under the fingers' new `input`.
///
/// The tick is divided into as many equal parts as the stiffest contact needs; the fingers move evenly through them. The tip
/// forces in the state are those at the end of the tick. The same inputs give the same bits, on any thread.
pub fn step(world: &World, state: &mut State, input: &Input, dt_s: f64) {
    let parts = substeps(world, dt_s);
    let part_s = dt_s / f64::from(parts);
    let from = state.input.tip_in_world;
    for part in 1..=parts {
        let share = f64::from(part) / f64::from(parts);
        let tips = [0, 1].map(|finger| from[finger] + (input.tip_in_world[finger] - from[finger]) * share);
        state.input = Input { tip_in_world: tips, tip_velocity: input.tip_velocity };
        advance(world, state, part_s);
    }
    state.input = *input;
    state.time_s += dt_s;
    state.tick += 1;
}

/// Parts that a tick of `dt_s` is divided into: ω h ≤ 0.5 and damping h / m ≤ 0.5 for the stiffest body.
///
/// Semi-implicit Euler is stable up to ω h = 2 without damping; a quarter of that keeps the energy error small.
pub fn substeps(world: &World, dt_s: f64) -> u32 {
    const LIMIT: f64 = 0.5;
    // Rotation is up to three times as stiff as translation: contact at the corners of a body of inertia m(w²+h²)/12.
    const ROTATION: f64 = 3.0;
    let mut rate = 1.0_f64;
    let pad_stiffness_n_m = world.pad.elastic().stiffness_n_m(PAD_THICKNESS_M);
    let pads = 2.0 * (pad_stiffness_n_m + world.pad.shear_stiffness_n_m);
    let pad_damping = 2.0 * (world.pad.damping_n_s_m + world.pad.shear_damping_n_s_m);
    for block in &world.blocks {
        let floor = world.floor.as_ref().map_or((0.0, 0.0), |f| (2.0 * f.stiffness_n_m, 2.0 * f.damping_n_s_m));
        let stiffness = floor.0.max(block.stiffness_n_m) + pads;
        let damping = floor.1.max(block.damping_n_s_m) + pad_damping;
        rate = rate.max((ROTATION * stiffness / block.mass_kg).sqrt()).max(ROTATION * damping / block.mass_kg);
    }
    if let Some(crank) = &world.crank {
        let mass = crank.mass_at_handle_kg();
        let stiffness = pads + crank.constraint_stiffness_n_m.unwrap_or(0.0);
        rate = rate.max((stiffness / mass).sqrt()).max(pad_damping / mass);
    }
    ((dt_s * rate / LIMIT).ceil() as u32).clamp(1, 64)
}

fn advance(world: &World, state: &mut State, dt_s: f64) {
    std::mem::swap(&mut state.contacts, &mut state.previous);
    state.contacts.clear();
    state.load.fill((Vec2::zeros(), 0.0));
    state.tip_force_n = [Vec2::zeros(); 2];

    touch_floor(world, state, dt_s);
    touch_blocks(world, state, dt_s);
    touch_fingers(world, state, dt_s);
    let on_handle = touch_handle(world, state, dt_s);

    let gravity = world.gravity_vector();
    for (block, (body, load)) in world.blocks.iter().zip(state.bodies.iter_mut().zip(&state.load)) {
        move_body(block, body, *load, gravity, dt_s);
    }
    if let Some((crank, before)) = world.crank.as_ref().zip(state.handle_in_world(world)) {
        move_crank(crank, state, on_handle, dt_s);
        let after = state.handle_in_world(world).unwrap_or(before);
        state.crank.handle_velocity = (after - before) / dt_s;
    }
}

fn rect_of(block: &Block, body: &BodyState) -> Rect {
    let (sin, cos) = body.angle_rad.sin_cos();
    Rect {
        center_m: body.center_m,
        half_m: 0.5 * Vec2::new(block.width_m, block.height_m),
        axis_x: Vec2::new(cos, sin),
    }
}

fn velocity_at(body: &BodyState, point_in_world: Vec2) -> Vec2 {
    let arm = point_in_world - body.center_m;
    body.velocity_m_s + Vec2::new(-arm.y, arm.x) * body.rate_rad_s
}

/// Resolves one overlap against the tick before, stores the contact and loads the blocks that take part. Returns the force
/// on the pushed body, N.
fn press(state: &mut State, overlap: &Overlap, material: &Material, dt_s: f64) -> Vec2 {
    let before = state.previous.iter().find(|c| (c.on, c.by) == overlap.pair && c.feature == overlap.feature);
    let contact = resolve(overlap, material, before.map_or(0.0, |c| c.shear_m), dt_s);
    if before.is_none() {
        let closing = -overlap.relative_velocity.dot(&overlap.normal);
        if closing > IMPACT_THRESHOLD_M_S {
            state.impact_m_s = state.impact_m_s.max(closing);
        }
    }
    let force = contact.force_n();
    load(state, overlap.pair.0, contact.point_m, force);
    load(state, overlap.pair.1, contact.point_m, -force);
    // The buffer is sized for the densest packing; should that ever be wrong, the force still acts and only the record of
    // the contact is lost, because growing here would allocate in the servo.
    if state.contacts.len() < state.contacts.capacity() {
        state.contacts.push(contact);
    }
    force
}

fn load(state: &mut State, surface: Surface, point_m: Vec2, force: Vec2) {
    match surface {
        Surface::Block(index) => {
            let index = usize::from(index);
            let arm = point_m - state.bodies[index].center_m;
            state.load[index].0 += force;
            state.load[index].1 += arm.x * force.y - arm.y * force.x;
        }
        // A finger feels the reaction; its sensor reads what it exerts.
        Surface::Finger(finger) => state.tip_force_n[usize::from(finger)] -= force,
        Surface::Floor | Surface::Handle => {}
    }
}

fn touch_floor(world: &World, state: &mut State, dt_s: f64) {
    let Some(floor) = &world.floor else { return };
    let up = Vec2::new(0.0, 1.0);
    let material = Material::hard(floor.stiffness_n_m, floor.damping_n_s_m, floor.friction);
    for (index, block) in world.blocks.iter().enumerate() {
        let body = state.bodies[index];
        let rect = rect_of(block, &body);
        if body.center_m.y - rect.reach_m() > floor.height_m {
            continue;
        }
        for corner in 0..4_u8 {
            let point_m = rect.corner(corner);
            let depth_m = floor.height_m - point_m.y;
            if depth_m > 0.0 {
                let pair = (Surface::Block(index as u16), Surface::Floor);
                let relative_velocity = velocity_at(&body, point_m);
                let overlap = Overlap { pair, feature: corner, point_m, normal: up, depth_m, relative_velocity };
                press(state, &overlap, &material, dt_s);
            }
        }
    }
    for finger in 0..2_u8 {
        let tip = state.input.tip_in_world[usize::from(finger)];
        let depth_m = floor.height_m - tip.y;
        if depth_m > 0.0 {
            let pair = (Surface::Finger(finger), Surface::Floor);
            let relative_velocity = state.input.tip_velocity[usize::from(finger)];
            let overlap = Overlap { pair, feature: 0, point_m: tip, normal: up, depth_m, relative_velocity };
            press(state, &overlap, &pad_material(world, floor.friction), dt_s);
        }
    }
}

fn pad_material(world: &World, friction: f64) -> Material {
    Material {
        elastic: world.pad.elastic(),
        damping_n_s_m: world.pad.damping_n_s_m,
        shear_stiffness_n_m: world.pad.shear_stiffness_n_m,
        shear_damping_n_s_m: world.pad.shear_damping_n_s_m,
        friction,
    }
}

fn block_material(a: &Block, b: &Block) -> Material {
    // Two surfaces in series; friction as the geometric mean, the usual choice when only single surfaces are known.
    let series = |x: f64, y: f64| if x + y > 0.0 { x * y / (x + y) } else { 0.0 };
    Material::hard(
        series(a.stiffness_n_m, b.stiffness_n_m),
        series(a.damping_n_s_m, b.damping_n_s_m),
        (a.block_friction * b.block_friction).sqrt(),
    )
}

fn touch_blocks(world: &World, state: &mut State, dt_s: f64) {
    for (i, a) in world.blocks.iter().enumerate() {
        for (j, b) in world.blocks.iter().enumerate().skip(i + 1) {
            let (body_a, body_b) = (state.bodies[i], state.bodies[j]);
            let Some((normal, points)) = rect_rect(&rect_of(a, &body_a), &rect_of(b, &body_b)) else { continue };
            let material = block_material(a, b);
            for (point_m, depth_m, feature) in points.into_iter().flatten() {
                let relative_velocity = velocity_at(&body_a, point_m) - velocity_at(&body_b, point_m);
                let pair = (Surface::Block(i as u16), Surface::Block(j as u16));
                let overlap = Overlap { pair, feature, point_m, normal, depth_m, relative_velocity };
                press(state, &overlap, &material, dt_s);
            }
        }
    }
}

fn touch_fingers(world: &World, state: &mut State, dt_s: f64) {
    for finger in 0..2_u8 {
        let tip = state.input.tip_in_world[usize::from(finger)];
        let tip_velocity = state.input.tip_velocity[usize::from(finger)];
        for (index, block) in world.blocks.iter().enumerate() {
            let pair = (Surface::Finger(finger), Surface::Block(index as u16));
            let kept = state.previous.iter().find(|c| (c.on, c.by) == pair).map(|c| c.feature);
            let body = state.bodies[index];
            let rect = rect_of(block, &body);
            let Some((face, depth_m)) = point_in_rect(&rect, tip, kept) else { continue };
            let normal = rect.face(face).0;
            let relative_velocity = tip_velocity - velocity_at(&body, tip);
            let overlap = Overlap { pair, feature: face, point_m: tip, normal, depth_m, relative_velocity };
            press(state, &overlap, &pad_material(world, block.finger_friction), dt_s);
        }
    }
}

/// The flat pads against the crank's handle. Returns the force on the handle, N.
fn touch_handle(world: &World, state: &mut State, dt_s: f64) -> Vec2 {
    let (Some(crank), Some(handle)) = (&world.crank, state.handle_in_world(world)) else { return Vec2::zeros() };
    // The chord that it moved along, not the tangent: what the pads' anchors add up must be the way that was gone.
    let velocity = state.crank.handle_velocity;
    let mut total = Vec2::zeros();
    for finger in 0..2_u8 {
        // The left pad faces right, the right pad faces left.
        let facing = if finger == 0 { 1.0 } else { -1.0 };
        let tip = state.input.tip_in_world[usize::from(finger)];
        let depth_m = facing * (tip.x - handle.x) + 0.5 * crank.handle_width_m;
        let pair = (Surface::Finger(finger), Surface::Handle);
        let held = state.previous.iter().any(|c| (c.on, c.by) == pair);
        let on_own_side = facing * (tip.x - handle.x) < 0.0 || held;
        if depth_m > 0.0 && on_own_side && (tip.y - handle.y).abs() < PAD_HALF_HEIGHT_M + 0.5 * crank.handle_width_m {
            let normal = Vec2::new(-facing, 0.0);
            let relative_velocity = state.input.tip_velocity[usize::from(finger)] - velocity;
            let overlap = Overlap { pair, feature: 0, point_m: tip, normal, depth_m, relative_velocity };
            total -= press(state, &overlap, &pad_material(world, crank.finger_friction), dt_s);
        }
    }
    total
}

fn move_body(block: &Block, body: &mut BodyState, (force, moment): (Vec2, f64), gravity: Vec2, dt_s: f64) {
    body.velocity_m_s += (force / block.mass_kg + gravity) * dt_s;
    body.rate_rad_s += moment / block.inertia_kg_m2() * dt_s;
    body.center_m += body.velocity_m_s * dt_s;
    body.angle_rad += body.rate_rad_s * dt_s;
}

/// What the crank's laws see: path length along the circle, forces in N at the handle.
pub(crate) fn crank_motion(crank: &Crank, time_s: f64, angle_rad: f64, rate_rad_s: f64, normal_force_n: f64) -> Motion {
    Motion {
        time_s,
        position: crank.radius_m * angle_rad,
        velocity: crank.radius_m * rate_rad_s,
        acceleration: 0.0,
        direction: rate_rad_s.signum(),
        normal_force_n,
        up_along: angle_rad.cos(),
    }
}

fn move_crank(crank: &Crank, state: &mut State, force: Vec2, dt_s: f64) {
    let (sin, cos) = state.crank.angle_rad.sin_cos();
    let (outward, along) = (Vec2::new(cos, sin), Vec2::new(-sin, cos));
    let (pull, drive) = (force.dot(&outward), force.dot(&along));
    let motion = crank_motion(crank, state.time_s, state.crank.angle_rad, state.crank.rate_rad_s, pull);
    let (_, speed) = step_coordinate_with(&crank.effects, &motion, &mut state.crank.memories, drive, 0.0, dt_s);
    state.crank.rate_rad_s = speed / crank.radius_m;
    state.crank.angle_rad += state.crank.rate_rad_s * dt_s;
    move_radially(crank, state, pull, &motion, dt_s);
}

/// The handle's give along the arm, and the force of the arm on it (thesis, eq. 5.1: Fn = (mg)n + Fc).
fn move_radially(crank: &Crank, state: &mut State, pull: f64, motion: &Motion, dt_s: f64) {
    let mass = crank.mass_at_handle_kg();
    // Gravity gives W (up · t) along the path; across it, a quarter of a turn back, up · n = sin θ.
    let across = Motion {
        position: motion.position - crank.radius_m * std::f64::consts::FRAC_PI_2,
        up_along: state.crank.angle_rad.sin(),
        ..*motion
    };
    let weight: f64 = crank.effects.iter().filter(|e| e.role() == Role::Gravity).map(|e| e.force(&across)).sum();
    let centrifugal = mass * crank.radius_m * state.crank.rate_rad_s.powi(2);
    let outward = pull - weight + centrifugal;
    match crank.constraint_stiffness_n_m {
        None => {
            state.crank.radial_m = 0.0;
            state.crank.radial_rate_m_s = 0.0;
            state.crank.constraint_force_n = -outward;
        }
        Some(stiffness) => {
            // Damping ratio 0.7: a stiff mechanical stop that does not ring.
            let damping = 1.4 * (stiffness * mass).sqrt();
            let back = stiffness * state.crank.radial_m + damping * state.crank.radial_rate_m_s;
            state.crank.radial_rate_m_s += (outward - back) / mass * dt_s;
            state.crank.radial_m += state.crank.radial_rate_m_s * dt_s;
            state.crank.constraint_force_n = -back;
        }
    }
}

/// A copy of the contacts between finger `finger` (0, 1) and anything, for pictures and labels.
pub fn finger_contacts(state: &State, finger: u8) -> impl Iterator<Item = &Contact> {
    state.contacts.iter().filter(move |c| c.on == Surface::Finger(finger))
}
