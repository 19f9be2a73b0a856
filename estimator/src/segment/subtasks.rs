//! Stage 3: states in their expected order become subtasks (thesis, chapter 3.2 and 5.2.2).
//!
//! The expected order is aligned with the observed runs of states by dynamic programming, so that a flicker, a missed sample
//! or an oscillation at touch-down cannot shift everything after it.

use super::align::{align, failed_attempts};
use super::definition::{Definition, Ordered, Subtasks};
use super::grasps::{self, Hand};
use super::threshold::Thresholds;
use super::{Interval, Segmentation, SystemState, each, numbers};

/// Fewer samples than this are no recording of a task.
pub const LEAST_SAMPLES: usize = 20;

/// States are smoothed by majority over this time: shorter flicker is an oscillation of the contact.
const MAJORITY_S: f64 = 0.06;
/// A run that is shorter enters no estimate.
pub(super) const LEAST_RUN_S: f64 = 0.08;
/// Most objects carried in one recording.
pub const MOST_CARRIES: usize = 100;
/// Least share of the recording's length that one more carry must explain.
const CARRY_PENALTY: f64 = 0.015;

/// The recording may start as late as with the first placing; each step left out costs a little of its length.
const LATEST_START: usize = 3;
const START_PENALTY: f64 = 0.005;
/// A gap without a state that is shorter is the transition between its neighbours, s.
pub(super) const ISLAND_S: f64 = 0.1;

/// A step of the task: its name and the state the system is then in.
#[derive(Clone, Debug, PartialEq)]
pub struct Subtask {
    /// E.g. `carry-block-1`.
    pub name: String,
    /// The state that holds.
    pub state: SystemState,
    /// One may have to begin the object again.
    pub retry: bool,
    /// The number of its object, from 1; 0: a step before the first object.
    pub object: usize,
}

/// Intervals of equal state with their subtasks, from the state of every sample. `hand` tells grasps by where they are; without it
/// the order alone numbers the objects.
pub fn assemble(
    time_s: &[f64],
    raw: &[SystemState],
    task: &Definition,
    thresholds: Thresholds,
    mut warnings: Vec<String>,
    hand: Option<&Hand<'_>>,
) -> Segmentation {
    let ordered = match &task.subtasks {
        Subtasks::Ordered(ordered) => ordered,
        Subtasks::Each(steps) => return each::assemble(time_s, raw, &steps.each, task, thresholds, warnings),
    };
    let smooth = without_islands(time_s, majority(time_s, raw));
    let runs = runs_of(time_s, &smooth);
    let grasps = hand.map(|hand| grasps::grasps(time_s, &runs, hand)).unwrap_or_default();
    let next = grasps::between(&runs, &grasps);
    let (order, steps) = best_order(&runs, task, ordered, &next);
    let (failed, tries) = failed_attempts(&steps, &order);
    if tries > 0 {
        warnings.push(format!(
            "an object was gripped and lost again before it was put down (failed attempts: {tries}); only the last attempt counts"
        ));
    }
    let names = numbers::named(&grasps, &steps, &order, failed, &mut warnings);
    let states = runs
        .iter()
        .zip(steps.iter().zip(names))
        .map(|(run, (step, name))| {
            let long_enough = run.length >= LEAST_RUN_S && run.end - run.first > 1;
            let belongs = run.state == order[*step].state && long_enough;
            interval(time_s, raw, run, name.filter(|_| belongs))
        })
        .collect::<Vec<_>>();
    missing(ordered, &order, &states, &mut warnings);
    Segmentation::by_rules(task, states, thresholds, warnings)
}

/// The number of objects and the first step for which the runs agree best with the expected order; the step of every run.
fn best_order(
    runs: &[Run],
    task: &Definition,
    ordered: &Ordered,
    next: &[Option<grasps::Next>],
) -> (Vec<Subtask>, Vec<usize>) {
    let total = runs.iter().map(|r| r.length).sum::<f64>();
    // Alignment leaves out every second step at most.
    let most = ordered.most.min((runs.len() + LATEST_START + 1) * 2 / ordered.repeat.len() + 1);
    let best = (0..=most)
        .flat_map(|carries| (0..=LATEST_START.min(ordered.repeat.len() * carries)).map(move |start| (carries, start)))
        .filter_map(|(carries, start)| {
            let order = task.order(carries).split_off(start);
            let (cost, steps) = align(runs, &order, next)?;
            let price = CARRY_PENALTY * carries as f64 + START_PENALTY * start as f64;
            Some((cost + price * total, order, steps))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0));
    match best {
        Some((_, order, steps)) => (order, steps),
        None => (task.order(0), vec![0; runs.len()]),
    }
}

/// Warns of missing steps of the expected order.
fn missing(ordered: &Ordered, order: &[Subtask], states: &[Interval], warnings: &mut Vec<String>) {
    if ordered.first.first().is_some_and(|first| first.numbered(1).name != order[0].name) {
        warnings.push(format!(
            "the recording starts in the middle of the task, with {}; what came before is missing from the fit",
            order[0].name
        ));
    }
    for subtask in order {
        if !states.iter().any(|i| i.subtask.as_deref() == Some(&subtask.name)) {
            warnings
                .push(format!("the subtask {} was not seen; what it would show is missing from the fit", subtask.name));
        }
    }
    if order.len() == ordered.first.len() {
        warnings.push("no object was picked up in this recording".to_owned());
    }
}

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
fn without_islands(time_s: &[f64], mut states: Vec<SystemState>) -> Vec<SystemState> {
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

#[cfg(test)]
mod tests;
