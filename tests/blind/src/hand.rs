//! The operator: a spring and a damper between a reference that wanders and the handle. The motion is not prescribed; it comes
//! out of how the hand and the load pull on each other.

use super::chance::{Chance, Coloured};
use super::plan::Plan;

/// The operator's thoughts come every millisecond; between them the muscles pull smoothly.
const THOUGHT_S: f64 = 1e-3;
/// Largest lead of the reference over the handle, rad: nobody winds a spring up.
const LARGEST_LEAD: f64 = 1.3;

/// What a person is like.
#[derive(Clone, Copy, Debug)]
pub struct Habits {
    /// Stiffness of the hand along and across the motion, N/m.
    pub stiffness: f64,
    /// Damping of the hand, N s/m.
    pub damping: f64,
    /// Mean of how far outside the circle the hand would be, m.
    pub pull_m: f64,
    /// How far that wanders, m.
    pub pull_spread_m: f64,
    /// How far the reference wanders along the motion and in the plane, m.
    pub wander_m: f64,
    /// Amplitude of the tremor, m.
    pub tremor_m: f64,
    /// Its frequency, Hz.
    pub tremor_hz: f64,
    /// How much of an error is corrected, after a reaction time.
    pub correction: f64,
    /// Reaction time, ms.
    pub reaction_ms: usize,
}

/// Where the reference is beside the plan: outward, along, to the right, up (m).
type Offsets = [f64; 4];

/// The operator at work.
pub struct Hand {
    habits: Habits,
    plan: Plan,
    radius_m: f64,
    /// Where the plan has come to, rad since the beginning.
    planned: f64,
    speed: f64,
    slow: [Coloured; 4],
    smooth: Offsets,
    shaking: [Coloured; 2],
    from: Offsets,
    to: Offsets,
    seen: Vec<f64>,
    correction: f64,
    next_thought_s: f64,
    chance: Chance,
}

/// Force of the hand on the handle, N. Along the motion it falls with the speed at the end of the step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pull {
    /// Along the motion if the handle stood still.
    pub along_n: f64,
    /// What a speed takes from that, N s/m.
    pub per_speed: f64,
    /// Across the motion (outward for a crank).
    pub across_n: f64,
}

impl Hand {
    /// A person who follows `plan`.
    pub fn new(habits: Habits, plan: Plan, radius_m: f64, seed: u64) -> Self {
        let mut chance = Chance::new(seed, 2);
        let slow = [0.7, 0.5, 0.9, 0.9].map(|memory| Coloured::running(memory, 0.0, THOUGHT_S, &mut chance));
        let shaking = [(); 2].map(|()| Coloured::running(0.6, habits.tremor_hz, THOUGHT_S, &mut chance));
        Self {
            habits,
            plan,
            radius_m,
            planned: 0.0,
            speed: 0.0,
            slow,
            smooth: [0.0; 4],
            shaking,
            from: [0.0; 4],
            to: [0.0; 4],
            seen: vec![0.0; habits.reaction_ms.max(1)],
            correction: 0.0,
            next_thought_s: 0.0,
            chance,
        }
    }

    /// Thinks, when it is time: `turned` is where the handle is, rad since the beginning.
    pub fn think(&mut self, time_s: f64, turned: f64) {
        if time_s < self.next_thought_s {
            return;
        }
        self.next_thought_s += THOUGHT_S;
        let count = (self.next_thought_s / THOUGHT_S) as usize % self.seen.len();
        let seen = std::mem::replace(&mut self.seen[count], self.planned - turned);
        self.correction += THOUGHT_S / 0.4 * (self.habits.correction * seen.clamp(-0.5, 0.5) - self.correction);
        let h = self.habits;
        // Who means to pull so hard does not let it wander as much.
        let meant = self.plan.pull_n(time_s).map(|n| n / h.stiffness);
        let pull_spread_m = if meant.is_some() { 0.3 * h.pull_spread_m } else { h.pull_spread_m };
        let spread = [pull_spread_m, h.wander_m, h.wander_m, h.wander_m];
        self.from = self.to;
        for (k, spread) in spread.into_iter().enumerate() {
            // Twice smoothed: muscles do not jump. The second smoothing halves the variance, about.
            let raw = self.slow[k].next(&mut self.chance);
            self.smooth[k] += THOUGHT_S / 0.12 * (raw - self.smooth[k]);
            self.to[k] = 1.1 * spread * self.smooth[k];
        }
        self.to[0] += meant.unwrap_or(h.pull_m) + h.tremor_m * self.shaking[0].next(&mut self.chance);
        self.to[1] += h.tremor_m * self.shaking[1].next(&mut self.chance);
    }

    /// Moves the plan on by a step.
    pub fn advance(&mut self, time_s: f64, step_s: f64) {
        self.speed = self.plan.speed(time_s);
        self.planned += self.speed * step_s;
    }

    /// The pull on a handle at `turned` (`circle`: its angle's sine and cosine where it goes round in a circle), held `firmly`
    /// (0 to 1), through a fingertip that takes `softness` (1: none) of the hand's stiffness.
    pub fn pull(
        &self,
        time_s: f64,
        turned: f64,
        circle: Option<(f64, f64)>,
        firmly: f64,
        softness: f64,
        step_s: f64,
    ) -> Pull {
        let x = 1.0 - ((self.next_thought_s - time_s) / THOUGHT_S).clamp(0.0, 1.0);
        let offset: Offsets = std::array::from_fn(|k| self.from[k] + x * (self.to[k] - self.from[k]));
        let lead = (self.planned + self.correction - turned).clamp(-LARGEST_LEAD, LARGEST_LEAD);
        let (stiffness, damping) =
            (firmly * softness * self.habits.stiffness, firmly * softness * softness * self.habits.damping);
        let (along_m, across_m) = match circle {
            Some((sin, cos)) => {
                let reach = self.radius_m + offset[0];
                let (s, c) = lead.sin_cos();
                (
                    reach * s + offset[1] - sin * offset[2] + cos * offset[3],
                    reach * c - self.radius_m + cos * offset[2] + sin * offset[3],
                )
            }
            None => (self.radius_m * lead + offset[1], 0.0),
        };
        Pull {
            along_n: stiffness * along_m + damping * self.radius_m * self.speed,
            per_speed: damping + stiffness * step_s,
            across_n: stiffness * across_m,
        }
    }
}
