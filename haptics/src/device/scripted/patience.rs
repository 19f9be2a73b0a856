//! Move and wait (Ferrell 1965): over a slow line people move, stop until the picture shows what became of it, and go on. The operator
//! that does so ends each movement where it is planned to end, and begins the next when it has *seen* the hand there.

use super::eye::Frame;
use super::plan::Goal;

/// The hand counts as where it was wanted within this, m.
const THERE_M: f64 = 3e-3;
/// So far the fingers may be further open than wanted, m.
const OPEN_M: f64 = 2e-3;
/// A hand that moves less than this from one look to the one before it counts as at rest, m.
const STILL_M: f64 = 2e-4;
/// Share of the wanted pinch that must be seen; the rest gives in pads and springs.
const PINCHED: f64 = 0.45;
/// A grip below this is none, N.
const LOOSE_N: f64 = 0.05;
/// Whoever has waited so long goes on, s.
const LONGEST_S: f64 = 4.0;

/// What a waiting operator knows.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Patience {
    waited_s: f64,
    seen: Option<Seen>,
}

/// What was last seen and thought about.
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
        let Frame { time_s, hand_m, apart_m, grip_n, .. } = *frame;
        let now = Glance { time_s, hand_m, apart_m, grip_n };
        let before = self.seen.map(|seen| seen.frame).filter(|before| before.time_s < time_s);
        if let Some(before) = before {
            self.seen = Some(Seen { frame: now, moved_m: (hand_m - before.hand_m).norm() });
        } else if self.seen.is_none() {
            self.seen = Some(Seen { frame: now, moved_m: f64::INFINITY });
        }
    }

    /// How far the plan may go on in the next `dt_s`: not at all where a movement has ended (at `ended`) that was not seen to end.
    pub fn allow(&mut self, ended: Option<Goal>, dt_s: f64) -> f64 {
        let Some(goal) = ended else { return dt_s };
        if self.waited_s < LONGEST_S && !self.seen.is_some_and(|seen| seen.shows(&goal)) {
            self.waited_s += dt_s;
            return 0.0;
        }
        self.waited_s = 0.0;
        dt_s
    }
}

impl Seen {
    fn shows(&self, goal: &Goal) -> bool {
        let Glance { hand_m, apart_m, grip_n, .. } = self.frame;
        let gripped = if goal.pinch_n > 0.0 { grip_n > PINCHED * goal.pinch_n } else { grip_n < LOOSE_N };
        let there = (hand_m - goal.center_m).norm() < THERE_M && apart_m < goal.aperture_m + OPEN_M;
        there && gripped && self.moved_m < STILL_M
    }
}
