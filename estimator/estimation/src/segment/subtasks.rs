//! Stage 3: states in their expected order become subtasks (thesis, chapter 3.2 and 5.2.2).
//!
//! The expected order is aligned with the observed runs of states by dynamic programming, so that a flicker, a missed sample
//! or an oscillation at touch-down cannot shift everything after it.

use super::align::{align, failed_attempts};
use super::grasps::{self, Hand};
use super::runs::{LEAST_RUN_S, Run, interval, majority, runs_of, without_islands};
use super::segmentation::{Interval, Segmentation};
use super::{each, numbers};
use foundation::tasks::definition::{Definition, Ordered, Subtask, Subtasks};
use foundation::tasks::{SystemState, Thresholds};

/// Least share of the recording's length that one more carry must explain.
const CARRY_PENALTY: f64 = 0.015;

/// The recording may start as late as with the first placing; each step left out costs a little of its length.
const LATEST_START: usize = 3;
const START_PENALTY: f64 = 0.005;

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

#[cfg(test)]
mod tests;
