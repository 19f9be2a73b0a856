//! Motions that can be asked for: what a person, or a program that moves like one, can do with an object in half a
//! minute.

/// Time without touch that is asked for before and after a motion, s.
pub(crate) const FREE_S: f64 = 2.0;

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
