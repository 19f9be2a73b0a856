//! The hand at the far end: two fingertips on springs and dampers that follow the near hand's earlier positions and
//! forces.

use super::delay::Delay;
use crate::Vec2;
use crate::device::{Command, HandImpedance, Sample};
use crate::world::Input;

/// Without a word for this long beside the jitter the near hand counts as at rest, s: its last velocity must not push for ever.
const SILENCE_S: f64 = 0.05;

/// Message of the near end at every tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Goal {
    /// Time of the message, s on the near end's clock.
    pub said_s: f64,
    /// Positions and velocities of the fingers in the model.
    pub input: Input,
    /// Forces that the fingers exert in the model, N.
    pub force_n: [Vec2; 2],
}

/// Two fingertips on their springs.
pub(super) struct FarHand {
    goal: Goal,
    silent_s: f64,
    patience_s: f64,
    position: [Vec2; 2],
    velocity: [Vec2; 2],
    /// Largest force that is exerted on purpose, N per finger.
    most_n: f64,
}

impl FarHand {
    /// At rest with the tips at `start`, m.
    pub fn new(start: Input, delay: &Delay, most_n: f64) -> Self {
        Self {
            goal: Goal { input: Input { tip_velocity: [Vec2::zeros(); 2], ..start }, ..Goal::default() },
            silent_s: 0.0,
            patience_s: SILENCE_S + delay.jitter_s,
            position: start.tip_in_world,
            velocity: [Vec2::zeros(); 2],
            most_n,
        }
    }

    /// Takes the newest word of the near end.
    pub fn hear(&mut self, goal: Goal) {
        let all = goal.input.tip_in_world.iter().chain(&goal.input.tip_velocity).chain(&goal.force_n);
        // A model that has blown up must not take the far hand with it.
        if all.clone().all(|v| v.x.is_finite() && v.y.is_finite()) {
            (self.goal, self.silent_s) = (goal, 0.0);
        }
    }

    /// The word that is being followed.
    pub fn said_s(&self) -> f64 {
        self.goal.said_s
    }

    /// Moves by `dt_s` under the far world's forces. On a silent line it stays and keeps holding.
    ///
    /// The force of the model is exerted as it was told, and the spring makes up for the errors of the model. It
    /// presses as hard as the model, but never harder than the hand's own stiffness makes of a wrong position.
    pub fn advance(&mut self, command: &Command, dt_s: f64) -> Sample {
        self.silent_s += dt_s;
        let told = self.silent_s < self.patience_s;
        for finger in 0..2 {
            let rate = if told { self.goal.input.tip_velocity[finger] } else { Vec2::zeros() };
            let wanted = (self.goal.input.tip_in_world[finger], rate);
            let force = bounded(self.goal.force_n[finger], self.most_n) + command.force_n[finger];
            let (position, velocity) = (&mut self.position[finger], &mut self.velocity[finger]);
            HandImpedance::default().advance(position, velocity, wanted, force, dt_s);
        }
        // It is no device that could be lost.
        Sample { tip_in_world: self.position, tip_velocity: self.velocity, fresh: [true; 2] }
    }
}

fn bounded(force_n: Vec2, most_n: f64) -> Vec2 {
    let size = force_n.norm();
    if size > most_n { force_n * (most_n / size) } else { force_n }
}
