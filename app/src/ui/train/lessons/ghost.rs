//! Ghost of an expert's fingers that accompanies the trainee: at the expert's pace, and never too far ahead to follow.

use crate::ui::train::lessons::trace::{Point, Trace};
use haptics::Vec2;

/// Distance beyond which the ghost waits for the trainee, m.
const REACH_M: f64 = 0.015;
/// Distance from a future ghost position within which the trainee counts as ahead of it, m, and the time horizon of
/// this search, s.
const AHEAD_M: f64 = 0.006;
const AHEAD_S: f64 = 1.5;
/// Time for which a ghost continues while its contact differs from the trainee's, as a demonstration, s.
const SHOWS_S: f64 = 0.25;
/// Maximum wait for a trainee who acts differently, s.
const PATIENCE_S: f64 = 3.0;
/// Time step of the search ahead, s.
const STEP_S: f64 = 1.0 / 30.0;

/// Reason for which a ghost waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// The trainee's hand is elsewhere.
    Far,
    /// The expert touches something here, the trainee does not.
    Touch,
    /// The expert has let go, the trainee has not.
    LetGo,
}

/// Position of the ghost on the expert's path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ghost {
    /// Time of the expert's trace, s.
    pub time_s: f64,
    /// Reason for which it waits; `None` while it moves.
    pub waits: Option<Wait>,
    seen_s: Option<f64>,
    unlike_s: f64,
    waited_s: f64,
}

impl Ghost {
    /// Updates the ghost from the trainee's tips at a time of the world, s; `touches` is true if one of them is in
    /// contact.
    pub fn see(&mut self, way: &Trace, now_s: f64, tips_in_world: [Vec2; 2], touches: bool) {
        let span_s = (now_s - self.seen_s.unwrap_or(now_s)).max(0.0);
        self.seen_s = Some(now_s);
        let middle = 0.5 * (tips_in_world[0] + tips_in_world[1]);
        let Some(point) = way.at(self.time_s) else { return };
        if (point.middle_m() - middle).norm() > REACH_M {
            self.waits = Some(Wait::Far);
            self.catch_up(way, middle, touches);
            return;
        }
        if point.touches() == touches {
            (self.unlike_s, self.waited_s) = (0.0, 0.0);
        } else {
            self.unlike_s += span_s;
        }
        self.waits = None;
        if self.unlike_s > SHOWS_S && self.waited_s < PATIENCE_S {
            self.waited_s += span_s;
            self.waits = Some(if point.touches() { Wait::Touch } else { Wait::LetGo });
            return;
        }
        self.time_s = (self.time_s + span_s).min(way.duration_s());
    }

    /// Advances the ghost to a hand that is ahead on the same path.
    fn catch_up(&mut self, way: &Trace, middle_m: Vec2, touches: bool) {
        let last = (AHEAD_S / STEP_S) as u32;
        let is_here = |point: &Point| (point.middle_m() - middle_m).norm() < AHEAD_M && point.touches() == touches;
        let there = (1..=last)
            .map(|k| self.time_s + STEP_S * f64::from(k))
            .find(|later_s| *later_s <= way.duration_s() && way.at(*later_s).is_some_and(is_here));
        if let Some(there_s) = there {
            (self.time_s, self.waits) = (there_s, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME_S: f64 = 1.0 / 60.0;

    /// Two seconds to the right at 20 mm/s, with an object between the fingers in the second one.
    fn way() -> Trace {
        let points = (0..=60).map(|k| {
            let time_s = f64::from(k) / 30.0;
            let x = 0.02 * time_s;
            let grip = if time_s > 1.0 { 1.0 } else { 0.0 };
            Point {
                time_s,
                tips_in_world: [Vec2::new(x - 0.01, 0.0), Vec2::new(x + 0.01, 0.0)],
                tip_force_n: [Vec2::new(grip, 0.0), Vec2::new(-grip, 0.0)],
            }
        });
        Trace { points: points.collect() }
    }

    fn follow(ghost: &mut Ghost, seconds: f64, from_s: f64, hand: impl Fn(&Ghost) -> (f64, bool)) {
        let frames = (seconds / FRAME_S).round() as u32;
        for k in 0..frames {
            let (x, touches) = hand(ghost);
            let tips = [Vec2::new(x - 0.012, 0.001), Vec2::new(x + 0.012, 0.001)];
            ghost.see(&way(), from_s + FRAME_S * f64::from(k), tips, touches);
        }
    }

    #[test]
    fn it_goes_at_the_experts_pace_beside_a_hand_that_does_the_same() {
        let mut ghost = Ghost::default();
        follow(&mut ghost, 1.0, 5.0, |ghost| (0.02 * ghost.time_s, ghost.time_s > 1.0));
        assert!((ghost.time_s - 1.0).abs() < 2.0 * FRAME_S, "{ghost:?}");
        follow(&mut ghost, 2.0, 6.0, |ghost| (0.02 * ghost.time_s, ghost.time_s > 1.0));
        assert!((ghost.time_s - 2.0).abs() < 1e-9, "{ghost:?}");
    }

    #[test]
    fn it_waits_for_a_hand_that_stays_behind_and_goes_on_with_it() {
        let mut ghost = Ghost::default();
        follow(&mut ghost, 10.0, 0.0, |_| (-0.01, false));
        assert_eq!(ghost.waits, Some(Wait::Far));
        assert!((0.005 + 0.02 * ghost.time_s - REACH_M).abs() < 0.011, "{ghost:?}");
        let before_s = ghost.time_s;
        follow(&mut ghost, 0.2, 10.0, |ghost| (0.02 * ghost.time_s, false));
        assert!(ghost.waits.is_none() && ghost.time_s > before_s + 0.1, "{ghost:?}");
    }

    #[test]
    fn it_shows_how_to_close_waits_for_it_and_does_not_wait_forever() {
        let mut ghost = Ghost::default();
        follow(&mut ghost, 2.0, 0.0, |ghost| (0.02 * ghost.time_s, false));
        assert_eq!(ghost.waits, Some(Wait::Touch));
        assert!(ghost.time_s > 1.0 && ghost.time_s < 1.4, "{ghost:?}");
        let mut closed = ghost;
        follow(&mut closed, 0.1, 2.0, |ghost| (0.02 * ghost.time_s, true));
        assert!(closed.waits.is_none() && closed.time_s > ghost.time_s, "{closed:?}");
        follow(&mut ghost, 5.0, 2.0, |ghost| (0.02 * ghost.time_s, false));
        assert!((ghost.time_s - 2.0).abs() < 1e-9, "{ghost:?}");
    }

    #[test]
    fn it_runs_after_a_hand_that_is_ahead() {
        let mut ghost = Ghost::default();
        follow(&mut ghost, 0.05, 0.0, |_| (0.0, false));
        follow(&mut ghost, 0.05, 0.05, |_| (0.022, true));
        assert!(ghost.time_s > 0.8 && ghost.waits.is_none(), "{ghost:?}");
        // The hand is still empty: it has not come that far.
        let mut ghost = Ghost::default();
        follow(&mut ghost, 0.1, 0.0, |_| (0.035, false));
        assert_eq!(ghost.waits, Some(Wait::Far));
    }
}
