//! Delayed sight of the operator: the world as it was one reaction time ago.

use crate::Vec2;
use crate::world::{MAX_BLOCKS, State};

/// Time between two looks, s.
const FRAME_S: f64 = 0.01;
/// Looks that are remembered.
const FRAMES: usize = 64;
/// The longest delay that they cover, s.
const LONGEST_DELAY_S: f64 = 0.6;

/// One look at the world.
#[derive(Clone, Copy)]
pub(super) struct Frame {
    /// Time of the frame, s on the operator's clock.
    pub time_s: f64,
    /// Time reached in the plan then, s.
    pub plan_s: f64,
    /// Middle between the tips, m.
    pub hand_m: Vec2,
    /// Distance between the tips, m.
    pub apart_m: f64,
    /// Force that both fingers press against each other, N.
    pub grip_n: f64,
    /// Force that both fingers press down with, N.
    pub down_n: f64,
    /// Centre, m, and angle, rad, of every block.
    pub bodies: [(Vec2, f64); MAX_BLOCKS],
}

/// A ring of looks, made once.
pub(super) struct Eye {
    frames: Vec<Frame>,
    newest: usize,
    delay_s: f64,
}

impl Eye {
    pub fn new(delay_s: f64) -> Self {
        let nothing = Frame {
            time_s: f64::NEG_INFINITY,
            plan_s: f64::NEG_INFINITY,
            hand_m: Vec2::zeros(),
            apart_m: 0.0,
            grip_n: 0.0,
            down_n: 0.0,
            bodies: [(Vec2::zeros(), 0.0); MAX_BLOCKS],
        };
        Self { frames: vec![nothing; FRAMES], newest: 0, delay_s: delay_s.clamp(0.0, LONGEST_DELAY_S) }
    }

    /// Looks, if it is time to. Returns true when it did.
    pub fn look(&mut self, now_s: f64, plan_s: f64, state: &State) -> bool {
        if now_s < self.frames[self.newest].time_s + FRAME_S {
            return false;
        }
        self.newest = (self.newest + 1) % FRAMES;
        let frame = &mut self.frames[self.newest];
        (frame.time_s, frame.plan_s) = (now_s, plan_s);
        let [left, right] = state.input.tip_in_world;
        frame.hand_m = 0.5 * (left + right);
        frame.apart_m = right.x - left.x;
        frame.grip_n = state.tip_force_n[0].x.min(-state.tip_force_n[1].x);
        frame.down_n = -(state.tip_force_n[0].y + state.tip_force_n[1].y);
        for (seen, body) in frame.bodies.iter_mut().zip(&state.bodies) {
            *seen = (body.center_m, body.angle_rad);
        }
        true
    }

    /// The newest look that is old enough to be acted on.
    pub fn noticed(&self, now_s: f64) -> Option<&Frame> {
        (0..FRAMES)
            .map(|back| &self.frames[(self.newest + FRAMES - back) % FRAMES])
            .take_while(|frame| frame.time_s.is_finite())
            .find(|frame| frame.time_s <= now_s - self.delay_s)
    }
}
