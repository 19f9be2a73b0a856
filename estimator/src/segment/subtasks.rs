//! Stage 3: states in their expected order become subtasks (thesis, chapter 3.2 and 5.2.2).
//!
//! The expected order is aligned with the observed runs of states by dynamic programming, so that a flicker, a missed sample
//! or an oscillation at touch-down cannot shift everything after it.

use super::align::{align, failed_attempts};
use super::definition::{Definition, Subtasks};
use super::threshold::Thresholds;
use super::{Interval, Method, Segmentation, SystemState, each};

/// Fewer samples than this are no recording of a task.
pub const LEAST_SAMPLES: usize = 20;

/// States are smoothed by majority over this time: shorter flicker is an oscillation of the contact.
const MAJORITY_S: f64 = 0.06;
/// A run that is shorter enters no estimate.
pub(super) const LEAST_RUN_S: f64 = 0.08;
/// Most objects carried in one recording.
pub const MOST_CARRIES: usize = 100;
/// What one more carry must explain, as a share of the recording's length.
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
    /// One may have to begin it again.
    pub retry: bool,
}

/// Intervals of equal state with their subtasks, from the state of every sample.
pub fn assemble(
    time_s: &[f64],
    raw: &[SystemState],
    task: &Definition,
    thresholds: Thresholds,
    mut warnings: Vec<String>,
) -> Segmentation {
    let ordered = match &task.subtasks {
        Subtasks::Ordered(ordered) => ordered,
        Subtasks::Each(steps) => return each::assemble(time_s, raw, &steps.each, task, thresholds, warnings),
    };
    let smooth = without_islands(time_s, majority(time_s, raw));
    let runs = runs_of(time_s, &smooth);
    let total = runs.iter().map(|r| r.length).sum::<f64>();
    // Alignment leaves out every second step at most.
    let most = ordered.most.min((runs.len() + LATEST_START + 1) * 2 / ordered.repeat.len() + 1);
    let best = (0..=most)
        .flat_map(|carries| (0..=LATEST_START.min(ordered.repeat.len() * carries)).map(move |start| (carries, start)))
        .filter_map(|(carries, start)| {
            let order = task.order(carries).split_off(start);
            let (cost, steps) = align(&runs, &order)?;
            let price = CARRY_PENALTY * carries as f64 + START_PENALTY * start as f64;
            Some((cost + price * total, order, steps))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let (order, steps) = match best {
        Some((_, order, steps)) => (order, steps),
        None => (task.order(0), vec![0; runs.len()]),
    };
    let failed = failed_attempts(&steps, &order);
    let tries = failed.windows(2).filter(|pair| pair[0] && !pair[1]).count();
    if tries > 0 {
        warnings.push(format!(
            "an object was gripped and lost again before it was carried (failed attempts: {tries}); only the last attempt counts"
        ));
    }
    let states = runs
        .iter()
        .zip(steps.iter().zip(&failed))
        .map(|(run, (step, failed))| {
            let subtask = &order[*step];
            let long_enough = run.length >= LEAST_RUN_S && run.end - run.first > 1;
            let belongs = run.state == subtask.state && long_enough && !failed;
            interval(time_s, raw, run, belongs.then(|| subtask.name.clone()))
        })
        .collect::<Vec<_>>();
    if ordered.first.first().is_some_and(|first| first.numbered(1).name != order[0].name) {
        warnings.push(format!(
            "the recording starts in the middle of the task, with {}; what came before is missing from the fit",
            order[0].name
        ));
    }
    for subtask in &order {
        if !states.iter().any(|i| i.subtask.as_deref() == Some(&subtask.name)) {
            warnings
                .push(format!("the subtask {} was not seen; what it would show is missing from the fit", subtask.name));
        }
    }
    if order.len() == ordered.first.len() {
        warnings.push("no object was picked up in this recording".to_owned());
    }
    Segmentation {
        method: Method::Threshold.name().to_owned(),
        task: task.name.clone(),
        states,
        thresholds,
        warnings,
        posterior: None,
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
mod tests {
    use super::*;
    use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround, NoState};
    use haptics::recording::Task;

    fn blocks() -> Definition {
        Definition::built_in(Task::BlockStack).expect("the built-in task")
    }

    fn trace(parts: &[(SystemState, usize)]) -> (Vec<f64>, Vec<SystemState>) {
        let states: Vec<SystemState> = parts.iter().flat_map(|(s, n)| std::iter::repeat_n(*s, *n)).collect();
        ((0..states.len()).map(|i| i as f64 * 0.01).collect(), states)
    }

    const THRESHOLDS: Thresholds = Thresholds { velocity_m_s: 0.05, force_n: 0.05 };

    #[test]
    fn two_carries_are_told_apart_by_the_free_motion_between_them() {
        let (time, states) = trace(&[
            (FreeMotion, 100),
            (HoldOnGround, 60),
            (NoState, 3),
            (HoldAboveGround, 200),
            (HoldOnGround, 60),
            (NoState, 20),
            (FreeMotion, 100),
            (HoldOnGround, 60),
            (HoldAboveGround, 200),
            (HoldOnGround, 60),
            (FreeMotion, 100),
        ]);
        let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new());
        assert_eq!(result.sequence(), "132313231");
        assert!(result.warnings.is_empty(), "{:?}", result.warnings);
        let carry_2 = result.samples_of("carry-block-2");
        assert_eq!((carry_2.len(), carry_2[0]), (180, 543 + 60 + 10));
    }

    #[test]
    fn oscillation_at_touch_down_does_not_shift_the_order() {
        let mut parts = vec![(FreeMotion, 100), (HoldOnGround, 50), (HoldAboveGround, 150)];
        for _ in 0..4 {
            parts.extend([(HoldOnGround, 2), (HoldAboveGround, 2)]);
        }
        parts.extend([(HoldOnGround, 60), (FreeMotion, 100)]);
        let (time, states) = trace(&parts);
        let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new());
        assert_eq!(result.sequence(), "13231");
    }

    #[test]
    fn a_dropped_block_keeps_its_number_and_the_missing_step_is_said() {
        let (time, states) = trace(&[
            (FreeMotion, 100),
            (HoldOnGround, 60),
            (HoldAboveGround, 200),
            (FreeMotion, 100),
            (HoldOnGround, 60),
            (HoldAboveGround, 150),
            (HoldOnGround, 60),
            (FreeMotion, 100),
        ]);
        let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new());
        assert_eq!(result.samples_of("carry-block-1").len(), 180);
        assert_eq!(result.samples_of("carry-block-2").len(), 134);
        assert!(result.warnings.iter().any(|w| w.contains("place-block-1")), "{:?}", result.warnings);
    }

    #[test]
    fn a_recording_that_starts_while_holding_says_so() {
        let (time, states) =
            trace(&[(HoldOnGround, 60), (HoldAboveGround, 200), (HoldOnGround, 60), (FreeMotion, 100)]);
        let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new());
        assert_eq!(result.samples_of("carry-block-1").len(), 180);
        assert!(result.warnings.iter().any(|w| w.contains("starts in the middle")), "{:?}", result.warnings);
    }

    #[test]
    fn nothing_held_is_no_carry() {
        let (time, states) = trace(&[(FreeMotion, 500)]);
        let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new());
        assert_eq!(result.sequence(), "1");
        assert!(result.warnings.iter().any(|w| w.contains("no object")));
    }

    #[test]
    fn a_second_try_at_lifting_keeps_the_number_and_only_the_last_grasp_counts() {
        // Gripped and let go; then lifted a little and lost; then carried.
        let (time, states) = trace(&[
            (FreeMotion, 100),
            (HoldOnGround, 60),
            (FreeMotion, 80),
            (HoldOnGround, 50),
            (HoldAboveGround, 12),
            (FreeMotion, 80),
            (HoldOnGround, 60),
            (HoldAboveGround, 200),
            (HoldOnGround, 60),
            (FreeMotion, 100),
            (HoldOnGround, 60),
            (HoldAboveGround, 200),
            (HoldOnGround, 60),
            (FreeMotion, 100),
        ]);
        let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new());
        assert_eq!(result.sequence(), "132313231", "{:?}", result.states);
        let pick_up = result.samples_of("pick-up-block-1");
        assert_eq!((pick_up[0], pick_up.len()), (382 + 3, 54));
        assert!(result.warnings.iter().any(|w| w.contains("failed attempts: 2")), "{:?}", result.warnings);
    }

    #[test]
    fn a_run_too_short_to_be_a_step_gets_no_subtask() {
        let (time, states) = trace(&[
            (FreeMotion, 100),
            (HoldOnGround, 60),
            (HoldAboveGround, 200),
            (HoldOnGround, 7),
            (FreeMotion, 100),
        ]);
        let result = assemble(&time, &states, &blocks(), THRESHOLDS, Vec::new());
        assert!(result.samples_of("place-block-1").is_empty(), "{:?}", result.states);
    }
}
