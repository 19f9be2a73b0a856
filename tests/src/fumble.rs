//! Hands that fail: the fingers open for a moment while they grip, as they lift or on the way, and what they held is lost or nearly so.

use haptics::Vec2;
use haptics::world::Input;
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// When the fingers open, counted from an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum When {
    /// A block has been gripped and stands on the ground.
    Gripped,
    /// A block has just left the ground.
    Lifted,
    /// A block is being carried.
    Carried,
}

/// One failure.
#[derive(Clone, Copy, Debug)]
pub struct Fumble {
    /// After which event.
    pub when: When,
    /// After how many of these events the one comes that counts.
    pub after: usize,
    /// How long after it, s.
    pub delay_s: f64,
    /// How far each finger opens, m.
    pub opening_m: f64,
    /// How long it stays open, s.
    pub open_s: f64,
}

/// Time in which the fingers open and close, s.
const EDGE_S: f64 = 0.08;

/// One or two failures at random.
pub fn drawn(seed: u64) -> Vec<Fumble> {
    let mut rng = StdRng::seed_from_u64(seed ^ 0xf0_b1e5);
    let count = rng.random_range(1..=2);
    (0..count)
        .map(|_| {
            let when = [When::Gripped, When::Lifted, When::Carried][rng.random_range(0..3)];
            let delay_s = match when {
                When::Gripped => rng.random_range(0.3..0.8),
                When::Lifted => rng.random_range(0.02..0.25),
                When::Carried => rng.random_range(0.5..1.8),
            };
            let (opening_m, open_s) = (rng.random_range(2e-3..4e-3), rng.random_range(0.15..0.4));
            Fumble { when, after: rng.random_range(0..2), delay_s, opening_m, open_s }
        })
        .collect()
}

/// What a hand with such failures does, step by step.
pub struct Clumsy {
    fumbles: Vec<Fumble>,
    starts_s: Vec<Option<f64>>,
    /// Events so far: grips and lifts.
    grips: usize,
    lifts: usize,
    before: &'static str,
}

impl Clumsy {
    /// A hand that fails like this.
    pub fn new(fumbles: Vec<Fumble>) -> Self {
        Self { starts_s: vec![None; fumbles.len()], fumbles, grips: 0, lifts: 0, before: "free-motion" }
    }

    /// Opens the fingers of `input` where it is time to; `label` is the true state of the world at `now_s`.
    pub fn spoil(&mut self, input: &mut Input, label: &'static str, now_s: f64) {
        let held = |label: &str| label.starts_with("hold") || label.starts_with("sliding");
        if held(label) && !held(self.before) {
            self.begin(now_s, self.grips, &[When::Gripped]);
            self.grips += 1;
        }
        if label == "hold-above-ground" && self.before != "hold-above-ground" && self.before != "no-state" {
            self.begin(now_s, self.lifts, &[When::Lifted, When::Carried]);
            self.lifts += 1;
        }
        if label != "no-state" {
            self.before = label;
        }
        for (fumble, start) in self.fumbles.iter().zip(&self.starts_s) {
            let Some(since_s) = start.map(|start| now_s - start).filter(|since| *since > 0.0) else { continue };
            let (share, rate) = opening(since_s, fumble.open_s);
            let apart = |sign: f64, value: f64| Vec2::new(sign * value * fumble.opening_m, 0.0);
            for (finger, sign) in [(0, -1.0), (1, 1.0)] {
                input.tip_in_world[finger] += apart(sign, share);
                input.tip_velocity[finger] += apart(sign, rate);
            }
        }
    }

    fn begin(&mut self, now_s: f64, events: usize, which: &[When]) {
        for (fumble, start) in self.fumbles.iter().zip(&mut self.starts_s) {
            if start.is_none() && which.contains(&fumble.when) && fumble.after == events {
                *start = Some(now_s + fumble.delay_s);
            }
        }
    }
}

/// How far open the fingers are, 0 … 1, and its rate, 1/s.
fn opening(since_s: f64, open_s: f64) -> (f64, f64) {
    let edge = |u: f64| {
        let share = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        (share, 30.0 * u * u * (1.0 - u) * (1.0 - u) / EDGE_S)
    };
    let back_s = since_s - EDGE_S - open_s;
    if since_s < EDGE_S {
        edge(since_s / EDGE_S)
    } else if back_s < 0.0 {
        (1.0, 0.0)
    } else if back_s < EDGE_S {
        let (share, rate) = edge(1.0 - back_s / EDGE_S);
        (share, -rate)
    } else {
        (0.0, 0.0)
    }
}
