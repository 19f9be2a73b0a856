//! Past states of the model: late pictures are compared with the model of their time.

use super::super::album::PICTURE_S;
use super::super::picture::Picture;
use super::poses::Corrected;
use crate::world::State;

/// The model at one instant.
#[derive(Clone)]
pub(super) struct Then {
    time_s: f64,
    pub picture: Picture,
    /// Correction of the model by then.
    pub corrected: Corrected,
}

/// A ring of instants, made once.
pub(super) struct Past {
    ring: Vec<Then>,
    newest: usize,
}

impl Past {
    pub fn new(state: &State, room: usize) -> Self {
        let never = Then {
            time_s: f64::NEG_INFINITY,
            picture: Picture::of(state),
            corrected: Corrected::none(state.bodies.len()),
        };
        Self { ring: vec![never; room.max(2)], newest: 0 }
    }

    /// Keeps the model as it is now, if it is time to.
    pub fn remember(&mut self, now_s: f64, state: &State, corrected: &Corrected) {
        let room = self.ring.len();
        if self.ring.get(self.newest).is_some_and(|then| now_s < then.time_s + PICTURE_S - 1e-7) {
            return;
        }
        self.newest = (self.newest + 1) % room;
        if let Some(then) = self.ring.get_mut(self.newest) {
            then.time_s = now_s;
            then.picture.take(state);
            then.corrected.copy_from(corrected);
        }
    }

    /// The instant that is nearest to a time; `None` when that is not remembered.
    pub fn at(&self, time_s: f64) -> Option<&Then> {
        let off = |then: &&Then| (then.time_s - time_s).abs();
        self.ring.iter().min_by(|a, b| off(a).total_cmp(&off(b))).filter(|then| off(then) < PICTURE_S)
    }
}
