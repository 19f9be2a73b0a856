//! Motion along one coordinate under its laws: the crank's handle, the knob of the switch, and the needle in its
//! membrane.

use super::fixture::{Membrane, Switch};
use super::model::Crank;
use super::scratch::Arm;
use super::state::{CrankState, Hole, MAX_HOLES, MembraneState, SwitchState};
use crate::Vec2;
use crate::law::object::{MembraneHistory, MembraneLaw, MembranePhase};
use crate::law::{Motion, Role, step_coordinate_with};

/// Motion as the crank's laws see it: path length along the circle, forces in N at the handle.
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

/// Middle of the handle in the world, m.
pub(super) fn handle(crank: &Crank, state: &CrankState, arm: &mut Arm) -> Vec2 {
    crank.center_m + arm.outward(state.angle_rad) * (crank.radius_m + state.radial_m)
}

/// Moves the handle of `mass_kg` by `dt_s` under the pads' `force`, N.
pub(super) fn move_crank(
    (crank, mass_kg): (&Crank, f64),
    state: &mut CrankState,
    arm: &mut Arm,
    force: Vec2,
    time_s: f64,
    dt_s: f64,
) {
    let outward = arm.outward(state.angle_rad);
    let before_m = handle(crank, state, arm);
    let (pull, drive) = (force.dot(&outward), outward.perp(&force));
    let mut motion = crank_motion(crank, time_s, state.angle_rad, state.rate_rad_s, pull);
    motion.up_along = outward.x;
    let (_, speed) = step_coordinate_with(&crank.effects, &motion, &mut state.memories, drive, 0.0, dt_s);
    state.rate_rad_s = speed / crank.radius_m;
    state.angle_rad += state.rate_rad_s * dt_s;
    move_radially((crank, mass_kg), state, pull, &motion, outward.y, dt_s);
    // The chord that it moved along, not the tangent: the sum of the pads' anchors must be the travelled way.
    state.handle_velocity = (handle(crank, state, arm) - before_m) / dt_s;
}

/// The handle's give along the arm, and the force of the arm on it (thesis, eq. 5.1: Fn = (mg)n + Fc).
fn move_radially(
    (crank, mass): (&Crank, f64),
    state: &mut CrankState,
    pull: f64,
    motion: &Motion,
    up_outward: f64,
    dt_s: f64,
) {
    // Gravity gives W (up · t) along the path; across it, a quarter of a turn back, up · n = sin θ.
    let across = Motion {
        position: motion.position - crank.radius_m * std::f64::consts::FRAC_PI_2,
        up_along: up_outward,
        ..*motion
    };
    let weight: f64 = crank.effects.iter().filter(|e| e.role() == Role::Gravity).map(|e| e.force(&across)).sum();
    let centrifugal = mass * crank.radius_m * state.rate_rad_s.powi(2);
    let outward = pull - weight + centrifugal;
    match crank.constraint_stiffness_n_m {
        None => {
            state.radial_m = 0.0;
            state.radial_rate_m_s = 0.0;
            state.constraint_force_n = -outward;
        }
        Some(stiffness) => {
            // Damping ratio 0.7: a stiff mechanical stop that does not ring.
            let damping = 1.4 * (stiffness * mass).sqrt();
            let back = stiffness * state.radial_m + damping * state.radial_rate_m_s;
            state.radial_rate_m_s += (outward - back) / mass * dt_s;
            state.radial_m += state.radial_rate_m_s * dt_s;
            state.constraint_force_n = -back;
        }
    }
}

