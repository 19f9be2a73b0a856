//! Pictures on their way: taken at even times at one end, seen late at the other. All of them are made once.

use super::delay::Delay;
use super::picture::Picture;
use crate::device::channel::line::Line;
use crate::world::State;

/// Time between two pictures, s.
pub(super) const PICTURE_S: f64 = 0.01;

/// Salt of the pictures' fate.
const SALT: u64 = 0x1f83_d9ab_fb41_bd6b;

/// Pictures with something that belongs to them, on a line.
pub(super) struct Album<T> {
    taken: Vec<(Picture, T)>,
    next: usize,
    last_s: f64,
    line: Line<usize>,
}

impl<T: Copy + Default> Album<T> {
    /// Empty, with room for every picture that can be under way.
    pub fn new(state: &State, delay: &Delay, seed: u64) -> Self {
        let room = ((delay.one_way_s() + delay.jitter_s) / PICTURE_S).ceil() as usize + 3;
        let line = Line::new(delay.one_way_s(), delay.jitter_s, delay.loss, seed ^ SALT);
        Self { taken: vec![(Picture::of(state), T::default()); room], next: 0, last_s: f64::NEG_INFINITY, line }
    }

    /// Sends a picture, if it is time for one.
    pub fn offer(&mut self, now_s: f64, state: &State, with: T) {
        // Half a thousandth of a tick early is not early: times are sums of ticks.
        if now_s < self.last_s + PICTURE_S - 1e-7 {
            return;
        }
        self.last_s = now_s;
        if let Some((picture, beside)) = self.taken.get_mut(self.next) {
            picture.take(state);
            *beside = with;
            self.line.send(now_s, self.next);
        }
        self.next = (self.next + 1) % self.taken.len().max(1);
    }

    /// The newest picture that has arrived by now, if it is newer than all before.
    pub fn receive(&mut self, now_s: f64) -> Option<&(Picture, T)> {
        let arrived = self.line.receive(now_s)?;
        self.taken.get(arrived)
    }
}
