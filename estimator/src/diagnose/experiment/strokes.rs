//! Strokes of a motion of the library: target position and transverse push over time.
//!
//! Motions that can be asked for: what a person, or a program that moves like one, can do with an object in half a
//! minute.

use crate::diagnose::contract::Experiment;

/// Peak over mean speed of a movement from rest to rest.
/// Source: 15/8 of the mean speed, the peak of a minimum-jerk movement (Flash & Hogan 1985).
pub(crate) const PEAK: f64 = 1.875;
/// Time without touch that is asked for before and after a motion, s.
/// Choice: not varied. It changes the words of a proposal and no diagnosis.
pub(crate) const FREE_S: f64 = 2.0;
/// Shortest duration of a back-and-forth movement, s.
/// Choice: halved or doubled, none of 36 answers changes.
pub(crate) const SHORTEST_STROKE_S: f64 = 0.25;

/// Minimum jerk, as a share of the way.
pub(crate) fn smooth(u: f64) -> f64 {
    let u = u.clamp(0.0, 1.0);
    u * u * u * (10.0 - 15.0 * u + 6.0 * u * u)
}

/// Position and push across, in units of the experiment, at a time.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    knots: Vec<(f64, f64, f64)>,
}

impl Course {
    /// Knots of the motion. `speed`: half ranges per second at pace 1.
    pub(crate) fn of(excitation: &Excitation, speed: f64, until_s: f64) -> Self {
        let mut knots = vec![(0.0, 0.0, 0.0)];
        let mut k = 0;
        while let Some((time_s, place, _)) = knots.last().copied().filter(|k| k.0 < until_s) {
            let step = (excitation.step)(k);
            let takes_s =
                (PEAK * (step.to - place).abs() / (step.pace * speed).max(f64::MIN_POSITIVE)).max(SHORTEST_STROKE_S);
            knots.push((time_s + takes_s, step.to, step.across));
            if step.rest_s > 0.0 {
                knots.push((time_s + takes_s + step.rest_s, step.to, step.across));
            }
            k += 1;
        }
        Self { knots }
    }

    /// Smooth between the knots (minimum jerk).
    pub(crate) fn at(&self, time_s: f64) -> (f64, f64) {
        let next = self.knots.partition_point(|k| k.0 <= time_s).clamp(1, self.knots.len() - 1);
        let ((t0, p0, a0), (t1, p1, a1)) = (self.knots[next - 1], self.knots[next]);
        let smooth = smooth((time_s - t0) / (t1 - t0));
        (p0 + (p1 - p0) * smooth, a0 + (a1 - a0) * smooth)
    }
}

/// Target of an experiment: position of the object and transverse push.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// Length in m, or angle in rad: as in the [`Experiment`].
    pub coordinate: f64,
    /// Outwards, N.
    pub across_n: f64,
}

/// The motion of an experiment, for a hand that follows it.
#[derive(Clone, Debug)]
pub struct Strokes {
    course: Course,
    middle: f64,
    half_range: f64,
    across_n: f64,
}

impl Strokes {
    /// `None` for a motion that is not in the library, or for numbers that define none.
    pub fn of(asked: &Experiment) -> Option<Self> {
        let excitation = LIBRARY.iter().chain([&HANG]).find(|e| e.id == asked.id)?;
        let sane = [asked.seconds, asked.half_range, asked.fast].iter().all(|v| v.is_finite() && *v > 0.0);
        if !sane || !asked.middle.is_finite() || !asked.across_n.is_finite() {
            return None;
        }
        let course = Course::of(excitation, asked.fast / asked.half_range, asked.seconds);
        Some(Self { course, middle: asked.middle, half_range: asked.half_range, across_n: asked.across_n })
    }

    /// Target at this time after the object was taken, s.
    pub fn at(&self, time_s: f64) -> Stroke {
        let (place, across) = self.course.at(time_s.max(0.0));
        Stroke { coordinate: self.middle + self.half_range * place, across_n: self.across_n * across }
    }
}

/// One movement: target, speed, rest after it, and transverse push at its end.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    /// Target position, in half ranges from the middle.
    pub to: f64,
    /// Its highest speed, relative to the experiment's.
    pub pace: f64,
    /// s
    pub rest_s: f64,
    /// Transverse push, in units of the usual one.
    pub across: f64,
}

/// A motion of the library.
pub struct Excitation {
    pub id: &'static str,
    pub words: &'static str,
    /// Duration without touch at either end, s.
    pub free_s: f64,
    /// The k-th movement.
    pub step: fn(usize) -> Move,
}

const fn going(to: f64, pace: f64, rest_s: f64, across: f64) -> Move {
    Move { to, pace, rest_s, across }
}

/// Sides of the strokes in turn.
fn side(k: usize) -> f64 {
    if k.is_multiple_of(2) { 1.0 } else { -1.0 }
}

fn one_of<const N: usize>(of: [f64; N], k: usize) -> f64 {
    of[k % N]
}

