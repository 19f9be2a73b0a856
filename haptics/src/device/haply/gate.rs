//! Plausibility gate for answers of a board: no hand moves far within a millisecond.
//!
//! The protocol has no checksum: a reply with wrong angles and the right id looks like any other. Motion that no hand
//! can make is refused. A new place is accepted only after answers agree on it for longer than the servo's watchdog
//! waits (the board was re-seated, or the program was held up). By then the force is zero, and it comes back softly.

use crate::Vec2;
use std::time::{Duration, Instant};

/// No hand moves a tip faster, m/s.
pub const FASTEST_M_S: f64 = 3.0;
/// Steps up to this size pass at any speed, m: answers may come close after each other.
pub const SMALLEST_JUMP_M: f64 = 0.005;
/// A silence excuses no longer way than a hand goes in this time.
const LONGEST_EXCUSE: Duration = Duration::from_millis(5);
/// Number of agreeing answers needed before a jump is believed; each that disagrees cancels as many that agree.
const AGREEING: u32 = 5;
/// Least time over which they must agree: longer than the servo's watchdog waits (20 ms).
const AGREEING_FOR: Duration = Duration::from_millis(25);

/// Verdict of the gate on an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// A hand can have gone there.
    Follows,
    /// The first place, or a new one that the answers have agreed on.
    Begins,
    /// Not known yet: the board has just been started.
    Waits,
    /// No hand can have gone there.
    Refused,
}

/// Remembers where the hand was, and where it may be instead.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gate {
    known: Option<(Vec2, Instant)>,
    candidate: Option<Candidate>,
}

#[derive(Clone, Copy, Debug)]
struct Candidate {
    newest: (Vec2, Instant),
    since: Instant,
    answers: u32,
}

impl Gate {
    /// Judges a tip position, m in the device's frame, that came `now`.
    pub fn judge(&mut self, tip_m: Vec2, now: Instant) -> Verdict {
        if self.known.is_some_and(|known| is_possible(known, tip_m, now)) {
            (self.known, self.candidate) = (Some((tip_m, now)), None);
            return Verdict::Follows;
        }
        let fresh = Candidate { newest: (tip_m, now), since: now, answers: 1 };
        let candidate = match self.candidate {
            Some(old) if is_possible(old.newest, tip_m, now) => {
                Candidate { newest: (tip_m, now), since: old.since, answers: old.answers + 1 }
            }
            // One false reply among many must not throw away the others.
            Some(old) if old.answers > AGREEING => Candidate { answers: old.answers - AGREEING, ..old },
            _ => fresh,
        };
        let agreed = candidate.newest.1 == now && candidate.answers >= AGREEING;
        if agreed && now - candidate.since >= AGREEING_FOR {
            (self.known, self.candidate) = (Some((tip_m, now)), None);
            return Verdict::Begins;
        }
        self.candidate = Some(candidate);
        if self.known.is_some() { Verdict::Refused } else { Verdict::Waits }
    }
}

/// True if a hand can have gone from a place at a time to `tip_m` by `now`.
fn is_possible((from_m, at): (Vec2, Instant), tip_m: Vec2, now: Instant) -> bool {
    let excused_s = (now - at).min(LONGEST_EXCUSE).as_secs_f64();
    (tip_m - from_m).norm() <= SMALLEST_JUMP_M.max(FASTEST_M_S * excused_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: Vec2 = Vec2::new(0.019, 0.12);
    const THERE: Vec2 = Vec2::new(0.019, 0.06);

    /// A gate that knows the hand to be at `HERE`, and the moment of that.
    fn knowing() -> (Gate, Instant) {
        let (mut gate, begun) = (Gate::default(), Instant::now());
        let verdicts: Vec<Verdict> = (0..=25).map(|ms| gate.judge(HERE, begun + Duration::from_millis(ms))).collect();
        assert!(verdicts[..25].iter().all(|verdict| *verdict == Verdict::Waits), "a start is no fault");
        assert_eq!(verdicts[25], Verdict::Begins);
        (gate, begun + Duration::from_millis(25))
    }

    #[test]
    fn a_single_jump_is_refused_and_the_next_answer_passes() {
        let (mut gate, mut now) = knowing();
        for _ in 0..100 {
            now += Duration::from_millis(1);
            assert_eq!(gate.judge(THERE, now), Verdict::Refused);
            now += Duration::from_millis(1);
            assert_eq!(gate.judge(HERE, now), Verdict::Follows);
        }
        // A silence of a second excuses it no more.
        assert_eq!(gate.judge(THERE, now + Duration::from_secs(1)), Verdict::Refused);
    }

    #[test]
    fn a_start_with_one_false_reply_in_ten_is_a_start() {
        // Four answers in a millisecond, as fast as a board may be.
        let (mut gate, begun) = (Gate::default(), Instant::now());
        let verdicts: Vec<Verdict> = (0..200_u32)
            .map(|n| gate.judge(if n % 10 == 0 { THERE } else { HERE }, begun + n * Duration::from_micros(250)))
            .collect();
        let start = verdicts.iter().position(|verdict| *verdict == Verdict::Begins).expect("it begins");
        assert!((100..110).contains(&start) && start % 10 != 0, "after {start} answers, at the true place");
        assert!(verdicts[..start].iter().all(|verdict| *verdict == Verdict::Waits));
        assert_eq!(gate.judge(HERE, begun + Duration::from_millis(50)), Verdict::Follows);
    }

    #[test]
    fn a_fast_hand_passes_and_a_faster_one_does_not() {
        for (speed, verdict) in [(2.9, Verdict::Follows), (6.0, Verdict::Refused)] {
            let (mut gate, now) = knowing();
            let later = Duration::from_millis(4);
            let tip = HERE + Vec2::new(speed * later.as_secs_f64(), 0.0);
            assert_eq!(gate.judge(tip, now + later), verdict, "{speed} m/s");
        }
    }

    #[test]
    fn answers_that_agree_for_longer_than_the_watchdog_are_believed() {
        let (mut gate, mut now) = knowing();
        let mut refused = 0;
        loop {
            now += Duration::from_millis(1);
            match gate.judge(THERE, now) {
                Verdict::Refused => refused += 1,
                verdict => break assert_eq!(verdict, Verdict::Begins),
            }
        }
        assert_eq!(refused, 25);
        // Answers that jump back and forth agree on nothing.
        for step in 0..1_000 {
            now += Duration::from_millis(1);
            let aside = Vec2::new(if step % 2 == 0 { 0.02 } else { -0.02 }, 0.03);
            assert_eq!(gate.judge(THERE + aside, now), Verdict::Refused);
        }
    }
}
