//! Forces of the last seconds, for the live curve.

use haptics::servo::TickRecord;
use std::collections::VecDeque;

/// Length of the history, s.
pub const LENGTH_S: f64 = 8.0;
/// Interval between moments, s.
const EVERY_S: f64 = 0.01;

/// The forces of one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Simulated time, s.
    pub time_s: f64,
    /// min(Fx1, −Fx2), N.
    pub grip_n: f64,
    /// Sum of the vertical tip forces, N.
    pub lift_n: f64,
}

/// The last seconds.
#[derive(Clone, Debug, Default)]
pub struct History {
    moments: VecDeque<Moment>,
}

impl History {
    /// Adds ticks; a clock that was reset (a new world) starts over.
    pub fn extend(&mut self, ticks: &[TickRecord]) {
        for tick in ticks {
            match self.moments.back() {
                Some(last) if tick.time_s < last.time_s => self.moments.clear(),
                Some(last) if tick.time_s - last.time_s < EVERY_S => continue,
                _ => {}
            }
            let [left, right] = tick.tip_force_n;
            let grip_n = left.x.min(-right.x).max(0.0);
            self.moments.push_back(Moment { time_s: tick.time_s, grip_n, lift_n: left.y + right.y });
        }
        if let Some(newest) = self.moments.back().map(|m| m.time_s) {
            while self.moments.front().is_some_and(|m| m.time_s < newest - LENGTH_S) {
                self.moments.pop_front();
            }
        }
    }

    /// Moments, oldest first.
    pub fn moments(&self) -> impl Iterator<Item = &Moment> {
        self.moments.iter()
    }

    /// The newest moment.
    pub fn newest(&self) -> Option<&Moment> {
        self.moments.back()
    }
}
