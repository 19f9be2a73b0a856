//! The model at the operator's end, and its correction by the far world: the poses are bled in, and the forces tell
//! weights, resistances and the feel under the fingers.

mod crank;
mod past;
mod poses;
#[cfg(test)]
mod tests;
mod touch;
mod weight;

use super::album::PICTURE_S;
use super::picture::{Grasp, Picture};
use crate::servo::Loop;
use crate::world::{State, World};
use crank::CrankLaws;
use past::Past;
use poses::Poses;
use touch::Touch;
use weight::Weights;

pub use weight::Weighed;

/// Learns from late pictures of the far world.
pub(super) struct Tutor {
    past: Past,
    poses: Poses,
    weights: Weights,
    laws: CrankLaws,
    touch: Touch,
}

impl Tutor {
    /// For a model in its starting state; pictures come back after at most `round_trip_s`.
    pub fn new(world: &World, state: &State, round_trip_s: f64) -> Self {
        Self {
            past: Past::new(state, (round_trip_s / PICTURE_S).ceil() as usize + 8),
            poses: Poses::new(state),
            weights: Weights::new(world),
            laws: CrankLaws::new(world),
            touch: Touch::new(world),
        }
    }

    /// Takes a picture of the far world, made when the far hand followed the message of `said_s`.
    pub fn learn(&mut self, far: &Picture, said_s: f64, now: Grasp) {
        if let Some(then) = self.past.at(said_s) {
            self.poses.compare(&then.picture, &then.corrected, far, now);
        }
        self.weights.learn(far);
        self.laws.learn(far);
        self.touch.learn(far);
    }

    /// Corrects the model by a little, after each of its ticks, and remembers it as it is now.
    pub fn correct(&mut self, model: &mut Loop, now_s: f64, dt_s: f64) {
        let (world, state) = model.model_mut();
        self.poses.bleed(state, dt_s);
        self.weights.bleed(world, dt_s);
        self.laws.bleed(world, dt_s);
        self.touch.bleed(world, dt_s);
        self.past.remember(now_s, state, self.poses.corrected());
    }

    /// Estimated mass of the body that was carried last, if there is one.
    pub fn weighed(&self) -> Option<Weighed> {
        self.weights.last()
    }
}
