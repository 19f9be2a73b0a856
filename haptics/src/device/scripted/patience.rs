//! Move and wait (Ferrell 1965): over a slow line people move, stop until the picture shows the result, and continue.
//! The operator that does so ends each movement where it is planned to end, and begins the next when it has *seen* the
//! hand there.

use super::eye::Frame;
use super::movement::Goal;

/// The hand counts as where it was wanted within this, m.
const THERE_M: f64 = 3e-3;
/// Largest opening of the fingers beyond the wanted one, m.
const OPEN_M: f64 = 2e-3;
/// A hand that moves less than this from one look to the one before it counts as at rest, m.
const STILL_M: f64 = 2e-4;
/// Share of the wanted pinch that must be seen; pads and springs take up the rest.
const PINCHED: f64 = 0.45;
/// A grip below this is none, N.
const LOOSE_N: f64 = 0.05;
/// Largest change of the force, N, for a time, s, in a steady press. Over a slow line the far fingers weigh some
/// kilograms and swing on the pressed surface.
const STEADY_N: f64 = 0.25;
const STEADY_S: f64 = 0.6;
/// Time after leaving a pressed surface within which the hand may come back to it, s.
const BOUNCES_S: f64 = 1.2;
/// Less is no press, N.
const PRESSES_N: f64 = 0.15;
/// Largest distance of the hand from the goal while it presses, m: the goal is below the pressed surface, and the arms'
/// springs yield.
const PRESSED_M: f64 = 1e-2;
/// Longest wait before the operator continues, s; people wait longer for a press to get steady.
const LONGEST_S: f64 = 4.0;
const LONGEST_PRESS_S: f64 = 12.0;

/// State of a waiting operator.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Patience {
    waited_s: f64,
    seen: Option<Seen>,
    steady: Steady,
}

/// A force that stays, N, and since when, s; and when and where open fingers last pressed, s and m.
#[derive(Clone, Copy, Debug)]
struct Steady {
    force_n: f64,
    since_s: f64,
    pressed_s: f64,
    pressed_m: crate::Vec2,
}

impl Default for Steady {
    fn default() -> Self {
        Self { force_n: 0.0, since_s: 0.0, pressed_s: f64::NEG_INFINITY, pressed_m: crate::Vec2::zeros() }
    }
}

/// Newest frame that the operator has seen and considered.
#[derive(Clone, Copy, Debug)]
struct Seen {
    frame: Glance,
    moved_m: f64,
}

/// The hand in a look.
#[derive(Clone, Copy, Debug)]
struct Glance {
    time_s: f64,
    hand_m: crate::Vec2,
    apart_m: f64,
    grip_n: f64,
}

impl Patience {
    /// Takes the look that can be acted on now.
    pub fn look(&mut self, frame: &Frame) {
        let Frame { time_s, hand_m, apart_m, grip_n, down_n, .. } = *frame;
        let now = Glance { time_s, hand_m, apart_m, grip_n };
        if (down_n - self.steady.force_n).abs() > STEADY_N {
            (self.steady.force_n, self.steady.since_s) = (down_n, time_s);
        }
        if down_n > PRESSES_N && grip_n < LOOSE_N {
            (self.steady.pressed_s, self.steady.pressed_m) = (time_s, hand_m);
        }
        let before = self.seen.map(|seen| seen.frame).filter(|before| before.time_s < time_s);
        if let Some(before) = before {
            self.seen = Some(Seen { frame: now, moved_m: (hand_m - before.hand_m).norm() });
        } else if self.seen.is_none() {
            self.seen = Some(Seen { frame: now, moved_m: f64::INFINITY });
        }
    }

    /// Advance of the plan in the next `dt_s`, s: zero at the end of a movement (at `ended`) that the operator has not
    /// seen to end.
    pub fn allow(&mut self, ended: Option<Goal>, dt_s: f64) -> f64 {
        let Some(goal) = ended else { return dt_s };
        let presses = self.presses(&goal);
        let steady = |seen: &Seen| !presses || seen.frame.time_s - self.steady.since_s > STEADY_S;
        let (near_m, longest_s) = if presses { (PRESSED_M, LONGEST_PRESS_S) } else { (THERE_M, LONGEST_S) };
        if self.waited_s < longest_s && !self.seen.is_some_and(|seen| seen.shows(&goal, near_m) && steady(&seen)) {
            self.waited_s += dt_s;
            return 0.0;
        }
        self.waited_s = 0.0;
        dt_s
    }

    /// True if open fingers press there, or have just bounced off.
    fn presses(&self, goal: &Goal) -> bool {
        let Some(seen) = self.seen else { return false };
        let there = (goal.center_m - self.steady.pressed_m).norm() < PRESSED_M;
        there && goal.pinch_n == 0.0 && seen.frame.time_s - self.steady.pressed_s < BOUNCES_S
    }
}

impl Seen {
    /// True if the hand is seen within `near_m` of the goal, gripping as it should, and at rest.
    fn shows(&self, goal: &Goal, near_m: f64) -> bool {
        let Glance { hand_m, apart_m, grip_n, .. } = self.frame;
        let gripped = if goal.pinch_n > 0.0 { grip_n > PINCHED * goal.pinch_n } else { grip_n < LOOSE_N };
        let there = (hand_m - goal.center_m).norm() < near_m && apart_m < goal.aperture_m + OPEN_M;
        there && gripped && self.moved_m < STILL_M
    }
}