/// Moves the knob by `dt_s` under the pads' `force`, N, and gravity. Damping and the slope of the curve are taken in
/// the middle of the step, so that they neither lose nor generate energy by the integration. The stops are taken at its
/// end, so that a hard stop never rings.
// Not inlined: the compiler would multiply the knob's mass in worlds without a switch, too. The value in its place may
// be a subnormal number, which costs some 50 ns.
#[inline(never)]
pub(super) fn move_switch(switch: &Switch, state: &mut SwitchState, force: Vec2, gravity: Vec2, dt_s: f64) {
    let knob_m = switch.knob_in_world(state.at_m);
    let outward = (knob_m - switch.pivot_m) / switch.lever_m;
    let along = Vec2::new(outward.y, -outward.x);
    let drive = (force + gravity * switch.mass_kg).dot(&along);
    let held = switch.curve.force_n(state.at_m, state.branch);
    let stiffness = switch.curve.stiffness_n_m(state.at_m, state.branch, state.rate_m_s);
    let before_m_s = state.rate_m_s;
    let stopped = switch.curve.is_stopped(state.at_m);
    let share = if stopped { 1.0 } else { 0.5 };
    // Share of the brake that counts at the new speed, and at the old one, kg.
    let brake = (share * switch.damping_n_s_m + share * share * stiffness * dt_s) * dt_s;
    let kept = if stopped { switch.mass_kg } else { (switch.mass_kg - brake).max(0.0) };
    // A slope that falls too steeply for the step must not turn the sign.
    let resisting = (switch.mass_kg + brake).max(0.5 * switch.mass_kg);
    state.rate_m_s = (before_m_s * kept + (drive - held) * dt_s) / resisting;
    let way_m = (share * state.rate_m_s + (1.0 - share) * before_m_s) * dt_s;
    state.branch = switch.curve.advance(state.branch, way_m);
    state.at_m += way_m;
    state.knob_velocity = (switch.knob_in_world(state.at_m) - knob_m) / dt_s;
    state.force_n = held;
}

/// Two places of a sheet closer than this are one hole, m: half a millimetre, about a hypodermic needle.
const HOLE_M: f64 = 0.5e-3;

/// Force of the sheet on the needle whose point is at `point_m` and moves at `velocity`, N.
pub(super) fn pierce(membrane: &Membrane, state: &mut MembraneState, point_m: Vec2, velocity: Vec2) -> Vec2 {
    let (from_middle, insertion_m) = (point_m.x - membrane.center_m.x, membrane.center_m.y - point_m.y);
    state.insertion_m = insertion_m;
    if state.active.is_none() && insertion_m > 0.0 {
        state.active = (from_middle.abs() < membrane.half_width_m).then(|| enter(state, from_middle));
    }
    let Some(hole) = state.active.and_then(|index| state.holes.get_mut(index)) else {
        (state.force_n, state.phase) = (0.0, MembranePhase::Free);
        return Vec2::zeros();
    };
    let out_n = membrane.law.force_n(insertion_m, -velocity.y, &mut hole.history);
    state.force_n = out_n;
    state.phase = MembraneLaw::phase(insertion_m, &mut hole.history);
    if insertion_m <= 0.0 {
        state.active = None;
        return Vec2::zeros();
    }
    Vec2::new(-sideways(membrane, hole, from_middle, velocity.x, out_n), out_n)
}

/// The rim's push against a needle beside the middle of its hole, N. Before the puncture the point slides on the sheet when it
/// is pulled harder than it is pressed.
fn sideways(membrane: &Membrane, hole: &mut Hole, from_middle: f64, velocity_m_s: f64, out_n: f64) -> f64 {
    let off_m = from_middle - hole.along_m;
    let wanted = membrane.side_stiffness_n_m * off_m + membrane.law.drag_n_s_m * velocity_m_s;
    if hole.history.punctured || wanted.abs() <= out_n {
        return wanted;
    }
    let most = out_n.max(0.0) * wanted.signum();
    hole.along_m = from_middle - most / membrane.side_stiffness_n_m;
    most
}

/// The hole that a needle enters at a place along the sheet: an old one, or a new one instead of the oldest.
fn enter(state: &mut MembraneState, along_m: f64) -> usize {
    let known = state.holes[..state.touched].iter().position(|hole| (hole.along_m - along_m).abs() < HOLE_M);
    known.unwrap_or_else(|| {
        if state.touched == MAX_HOLES {
            state.holes.rotate_left(1);
            state.touched -= 1;
        }
        let index = state.touched;
        state.holes[index] = Hole { along_m, history: MembraneHistory::default() };
        state.touched += 1;
        index
    })
}
