//! Goal of the hand set by keys and sticks: wanted speeds become a goal, with bounded acceleration and without wind-up.

use super::pointer::{Pointer, tips, towards};
use crate::Vec2;

/// Acceleration of the hand, m/s².
pub(super) const HAND_M_S2: f64 = 0.4;
/// Acceleration of the fingers' distance, m/s².
const APERTURE_M_S2: f64 = 0.3;
/// A key or a stick that stays where it is squeezes or leans up to this force, N, and not beyond it.
pub(super) const MAX_LEAN_N: f64 = 6.0;
/// Tips closer than this have nothing between them, m.
const CLOSED_M: f64 = 1e-3;

/// The goal of a hand that is steered by speeds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Steering {
    center_m: Vec2,
    aperture_m: f64,
    center_m_s: Vec2,
    aperture_m_s: f64,
}

impl Steering {
    /// At rest with the tips at `start_in_world`, m.
    pub fn new(start_in_world: [Vec2; 2]) -> Self {
        Self {
            center_m: 0.5 * (start_in_world[0] + start_in_world[1]),
            aperture_m: start_in_world[1].x - start_in_world[0].x,
            center_m_s: Vec2::zeros(),
            aperture_m_s: 0.0,
        }
    }

    /// Moves the goal by `dt_s` at a wanted speed of the hand, m/s, and of the fingers' distance, m/s; returns the tips' goals.
    pub fn steer(&mut self, hand_m_s: Vec2, aperture_m_s: f64, pointer: &Pointer, dt_s: f64) -> [Vec2; 2] {
        self.center_m_s = towards(self.center_m_s, hand_m_s, HAND_M_S2 * dt_s);
        let most = APERTURE_M_S2 * dt_s;
        self.aperture_m_s += (aperture_m_s - self.aperture_m_s).clamp(-most, most);
        self.center_m += self.center_m_s * dt_s;
        self.aperture_m += self.aperture_m_s * dt_s;
        self.keep_near(pointer);
        tips(self.center_m, self.aperture_m)
    }

    /// Keeps the goal within reach of the real fingers: a key held against an obstacle must not wind up a force that then takes
    /// as long to unwind.
    fn keep_near(&mut self, pointer: &Pointer) {
        let [left, right] = pointer.tips();
        let reach = pointer.reach_m(MAX_LEAN_N);
        let workspace = pointer.workspace();
        self.center_m = workspace.clamp(towards(0.5 * (left + right), self.center_m, reach));
        let apart = right.x - left.x;
        // With nothing between them the tips meet and stay; on an object the goal moves further inwards, which is the
        // squeeze.
        let least = if apart > CLOSED_M { apart - 2.0 * reach } else { 0.0 };
        let most = (apart + 2.0 * reach).min(2.0 * workspace.radius_m).max(least);
        self.aperture_m = self.aperture_m.clamp(least, most);
    }
}