/// Slow motion with a hung weight: its inertia does not matter.
pub const HANG: Excitation = Excitation {
    id: "hang-weight",
    words: "turn slowly to and fro over the whole range, and let go for a second before and after",
    free_s: 1.2,
    step: |k| going(side(k), one_of([0.35, 0.5], k / 2), 0.2, one_of([0.3, -0.3], k / 2)),
};

pub static LIBRARY: [Excitation; 7] = [
    Excitation {
        id: "sweep-across",
        words: "turn to and fro over the whole range, slowly and fast, now pulling and now pushing across the motion",
        free_s: 0.0,
        step: |k| {
            going(side(k), one_of([0.4, 1.0, 0.7, 0.2], k / 2), 0.1, one_of([1.0, 1.0, 1.0, -1.0, -1.0, -1.0], k))
        },
    },
    Excitation {
        id: "sweep-let-go",
        words: "turn to and fro over the whole range, slowly and fast, and let go for two seconds before and after",
        free_s: FREE_S,
        step: |k| going(side(k), one_of([0.4, 1.0, 0.7, 0.2], k / 2), 0.1, one_of([0.6, 1.2, -0.8], k)),
    },
    Excitation {
        id: "short-strokes",
        words: "go to and fro in short strokes at several places",
        free_s: 0.0,
        step: |k| {
            let place = one_of([-0.6, 0.2, 0.6, -0.2], k / 8);
            going(place + 0.06 * side(k), 0.3, 0.05, one_of([0.7, 0.7, 1.3], k))
        },
    },
    Excitation {
        id: "bursts",
        words: "start and stop hard: short, fast bursts both ways",
        free_s: 0.0,
        step: |k| going(0.3 * side(k), 1.2, 0.15, one_of([0.8, 1.2, 1.0], k)),
    },
    Excitation {
        id: "one-way",
        words: "go all the way to one end very slowly, come back fast, and again the other way round",
        free_s: 0.0,
        step: |k| {
            let pace = if k.is_multiple_of(3) { 1.0 } else { 0.12 };
            going(side(k), pace, 0.1, one_of([0.6, 1.2], k))
        },
    },
    Excitation {
        id: "rests-and-squeezes",
        words: "make slow full strokes with a rest at each end, and push harder across the motion in every other one",
        free_s: 0.0,
        step: |k| going(0.9 * side(k), 0.3, 0.8, one_of([0.4, 0.4, 1.6, 1.6], k)),
    },
    Excitation {
        id: "long-mixed",
        words: "move about as before: long and short strokes, slow and fast ones, pulling and pushing across, with two seconds of free motion \
                before and after",
        free_s: FREE_S,
        step: |k| {
            let to = one_of([0.9, -0.3, 0.4, -1.0, 0.1, 0.7, -0.7, 0.2, -0.1, 1.0, -0.9], k);
            let pace = one_of([0.5, 0.25, 0.9, 0.4, 0.7, 0.15, 1.0], k);
            going(to, pace, one_of([0.0, 0.2], k), one_of([0.8, -0.6, 1.2, -1.0, 0.3], k))
        },
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_motion_is_faster_or_wider_than_what_is_asked() {
        for excitation in &LIBRARY {
            let course = Course::of(excitation, 2.0, 20.0);
            let mut fastest = 0.0_f64;
            for i in 1..4000 {
                let t = f64::from(i) * 0.005;
                let (now, before) = (course.at(t).0, course.at(t - 0.005).0);
                fastest = fastest.max((now - before).abs() / 0.005);
                assert!(now.abs() <= 1.0 + 1e-9, "{}", excitation.id);
            }
            assert!(fastest > 0.4 && fastest < 2.0 * 1.25, "{}: {fastest}", excitation.id);
        }
    }

    #[test]
    fn strokes_go_about_the_middle_within_the_range_and_unknown_motions_are_none() {
        let asked = Experiment {
            id: "sweep-across".to_owned(),
            seconds: 20.0,
            free_s: 0.0,
            middle: 3.0,
            half_range: 2.0,
            fast: 4.0,
            across_n: 0.5,
            added_weight_n: 0.0,
            added_lever_m: 0.0,
        };
        let strokes = Strokes::of(&asked).expect("a motion of the library");
        let all: Vec<Stroke> = (0..2_000).map(|k| strokes.at(f64::from(k) * 0.01)).collect();
        let least = all.iter().map(|s| s.coordinate).fold(f64::MAX, f64::min);
        let most = all.iter().map(|s| s.coordinate).fold(f64::MIN, f64::max);
        assert!((least - 1.0).abs() < 1e-3 && (most - 5.0).abs() < 1e-3, "{least} {most}");
        assert!(all.iter().any(|s| s.across_n > 0.49) && all.iter().any(|s| s.across_n < -0.49));
        assert!((strokes.at(0.0).coordinate - 3.0).abs() < 1e-12, "it begins in the middle");
        assert!(Strokes::of(&Experiment { id: "juggle".to_owned(), ..asked.clone() }).is_none());
        assert!(Strokes::of(&Experiment { fast: f64::NAN, ..asked }).is_none());
    }
}
