//! Stage 3's alignment: observed runs of states against the expected order of subtasks, by dynamic programming.

use super::SystemState;
use super::subtasks::{Run, Subtask};

/// Price of a step that was not seen (a block dropped before it was put down), as a share of the recording's length.
const MISSED_PENALTY: f64 = 0.01;
/// Price of a failed attempt: an object was gripped, let go, and gripped again.
const RETRY_PENALTY: f64 = 0.005;
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

/// Assigns every run to a step of the order: steps never go back, but for a failed attempt (from picking up to the free motion
/// before it), and a step may be missed at a price. Returns the total mismatch (time) and the step of every run; `None` when there
/// are too few runs.
pub(super) fn align(runs: &[Run], order: &[Subtask]) -> Option<(f64, Vec<usize>)> {
    let (n, k) = (runs.len(), order.len());
    if n == 0 {
        return None;
    }
    let total: f64 = runs.iter().map(|run| run.length).sum();
    // By how many steps the alignment went on, and what that costs.
    let moves = [(0, 0.0), (1, 0.0), (2, MISSED_PENALTY * total), (-1, RETRY_PENALTY * total)];
    let source = |step: usize, by: isize| {
        let from = step.checked_add_signed(-by).filter(|from| *from < k)?;
        (by >= 0 || order[from].retry).then_some(from)
    };
    let mut cost = vec![f64::INFINITY; k];
    let mut came_from = vec![0_usize; n * k];
    cost[0] = mismatch(runs[0].state, order[0].state) * runs[0].length;
    for (i, run) in runs.iter().enumerate().skip(1) {
        let before = cost.clone();
        for step in 0..k {
            let here = mismatch(run.state, order[step].state) * run.length;
            let best = moves
                .iter()
                .filter_map(|(by, price)| source(step, *by).map(|from| (before[from] + price, from)))
                .min_by(|a, b| a.0.total_cmp(&b.0))?;
            came_from[i * k + step] = best.1;
            cost[step] = best.0 + here;
        }
    }
    let mut steps = vec![0; n];
    let mut step = k - 1;
    for i in (0..n).rev() {
        steps[i] = step;
        step = came_from[i * k + step];
    }
    cost[k - 1].is_finite().then_some((cost[k - 1], steps))
}

/// Runs in which an object was held that was not lifted then: a later attempt, after letting go, has the same step. The last
/// attempt alone is the subtask.
pub(super) fn failed_attempts(steps: &[usize], order: &[Subtask]) -> Vec<bool> {
    let mut tried_again = vec![false; order.len()];
    let mut failed = vec![false; steps.len()];
    for i in (0..steps.len()).rev() {
        let step = steps[i];
        failed[i] = order[step].retry && tried_again[step];
        if i > 0 && order[steps[i - 1]].retry && step + 1 == steps[i - 1] {
            tried_again[steps[i - 1]] = true;
        }
    }
    failed
}
