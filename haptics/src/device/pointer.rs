//! Common part of mouse, touch screen, keyboard and gamepad: two fingertips that follow two goals through the arm's
//! impedance.

use super::impedance::HandImpedance;
use super::interface::{DeviceSpec, Sample};
use crate::Vec2;
use crate::hand::Workspace;

/// Time constant that turns 60 Hz steps of an input device into a smooth motion, s.
const SMOOTHING_S: f64 = 0.02;
/// The same for slower steps, in steps, up to this, s: a hand that lags more would not be steered any more.
const SMOOTHING_STEPS: f64 = 1.2;
const MOST_SMOOTHING_S: f64 = 0.2;

/// Largest force per finger that an input device without force feedback asks for, N.
const MAX_FORCE_N: f64 = 8.0;

/// Two fingertips on their arms, each pulled towards its own goal.
#[derive(Clone, Debug)]
pub(super) struct Pointer {
    smooth: [Vec2; 2],
    smoothing_s: f64,
    workspace: Workspace,
    impedance: HandImpedance,
    position: [Vec2; 2],
    velocity: [Vec2; 2],
}

impl Pointer {
    /// At rest with the tips at `start` (m in the world).
    pub fn new(start: [Vec2; 2], workspace: Workspace) -> Self {
        Self {
            smooth: start,
            smoothing_s: SMOOTHING_S,
            workspace,
            impedance: HandImpedance::default(),
            position: start,
            velocity: [Vec2::zeros(); 2],
        }
    }

    /// Specification of a device that only gives positions; the force is shown, not felt.
    pub fn spec(name: &str) -> DeviceSpec {
        DeviceSpec {
            name: name.to_owned(),
            force_feedback: false,
            max_force_n: MAX_FORCE_N,
            damping_n_s_m: HandImpedance::default().damping_n_s_m,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        }
    }

    /// Sets the time between two goals, s. Windows that are drawn rarely move the fingers far at once.
    pub fn smooth_steps_of(&mut self, step_s: f64) {
        self.smoothing_s = (SMOOTHING_STEPS * step_s).clamp(SMOOTHING_S, MOST_SMOOTHING_S);
    }

    /// Moves the tips by `dt_s` towards `goals` (m in the world) under `force_n` on the fingers, N. A goal that is not a number
    /// is taken as none: the finger keeps the one before.
    pub fn advance(&mut self, goals: [Vec2; 2], force_n: [Vec2; 2], dt_s: f64) -> Sample {
        let blend = 1.0 - (-dt_s / self.smoothing_s).exp();
        for finger in 0..2 {
            let before = self.smooth[finger];
            if goals[finger].x.is_finite() && goals[finger].y.is_finite() {
                self.smooth[finger] += (goals[finger] - before) * blend;
            }
            let wanted = (self.smooth[finger], (self.smooth[finger] - before) / dt_s.max(1e-6));
            let (position, velocity) = (&mut self.position[finger], &mut self.velocity[finger]);
            self.impedance.advance(position, velocity, wanted, force_n[finger], dt_s);
        }
        // A still pointer is a pointer at rest, not a lost device: it is always fresh.
        Sample { tip_in_world: self.position, tip_velocity: self.velocity, fresh: [true; 2] }
    }

    /// Positions of the tips, m in the world.
    pub fn tips(&self) -> [Vec2; 2] {
        self.position
    }

    /// Region that the tips may reach.
    pub fn workspace(&self) -> Workspace {
        self.workspace
    }

    /// Distance of a goal ahead of its tip for a force of `force_n`, m.
    pub fn reach_m(&self, force_n: f64) -> f64 {
        force_n / self.impedance.stiffness_n_m
    }
}

/// The tips of a hand with its middle at `center_in_world`, `aperture_m` apart; both in m.
pub(super) fn tips(center_in_world: Vec2, aperture_m: f64) -> [Vec2; 2] {
    let half = Vec2::new(0.5 * aperture_m, 0.0);
    [center_in_world - half, center_in_world + half]
}

/// Point on the way from `from` to `to`, at most `most_m` away from `from`.
pub(super) fn towards(from: Vec2, to: Vec2, most_m: f64) -> Vec2 {
    let way = to - from;
    let distance = way.norm();
    if distance <= most_m { to } else { from + way * (most_m / distance) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Hand;

    #[test]
    fn a_goal_that_is_not_a_number_is_ignored() {
        let workspace = Hand::default().workspace;
        let start = tips(workspace.center_m, 0.03);
        let mut pointer = Pointer::new(start, workspace);
        for _ in 0..100 {
            pointer.advance([Vec2::new(f64::NAN, 0.0), Vec2::new(0.0, f64::INFINITY)], [Vec2::zeros(); 2], 1e-3);
        }
        assert_eq!(pointer.tips(), start);
    }

    #[test]
    fn towards_arrives_and_does_not_pass() {
        let (a, b) = (Vec2::new(0.0, 0.0), Vec2::new(0.003, 0.004));
        assert!((towards(a, b, 0.001) - Vec2::new(0.0006, 0.0008)).norm() < 1e-15);
        assert_eq!(towards(a, b, 0.01), b);
        assert_eq!(towards(a, a, 0.0), a);
    }
}
