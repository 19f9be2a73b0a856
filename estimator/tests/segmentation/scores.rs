//! How well a segmentation agrees with labels.

use estimator::segment::{Segmentation, SystemState};
use haptics::recording::Recording;

/// Labels shorter than this are chatter of the contact and no event of their own, s.
const SHORTEST_S: f64 = 0.1;
/// A boundary that is farther off was not found, s.
const LARGEST_ERROR_S: f64 = 0.5;

/// Figures of one or several recordings.
#[derive(Clone, Debug, Default)]
pub struct Scores {
    samples: usize,
    right: usize,
    /// Distance of every labelled boundary from the one that was found, s.
    boundaries_s: Vec<f64>,
    found: usize,
    claimed: usize,
    labelled: usize,
    /// Segmentations whose subtasks came in the expected order.
    pub in_order: usize,
    /// Segmentations.
    pub recordings: usize,
}

type Span = (SystemState, f64, f64);

fn state(label: &str) -> SystemState {
    use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround, NoState, SlidingOnGround, Turning};
    let known = [FreeMotion, HoldAboveGround, HoldOnGround, SlidingOnGround, Turning];
    known.into_iter().find(|s| s.name() == label).unwrap_or(NoState)
}

/// Equal neighbours together; short ones go to the one before.
fn spans(time_s: &[f64], states: &[SystemState], shortest_s: f64) -> Vec<Span> {
    let end = |i: usize| time_s.get(i).copied().unwrap_or(time_s[time_s.len() - 1]);
    let mut runs: Vec<Span> = Vec::new();
    for (i, state) in states.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if run.0 == *state => run.2 = end(i + 1),
            _ => runs.push((*state, time_s[i], end(i + 1))),
        }
    }
    let mut merged: Vec<Span> = Vec::new();
    for run in runs {
        match merged.last_mut() {
            Some(last) if last.0 == run.0 || run.2 - run.1 < shortest_s => last.2 = run.2,
            _ => merged.push(run),
        }
    }
    merged
}

impl Scores {
    /// Adds a recording and what a method made of it. `as_one` maps states that the labels do not tell apart.
    pub fn add(&mut self, recording: &Recording, found: &Segmentation, as_one: fn(SystemState) -> SystemState) {
        let labels = recording.labels.as_ref().expect("a generated recording has labels");
        let time_s = recording.time_s.as_ref().expect("a clock");
        let truth: Vec<SystemState> = labels.iter().map(state).collect();
        let claims: Vec<SystemState> = found.per_sample(truth.len()).into_iter().map(as_one).collect();
        self.samples += truth.len();
        self.right += truth.iter().zip(&claims).filter(|(a, b)| a == b).count();
        let truth = spans(time_s, &truth, SHORTEST_S);
        let claims = spans(time_s, &claims, 0.0);
        for pair in truth.windows(2) {
            let near = claims.windows(2).filter(|c| c[1].0 == pair[1].0).map(|c| (c[1].1 - pair[1].1).abs());
            self.boundaries_s.push(near.fold(LARGEST_ERROR_S, f64::min));
        }
        // Samples without a state are no claim and no event.
        let real = |s: &&Span| s.0 != SystemState::NoState;
        self.labelled += truth.iter().filter(real).count();
        self.claimed += claims.iter().filter(real).count();
        let overlap = |a: &Span, b: &Span| {
            let both = (a.2.min(b.2) - a.1.max(b.1)).max(0.0);
            both / ((a.2 - a.1) + (b.2 - b.1) - both).max(1e-12)
        };
        let matched = |t: &&Span| claims.iter().any(|c| c.0 == t.0 && overlap(c, t) > 0.5);
        self.found += truth.iter().filter(real).filter(matched).count();
        self.recordings += 1;
    }

    /// Share of the samples that have their label's state.
    pub fn accuracy(&self) -> f64 {
        self.right as f64 / self.samples.max(1) as f64
    }

    /// F1 of intervals, found when they share more than half of their union.
    pub fn f1(&self) -> f64 {
        2.0 * self.found as f64 / (self.claimed + self.labelled).max(1) as f64
    }

    /// The boundary error that a share of the boundaries stays below, s.
    pub fn boundary_s(&self, share: f64) -> f64 {
        let mut sorted = self.boundaries_s.clone();
        sorted.sort_by(f64::total_cmp);
        sorted.get(((sorted.len().max(1) - 1) as f64 * share).round() as usize).copied().unwrap_or(0.0)
    }

    /// Adds the figures of others.
    pub fn join(&mut self, other: &Self) {
        self.samples += other.samples;
        self.right += other.right;
        self.boundaries_s.extend(&other.boundaries_s);
        self.found += other.found;
        self.claimed += other.claimed;
        self.labelled += other.labelled;
        self.in_order += other.in_order;
        self.recordings += other.recordings;
    }
}
