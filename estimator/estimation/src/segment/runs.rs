//! Runs of equal states: smoothing, shortest lengths, and the intervals that runs become.

use super::segmentation::Interval;
use foundation::tasks::SystemState;

/// Fewer samples than this are no recording of a task.
pub const LEAST_SAMPLES: usize = 20;

/// States are smoothed by majority over this time: shorter flicker is an oscillation of the contact.
const MAJORITY_S: f64 = 0.06;

/// A run that is shorter enters no estimate.
pub(super) const LEAST_RUN_S: f64 = 0.08;

/// A gap without a state that is shorter is the transition between its neighbours, s.
pub(super) const ISLAND_S: f64 = 0.1;

/// A run of equal states.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Run {
    pub(super) state: SystemState,
    pub(super) first: usize,
    pub(super) end: usize,
    /// s, or samples for a clockless log.
    pub(super) length: f64,
}

fn end_time(time_s: &[f64], end: usize) -> f64 {
    match time_s.get(end) {
        Some(t) => *t,
        None => time_s.last().copied().unwrap_or(0.0),
    }
}

pub(super) fn interval(time_s: &[f64], raw: &[SystemState], run: &Run, subtask: Option<String>) -> Interval {
    let agreeing = raw[run.first..run.end].iter().filter(|s| **s == run.state).count();
    Interval {
        t0: time_s[run.first],
        t1: end_time(time_s, run.end),
        state: run.state,
        subtask,
        probability: agreeing as f64 / (run.end - run.first) as f64,
        first: run.first,
        end: run.end,
    }
}

pub(super) fn runs_of(time_s: &[f64], states: &[SystemState]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (i, state) in states.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if run.state == *state => run.end = i + 1,
            _ => runs.push(Run { state: *state, first: i, end: i + 1, length: 0.0 }),
        }
    }
    for run in &mut runs {
        run.length = end_time(time_s, run.end) - time_s[run.first];
    }
    runs
}

/// Number of states.
const STATES: usize = 10;

/// The most frequent state in a window about every sample; a tie keeps the sample's own.
pub(super) fn majority(time_s: &[f64], raw: &[SystemState]) -> Vec<SystemState> {
    let n = raw.len();
    let step = (time_s[n - 1] - time_s[0]) / (n - 1).max(1) as f64;
    let half = ((0.5 * MAJORITY_S / step.max(1e-9)).round() as usize).min(n / 20);
    if half == 0 {
        return raw.to_vec();
    }
    let mut counts = [0_u32; STATES];
    for state in &raw[..half.min(n)] {
        counts[*state as usize] += 1;
    }
    let mut smooth = Vec::with_capacity(n);
    for i in 0..n {
        if i + half < n {
            counts[raw[i + half] as usize] += 1;
        }
        if i > half {
            counts[raw[i - half - 1] as usize] -= 1;
        }
        let own = counts[raw[i] as usize];
        let top = *counts.iter().max().unwrap_or(&own);
        let winner = if own == top {
            raw[i]
        } else {
            // The window holds the winner: the sample where its count was raised last.
            let low = i.saturating_sub(half);
            raw[low..(i + half + 1).min(n)].iter().copied().find(|s| counts[*s as usize] == top).unwrap_or(raw[i])
        };
        smooth.push(winner);
    }
    smooth
}

/// Divides short gaps without a state between their neighbours: contact is made and lost in no time, sensors need some.
pub(super) fn without_islands(time_s: &[f64], mut states: Vec<SystemState>) -> Vec<SystemState> {
    let runs = runs_of(time_s, &states);
    for window in runs.windows(3) {
        let [before, gap, after] = window else { continue };
        if gap.state == SystemState::NoState && gap.length <= ISLAND_S {
            let middle = gap.first + (gap.end - gap.first) / 2;
            states[gap.first..middle].fill(before.state);
            states[middle..gap.end].fill(after.state);
        }
    }
    states
}
