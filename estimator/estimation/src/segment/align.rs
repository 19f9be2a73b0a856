//! Stage 3's alignment: observed runs of states against the expected order of subtasks, by dynamic programming.

use super::grasps::Next;
use super::runs::Run;
use foundation::tasks::SystemState;
use foundation::tasks::definition::Subtask;

/// Price of a step that was not seen (a block dropped before it was put down), as a share of the recording's length.
const MISSED_PENALTY: f64 = 0.01;
/// Price of a failed attempt: an object was gripped, let go, and gripped again.
const RETRY_PENALTY: f64 = 0.005;
/// Price of a step that the places of two grasps contradict.
const CONTRADICTED_PENALTY: f64 = 0.05;

/// Cost per unit of time of being in `seen` while `expected` should hold.
fn mismatch(seen: SystemState, expected: SystemState) -> f64 {
    match seen {
        _ if seen == expected => 0.0,
        // No rule matched: little is said against any state.
        SystemState::NoState => 0.4,
        SystemState::SlidingOnGround if expected == SystemState::HoldOnGround => 0.2,
        _ => 1.0,
    }
}

/// The order, with the permitted transitions.
struct Order<'a> {
    steps: &'a [Subtask],
    /// The step before the first one of the same object: where a failed attempt begins again.
    home: Vec<Option<usize>>,
    /// True if an attempt may begin again from here or from an earlier step of the same object.
    retry: Vec<bool>,
    total: f64,
}

impl<'a> Order<'a> {
    fn of(steps: &'a [Subtask], total: f64) -> Self {
        let first = |step: usize| (0..=step).rev().take_while(|s| steps[*s].object == steps[step].object).last();
        let home = (0..steps.len()).map(|step| first(step)?.checked_sub(1)).collect();
        let is_last = |step: usize| steps.get(step + 1).is_none_or(|next| next.object != steps[step].object);
        let begun = |step: usize| steps[first(step).unwrap_or(step)..=step].iter().any(|s| s.retry);
        let retry = (0..steps.len()).map(|step| begun(step) && !is_last(step)).collect();
        Self { steps, home, retry, total }
    }

    /// The steps that may come before `step` at a run of which `next` is known, with the price of going on from there.
    fn sources(&self, step: usize, next: Option<Next>) -> impl Iterator<Item = (usize, f64)> {
        let held = |from: usize| self.steps[from].state != SystemState::FreeMotion;
        let against = CONTRADICTED_PENALTY * self.total;
        let on = (0..=2_usize).filter_map(move |by| Some((by, step.checked_sub(by)?))).map(move |(by, from)| {
            let missed = if by == 2 { MISSED_PENALTY * self.total } else { 0.0 };
            let lost = by > 0 && held(from) && next == Some(Next::Again);
            (from, missed + if lost { against } else { 0.0 })
        });
        let back = (step + 1..self.steps.len()).take_while(move |from| *from <= step + MOST_BACK);
        let back = back.filter(move |from| self.home[*from] == Some(step)).filter_map(move |from| {
            let allowed = match next {
                Some(Next::Again) => self.retry[from],
                // The order alone: from where the task says so.
                _ => self.steps[from].retry,
            };
            let other = if next == Some(Next::Other) { against } else { 0.0 };
            allowed.then_some((from, RETRY_PENALTY * self.total + other))
        });
        on.chain(back)
    }

    /// Price of ending in a step: those that are left were missed.
    fn ending(&self, step: usize) -> f64 {
        let left = self.steps.len() - 1 - step;
        let same = self.steps[step].object == self.steps[self.steps.len() - 1].object;
        if left == 0 || same { MISSED_PENALTY * self.total * left as f64 } else { f64::INFINITY }
    }
}

/// Steps of one object at most.
const MOST_BACK: usize = 32;

/// Assigns every run to a step of the order. Steps never go back, but for a failed attempt (to before the object's
/// first step), and a step may be missed at a price. `next` states for free motion the evidence of the grasps around
/// it. Returns the total mismatch (time) and the step of every run; `None` if there are too few runs.
pub(super) fn align(runs: &[Run], order: &[Subtask], next: &[Option<Next>]) -> Option<(f64, Vec<usize>)> {
    let (n, k) = (runs.len(), order.len());
    if n == 0 || k == 0 {
        return None;
    }
    let order = Order::of(order, runs.iter().map(|run| run.length).sum());
    let mut cost = vec![f64::INFINITY; k];
    let mut came_from = vec![0_usize; n * k];
    cost[0] = mismatch(runs[0].state, order.steps[0].state) * runs[0].length;
    for (i, run) in runs.iter().enumerate().skip(1) {
        let before = cost.clone();
        for step in 0..k {
            let here = mismatch(run.state, order.steps[step].state) * run.length;
            let sources = order.sources(step, next.get(i).copied().flatten());
            let best = sources.map(|(from, price)| (before[from] + price, from)).min_by(|a, b| a.0.total_cmp(&b.0))?;
            came_from[i * k + step] = best.1;
            cost[step] = best.0 + here;
        }
    }
    let (best, last) = (0..k).map(|step| (cost[step] + order.ending(step), step)).min_by(|a, b| a.0.total_cmp(&b.0))?;
    let mut steps = vec![0; n];
    let mut step = last;
    for i in (0..n).rev() {
        steps[i] = step;
        step = came_from[i * k + step];
    }
    best.is_finite().then_some((best, steps))
}

/// Runs of attempts at an object after which it was begun again: the last attempt alone is the subtask. And how many failed.
pub(super) fn failed_attempts(steps: &[usize], order: &[Subtask]) -> (Vec<bool>, usize) {
    let mut failed = vec![false; steps.len()];
    let mut tries = 0;
    for i in 1..steps.len() {
        if steps[i] < steps[i - 1] {
            tries += 1;
            let object = order[steps[i - 1]].object;
            for (failed, step) in failed[..i].iter_mut().zip(steps) {
                *failed |= order[*step].object == object && *step > steps[i];
            }
        }
    }
    (failed, tries)
}
