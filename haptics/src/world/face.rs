//! The flat face of a fingertip: a held object that turns presses the foam under it more on one side, and is turned
//! back.

use super::contact_point::Contact;
use super::model::Pad;
use super::rect::Rect;
use super::state::BodyState;
use std::f64::consts::FRAC_PI_2;

impl Pad {
    /// Moment on a block that a finger presses from the side, N m, counter-clockwise.
    ///
    /// An elastic foundation of stiffness k over the height 2 a that touches both (Winkler; Johnson, *Contact
    /// Mechanics*, 4.3): k a²/3 for each radian that the surface leans, with the foam's damping in the same proportion.
    /// It is at most N a, when only an edge is left. The hand keeps its pads upright.
    pub(super) fn righting_n_m(&self, contact: &Contact, rect: &Rect, body: &BodyState) -> f64 {
        // From above or below a face has nothing to lean against.
        if contact.normal.x.abs() < contact.normal.y.abs() {
            return 0.0;
        }
        let quarter = (body.angle_rad / FRAC_PI_2).round();
        let leaning_rad = body.angle_rad - quarter * FRAC_PI_2;
        let half_height_m = if (quarter as i64) % 2 == 0 { rect.half_m.y } else { rect.half_m.x };
        let half_m = half_height_m.min(0.5 * self.face_m);
        let share = half_m * half_m / 3.0;
        let most = contact.normal_force_n.max(0.0) * half_m;
        let moment = -share * (self.stiffness_n_m * leaning_rad + self.damping_n_s_m * body.rate_rad_s);
        moment.max(-most).min(most)
    }
}

#[cfg(test)]
mod tests {
    use crate::Vec2;
    use crate::world::{Block, Input, State, World, step};

    /// A small block between two fingers that squeeze it hard through arms of 400 N/m, turned a little: how far it turns in a second,
    /// rad.
    fn turns(face_m: f64) -> f64 {
        let mut world = World::empty("squeezed");
        (world.gravity_m_s2, world.floor) = (0.0, None);
        world.pad.face_m = face_m;
        let mut block = Block::upright("block", 0.02, 0.012, 0.012, 0.0, -0.006);
        block.start.angle_rad = 0.03;
        world.blocks = vec![block];
        let mut tips = [Vec2::new(-0.006, 0.0), Vec2::new(0.006, 0.0)];
        let mut speed = [Vec2::zeros(); 2];
        let wanted = [Vec2::new(-0.006 + 0.010, 0.0), Vec2::new(0.006 - 0.010, 0.0)];
        let mut state = State::new(&world, tips);
        let arm = crate::device::HandImpedance::default();
        for _ in 0..1000 {
            for finger in 0..2 {
                let force = -state.tip_force_n[finger];
                arm.advance(&mut tips[finger], &mut speed[finger], (wanted[finger], Vec2::zeros()), force, 1e-3);
            }
            step(&world, &mut state, &Input { tip_in_world: tips, tip_velocity: speed }, 1e-3);
        }
        state.bodies[0].angle_rad.abs()
    }

    #[test]
    fn a_flat_face_keeps_a_small_block_upright_and_a_point_does_not() {
        assert!(turns(0.016) < 0.03, "it turns back: {}", turns(0.016));
        assert!(turns(0.0) > 0.3, "points let it turn: {}", turns(0.0));
    }
}
