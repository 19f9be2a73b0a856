//! The world's clock stands over a gap in a log. The motion of the fingers there is unknown, and a straight line
//! between their places would drag a crank's handle through its bearing.

use haptics::Vec2;
use haptics::world::{Contact, Crank, Input, State, Surface, World};
use std::f64::consts::TAU;

/// Fingers further apart than this many widths of the handle do not hold it.
const HOLDS_WITHIN: f64 = 1.5;

/// Middle of the fingers, and the angle of the line from the left one to the right one, rad.
fn grasp(tips: &[Vec2; 2]) -> (Vec2, f64) {
    let apart = tips[1] - tips[0];
    (0.5 * (tips[0] + tips[1]), apart.y.atan2(apart.x))
}

/// Puts the fingers at their places after `gap_s`. Objects held by both came along with them, others have had the time
/// to come to rest. A grip of both fingers stays as it was; anything else is pressed as at the start of a recording.
pub(super) fn bridge(world: &World, state: &mut State, input: &Input, gap_s: f64) {
    let ((from, angle), (to, new_angle)) = (grasp(&state.input.tip_in_world), grasp(&input.tip_in_world));
    let (sin, cos) = (new_angle - angle).sin_cos();
    let velocity = 0.5 * (input.tip_velocity[0] + input.tip_velocity[1]);
    let touch = |finger: u8, body: usize| {
        let pair = [Surface::Finger(finger), Surface::Block(u16::try_from(body).unwrap_or(u16::MAX))];
        state.contacts.iter().any(|c| pair.contains(&c.on) && pair.contains(&c.by))
    };
    let held: Vec<bool> = (0..state.bodies.len()).map(|body| touch(0, body) && touch(1, body)).collect();
    let still_held: Vec<Surface> =
        (0..).map(Surface::Block).zip(&held).filter(|(_, held)| **held).map(|(block, _)| block).collect();
    for (body, held) in state.bodies.iter_mut().zip(held) {
        (body.velocity_m_s, body.rate_rad_s) = (Vec2::zeros(), 0.0);
        if held {
            let arm = body.center_m - from;
            body.center_m = to + Vec2::new(cos * arm.x - sin * arm.y, sin * arm.x + cos * arm.y);
            body.angle_rad += new_angle - angle;
            body.velocity_m_s = velocity;
        }
    }
    state.switch.rate_m_s = 0.0;
    if let Some(crank) = &world.crank {
        take_handle(world, crank, state, input);
    }
    let by_finger = |c: &Contact| matches!(c.on, Surface::Finger(_)) && !matches!(c.by, Surface::Handle);
    state.contacts.retain(|c| !by_finger(c) || still_held.contains(&c.by));
    state.input = *input;
    state.time_s += gap_s;
    state.tick = 0;
}

/// A handle that the fingers hold is where they are; any other has stopped where it was.
fn take_handle(world: &World, crank: &Crank, state: &mut State, input: &Input) {
    let handle_m = |state: &State| state.handle_in_world(world).unwrap_or_default();
    let (tips, tips_after) = (state.input.tip_in_world, input.tip_in_world);
    let before_m = handle_m(state);
    let handle = &mut state.crank;
    (handle.rate_rad_s, handle.radial_rate_m_s) = (0.0, 0.0);
    let outward = grasp(&tips_after).0 - crank.center_m;
    let is_held = |tips: &[Vec2; 2]| {
        let outward = grasp(tips).0 - crank.center_m;
        let on_circle = (outward.norm() - crank.radius_m).abs() < 0.5 * crank.handle_width_m;
        on_circle && (tips[1] - tips[0]).norm() < HOLDS_WITHIN * crank.handle_width_m
    };
    if is_held(&tips_after) {
        // Pads give along the circle, too: a handle that was held stays as far behind the fingers as it was.
        let angle = |v: Vec2| v.y.atan2(v.x);
        let from = if is_held(&tips) { angle(grasp(&tips).0 - crank.center_m) } else { handle.angle_rad };
        let turned = angle(outward) - from;
        // The nearest turn: the number of turns in between is unknown.
        handle.angle_rad += turned - TAU * (turned / TAU).round();
        let velocity = 0.5 * (input.tip_velocity[0] + input.tip_velocity[1]);
        handle.rate_rad_s = outward.perp(&velocity) / (outward.norm() * crank.radius_m);
    }
    let after_m = handle_m(state);
    for contact in state.contacts.iter_mut().filter(|c| c.by == Surface::Handle) {
        let Surface::Finger(finger) = contact.on else { continue };
        let finger = usize::from(finger);
        let shift = (tips_after[finger] - after_m) - (tips[finger] - before_m);
        contact.shear_m += shift.dot(&contact.tangent());
    }
}
