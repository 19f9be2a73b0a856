//! Motions of needles and switches: from one turning point to the next, smooth between them.

use super::strokes::{PEAK, SHORTEST_STROKE_S, smooth};
use crate::diagnose::contract::Experiment;
use crate::diagnose::data::limits::{HALF, PAUSE_S};

/// Ids of the motions.
pub const PIERCE: &str = "pierce-slow-fast";
pub const THROW: &str = "throw-slow-fast";
/// Lowest and highest speed of a hand in a proposed motion, m/s.
/// Choice: not varied. They change the words of a proposal and no diagnosis.
pub(crate) const HAND_SPEEDS_M_S: (f64, f64) = (0.03, 0.15);
/// Paces of throws, in turn; two throws per pace, one to either side.
/// Choice: halved or doubled, none of 21 answers changes.
const PACES: [f64; 3] = [0.15, 1.0, 0.4];
/// Duration of the press against a stop, of the release, and of the rest after it, s.
/// Choice: halved or doubled, none of 21 answers changes.
const PRESS_S: f64 = 0.35;

/// Turning points: time, s, and place.
#[derive(Clone, Debug)]
struct Turns(Vec<(f64, f64)>);

impl Turns {
    fn end(&self) -> (f64, f64) {
        self.0.last().copied().unwrap_or_default()
    }

    fn rest(&mut self, seconds: f64) {
        let (now_s, place) = self.end();
        self.0.push((now_s + seconds, place));
    }

    /// Adds a movement to a position, with this peak speed.
    fn go(&mut self, to: f64, fastest: f64) {
        let (now_s, from) = self.end();
        self.0.push((now_s + (PEAK * (to - from).abs() / fastest).max(SHORTEST_STROKE_S), to));
    }

    fn at(&self, time_s: f64) -> f64 {
        let next = self.0.partition_point(|k| k.0 <= time_s);
        match (next.checked_sub(1).and_then(|k| self.0.get(k)), self.0.get(next)) {
            (Some((t0, from)), Some((t1, to))) => from + (to - from) * smooth((time_s - t0) / (t1 - t0)),
            (Some((_, place)), None) | (None, Some((_, place))) => *place,
            (None, None) => 0.0,
        }
    }
}

/// Sequence of insertions of a needle. At one place after the other it presses and draws back, pushes through, moves in
/// the hole slowly and fast, and is withdrawn.
#[derive(Clone, Debug)]
pub struct Insertions {
    depth: Turns,
    /// Start of each insertion, s.
    begin_s: Vec<f64>,
    puncture_m: f64,
}

impl Insertions {
    /// `None` for another motion, or for numbers that define none.
    pub fn of(asked: &Experiment) -> Option<Self> {
        let (puncture_m, full_m) = (asked.middle - asked.half_range, asked.middle + asked.half_range);
        let sane = [asked.seconds, asked.half_range, asked.fast, puncture_m].iter().all(|v| v.is_finite() && *v > 0.0);
        if asked.id != PIERCE || !sane {
            return None;
        }
        let (mut depth, mut begin_s) = (Turns(vec![(0.0, -asked.half_range)]), Vec::new());
        while depth.end().0 < asked.seconds {
            begin_s.push(depth.end().0);
            depth.go(HALF * puncture_m, 0.2 * asked.fast);
            depth.go(-asked.half_range, asked.fast);
            depth.go(full_m, 0.5 * asked.fast);
            for pace in [0.15, 1.0, 1.0] {
                for place in [puncture_m, full_m, puncture_m, full_m] {
                    depth.go(place, pace * asked.fast);
                }
            }
            depth.go(-asked.half_range, 0.5 * asked.fast);
            depth.rest(PAUSE_S);
        }
        Some(Self { depth, begin_s, puncture_m })
    }

    /// Number of insertions.
    pub fn count(&self) -> usize {
        self.begin_s.len()
    }

    /// Duration of all insertions, s.
    pub fn duration_s(&self) -> f64 {
        self.depth.end().0
    }

    /// Target depth of the needle's tip, m beyond the sheet's surface.
    pub fn depth_m(&self, time_s: f64) -> f64 {
        self.depth.at(time_s)
    }

    /// Expected puncture depth of the sheet, m.
    pub fn puncture_m(&self) -> f64 {
        self.puncture_m
    }

    /// The current insertion, and the progress of the hand to the place of the next one, 0 … 1.
    pub fn place(&self, time_s: f64) -> (usize, f64) {
        let k = self.begin_s.partition_point(|b| *b <= time_s).saturating_sub(1);
        let ends_s = self.begin_s.get(k + 1).copied().unwrap_or_else(|| self.duration_s());
        (k, smooth(1.0 - (ends_s - time_s) / PAUSE_S))
    }
}

