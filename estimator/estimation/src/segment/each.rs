//! Stage 3 without an expected order: whenever a state of a step lasts, it is the next occurrence of that step.

use super::runs::{LEAST_RUN_S, interval, majority, runs_of};
use super::segmentation::Segmentation;
use foundation::tasks::definition::{Definition, Step};
use foundation::tasks::{SystemState, Thresholds};

/// Intervals of equal state from the state of every sample.
pub fn assemble(
    time_s: &[f64],
    raw: &[SystemState],
    steps: &[Step],
    task: &Definition,
    thresholds: Thresholds,
    warnings: Vec<String>,
) -> Segmentation {
    let smooth = majority(time_s, raw);
    let mut seen = vec![0; steps.len()];
    let states = runs_of(time_s, &smooth)
        .iter()
        .map(|run| {
            let lasts = run.length >= LEAST_RUN_S && run.end - run.first > 1;
            let step = steps.iter().position(|step| lasts && step.state == run.state);
            let name = step.map(|step| {
                seen[step] += 1;
                steps[step].numbered(seen[step]).name
            });
            interval(time_s, raw, run, name)
        })
        .collect();
    Segmentation::by_rules(task, states, thresholds, warnings)
}