/// One throw of a switch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Throw {
    /// Start of the throw, s.
    pub begins_s: f64,
    /// Duration of the finger's movement, s.
    pub takes_s: f64,
    /// To the right, or to the left.
    pub right: bool,
    /// Its fastest speed, m/s.
    pub fast_m_s: f64,
}

/// Sequence of throws of a switch, to either side in turn: two slow ones, two fast ones, two in between. At each stop
/// the knob is pressed, then released.
#[derive(Clone, Debug)]
pub struct Throws {
    throws: Vec<Throw>,
    middle_of_hand: Turns,
}

impl Throws {
    /// `None` for another motion, or for numbers that define none. `pressed_m`, `released_m`: distance of the hand from
    /// the middle when it presses the knob against a stop, and after it has released it there.
    pub fn of(asked: &Experiment, pressed_m: f64, released_m: f64) -> Option<Self> {
        let sane = [asked.seconds, asked.half_range, asked.fast, pressed_m, released_m];
        if asked.id != THROW || !sane.iter().all(|v| v.is_finite() && *v > 0.0) {
            return None;
        }
        let (mut throws, mut way) = (Vec::new(), Turns(vec![(0.0, -released_m)]));
        while way.end().0 < asked.seconds {
            let (right, fast_m_s) = (throws.len() % 2 == 0, PACES[(throws.len() / 2) % PACES.len()] * asked.fast);
            let side = if right { 1.0 } else { -1.0 };
            let begins_s = way.end().0;
            way.go(side * pressed_m, fast_m_s);
            throws.push(Throw { begins_s, takes_s: way.end().0 - begins_s, right, fast_m_s });
            way.rest(PRESS_S);
            let (now_s, _) = way.end();
            way.0.push((now_s + PRESS_S, side * released_m));
            way.rest(PRESS_S);
        }
        Some(Self { throws, middle_of_hand: way })
    }

    /// All of them, first to last.
    pub fn all(&self) -> &[Throw] {
        &self.throws
    }

    /// Duration of all throws, s.
    pub fn duration_s(&self) -> f64 {
        self.middle_of_hand.end().0
    }

    /// Offset of the middle of the fingers to the right of the middle of the knob's travel, m.
    pub fn at_m(&self, time_s: f64) -> f64 {
        self.middle_of_hand.at(time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn asked(id: &str, seconds: f64) -> Experiment {
        Experiment {
            id: id.to_owned(),
            seconds,
            free_s: 2.0,
            middle: 7.5e-3,
            half_range: 2.5e-3,
            fast: 0.04,
            across_n: 0.0,
            added_weight_n: 0.0,
            added_lever_m: 0.0,
        }
    }

    #[test]
    fn a_needle_presses_draws_back_goes_through_and_moves_in_the_hole_slowly_and_fast() {
        let insertions = Insertions::of(&asked(PIERCE, 15.0)).expect("a motion");
        assert_eq!(insertions.count(), 2);
        let at = |k: usize| insertions.depth_m(1e-3 * k as f64);
        let steps = (1e3 * insertions.duration_s()) as usize;
        let deepest = (0..steps).map(at).fold(f64::MIN, f64::max);
        let fastest = (1..steps).map(|k| (at(k) - at(k - 1)).abs() / 1e-3).fold(0.0, f64::max);
        assert!((deepest - 10e-3).abs() < 1e-6 && (0.036..0.0405).contains(&fastest), "{deepest} {fastest}");
        let first = (0..steps).find(|k| at(*k) > insertions.puncture_m()).expect("through");
        assert!((0..first).any(|k| at(k) > 2.9e-3 && at(k) < 3.1e-3) && at(first - 400) < at(first));
        assert_eq!(insertions.place(0.5), (0, 0.0));
        let (k, share) = insertions.place(insertions.duration_s());
        assert!(k == 1 && (share - 1.0).abs() < 1e-9);
        assert!(Insertions::of(&asked(THROW, 15.0)).is_none());
    }

    #[test]
    fn a_switch_is_thrown_to_both_sides_at_three_speeds() {
        let throws = Throws::of(&asked(THROW, 30.0), 15e-3, 8e-3).expect("a motion");
        let all = throws.all();
        assert!(all.len() > 5 && all.windows(2).all(|w| w[0].right != w[1].right));
        assert!(all[2].fast_m_s > 2.0 * all[4].fast_m_s && all[4].fast_m_s > 2.0 * all[0].fast_m_s);
        let pressed = throws.at_m(all[0].begins_s + all[0].takes_s + 0.1);
        assert!((pressed - 15e-3).abs() < 1e-9 && (throws.at_m(throws.duration_s()).abs() - 8e-3).abs() < 1e-9);
        assert!(Throws::of(&Experiment { fast: f64::NAN, ..asked(THROW, 9.0) }, 1e-2, 1e-2).is_none());
    }
}
