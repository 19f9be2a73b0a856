//! Stage 3: states in their expected order become subtasks (thesis, chapter 3.2 and 5.2.2).
//!
//! The expected order is aligned with the observed runs of states by dynamic programming, so that a flicker, a missed sample
//! or an oscillation at touch-down cannot shift everything after it.

use super::threshold::{Levels, Thresholds, choose, percentile};
use super::{Interval, Segmentation, SystemState};
use crate::estimate::EstimateError;
use crate::signal::task::{TaskSignals, TipSeries, calmed, is_two_fingered, task_signals, times, tip_series};
use haptics::Vec2;
use haptics::recording::{Recording, Task};

/// Fewer samples than this are no recording of a task.
pub const LEAST_SAMPLES: usize = 20;

/// States are smoothed by majority over this time: shorter flicker is an oscillation of the contact.
const MAJORITY_S: f64 = 0.06;
/// A run that is shorter enters no estimate.
const LEAST_RUN_S: f64 = 0.08;
/// Most objects carried in one recording.
pub const MOST_CARRIES: usize = 8;
/// What one more carry must explain, as a share of the recording's length.
const CARRY_PENALTY: f64 = 0.015;

/// The recording may start as late as with the first placing; each step left out costs a little of its length.
const LATEST_START: usize = 3;
const START_PENALTY: f64 = 0.005;
/// Price of a step that was not seen (a block dropped before it was put down), as a share of the recording's length.
const MISSED_PENALTY: f64 = 0.01;
/// A gap without a state that is shorter is the transition between its neighbours, s.
const ISLAND_S: f64 = 0.1;

/// A step of the task: its name and the state the system is then in.
#[derive(Clone, Debug, PartialEq)]
pub struct Subtask {
    /// E.g. `carry-block-1`.
    pub name: String,
    /// The state that holds.
    pub state: SystemState,
}

/// The expected order for `carries` objects that are picked up, carried and placed one after the other.
pub fn expected_order(task: Task, carries: usize) -> Vec<Subtask> {
    let object = if task == Task::Barrel { "barrel" } else { "block" };
    let subtask = |verb: &str, number: usize, state| Subtask { name: format!("{verb}-{object}-{number}"), state };
    let mut order = vec![subtask("pregrasp", 1, SystemState::FreeMotion)];
    for number in 1..=carries {
        order.push(subtask("pick-up", number, SystemState::HoldOnGround));
        order.push(subtask("carry", number, SystemState::HoldAboveGround));
        order.push(subtask("place", number, SystemState::HoldOnGround));
        order.push(subtask("release", number, SystemState::FreeMotion));
    }
    order
}

/// Intervals of equal state with their subtasks, from the state of every sample.
pub fn assemble(
    time_s: &[f64],
    raw: &[SystemState],
    task: Task,
    thresholds: Thresholds,
    mut warnings: Vec<String>,
) -> Segmentation {
    let smooth = without_islands(time_s, majority(time_s, raw));
    let runs = runs_of(time_s, &smooth);
    let total = runs.iter().map(|r| r.length).sum::<f64>();
    let best = (0..=MOST_CARRIES)
        .flat_map(|carries| (0..=LATEST_START.min(4 * carries)).map(move |start| (carries, start)))
        .filter_map(|(carries, start)| {
            let order = expected_order(task, carries).split_off(start);
            let (cost, steps) = align(&runs, &order)?;
            let price = CARRY_PENALTY * carries as f64 + START_PENALTY * start as f64;
            Some((cost + price * total, order, steps))
        })
        .min_by(|a, b| a.0.total_cmp(&b.0));
    let (order, steps) = match best {
        Some((_, order, steps)) => (order, steps),
        None => (expected_order(task, 0), vec![0; runs.len()]),
    };
    let states = runs
        .iter()
        .zip(&steps)
        .map(|(run, step)| {
            let subtask = &order[*step];
            let long_enough =
                run.length >= LEAST_RUN_S.min(3.0 * total / time_s.len() as f64) && run.end - run.first > 1;
            let belongs = run.state == subtask.state && long_enough;
            interval(time_s, raw, run, belongs.then(|| subtask.name.clone()))
        })
        .collect::<Vec<_>>();
    if order[0].name != expected_order(task, 0)[0].name {
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
    if order.len() == 1 {
        warnings.push("no object was picked up in this recording".to_owned());
    }
    Segmentation { method: "threshold".to_owned(), task: task.name().to_owned(), states, thresholds, warnings }
}

/// A run of equal states.
#[derive(Clone, Debug, PartialEq)]
struct Run {
    state: SystemState,
    first: usize,
    end: usize,
    /// s, or samples for a clockless log.
    length: f64,
}

fn end_time(time_s: &[f64], end: usize) -> f64 {
    match time_s.get(end) {
        Some(t) => *t,
        None => time_s.last().copied().unwrap_or(0.0),
    }
}

fn interval(time_s: &[f64], raw: &[SystemState], run: &Run, subtask: Option<String>) -> Interval {
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

fn runs_of(time_s: &[f64], states: &[SystemState]) -> Vec<Run> {
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
const STATES: usize = 7;

/// The most frequent state in a window about every sample; a tie keeps the sample's own.
fn majority(time_s: &[f64], raw: &[SystemState]) -> Vec<SystemState> {
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

/// Assigns every run to a step of the order: steps never go back, and a step may be missed at a price. Returns the total
/// mismatch (time) and the step of every run; `None` when there are too few runs.
fn align(runs: &[Run], order: &[Subtask]) -> Option<(f64, Vec<usize>)> {
    let (n, k) = (runs.len(), order.len());
    if n == 0 {
        return None;
    }
    let total: f64 = runs.iter().map(|run| run.length).sum();
    // By how many steps the alignment went on, and what that costs.
    let moves = [(0, 0.0), (1, 0.0), (2, MISSED_PENALTY * total)];
    let mut cost = vec![f64::INFINITY; k];
    let mut advanced = vec![0_u8; n * k];
    cost[0] = mismatch(runs[0].state, order[0].state) * runs[0].length;
    for (i, run) in runs.iter().enumerate().skip(1) {
        // From the last step down, so that every step still sees its predecessors' costs of the run before.
        for step in (0..k).rev() {
            let here = mismatch(run.state, order[step].state) * run.length;
            let best = moves
                .iter()
                .filter(|(by, _)| *by <= step)
                .map(|(by, price)| (cost[step - by] + price, *by))
                .min_by(|a, b| a.0.total_cmp(&b.0))?;
            advanced[i * k + step] = best.1 as u8;
            cost[step] = best.0 + here;
        }
    }
    let mut steps = vec![0; n];
    let mut step = k - 1;
    for i in (0..n).rev() {
        steps[i] = step;
        step -= usize::from(advanced[i * k + step]);
    }
    cost[k - 1].is_finite().then_some((cost[k - 1], steps))
}

/// Segments a crank or mechanism: not touched, held still, moved.
pub fn segment_motion(
    recording: &Recording,
    task: Task,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    let time_s = times(recording);
    if time_s.len() < LEAST_SAMPLES {
        return Err(EstimateError::TooFewSamples {
            recording: recording.name.clone(),
            samples: time_s.len(),
            what: " for a segmentation".to_owned(),
            needed: LEAST_SAMPLES,
        });
    }
    let (speed, load, thresholds, warnings) = if is_two_fingered(recording) {
        let signals = calmed(&task_signals(recording)?);
        let levels = Levels::of(&signals);
        let thresholds = given.unwrap_or_else(|| choose(&signals, &levels));
        let grip = grip_without_bias(&signals, &levels);
        let speed: Vec<f64> = signals.velocity.iter().map(Vec2::norm).collect();
        (speed, Some(grip), thresholds, levels.warnings())
    } else {
        single_tool(recording, given)?
    };
    let raw: Vec<SystemState> = (0..time_s.len())
        .map(|i| match &load {
            Some(load) if load[i] <= thresholds.force_n => SystemState::FreeMotion,
            _ if speed[i] > thresholds.velocity_m_s => SystemState::Turning,
            _ => SystemState::Holding,
        })
        .collect();
    let smooth = majority(&time_s, &raw);
    let mut turns = 0;
    let states = runs_of(&time_s, &smooth)
        .iter()
        .map(|run| {
            let moves = run.state == SystemState::Turning && run.length >= LEAST_RUN_S && run.end - run.first > 1;
            turns += usize::from(moves);
            interval(&time_s, &raw, run, moves.then(|| format!("turn-{turns}")))
        })
        .collect();
    Ok(Segmentation { method: "threshold".to_owned(), task: task.name().to_owned(), states, thresholds, warnings })
}

fn grip_without_bias(signals: &TaskSignals, levels: &Levels) -> Vec<f64> {
    let x =
        |finger: usize, i: usize| signals.tips[finger].force.as_ref().map_or(0.0, |f| f[i].x) - levels.bias_n[finger].x;
    (0..signals.len()).map(|i| x(0, i).min(-x(1, i))).collect()
}

type MotionSignals = (Vec<f64>, Option<Vec<f64>>, Thresholds, Vec<String>);

/// Speed and load of a single tool, or of a mechanism's coordinate.
fn single_tool(recording: &Recording, given: Option<Thresholds>) -> Result<MotionSignals, EstimateError> {
    let coordinate = ["q_m", "q_rad"].into_iter().find_map(|name| recording.channel(name));
    let clockless =
        || EstimateError::Clockless { what: "telling rest from motion".to_owned(), recording: recording.name.clone() };
    let (speed, load) = if let Some(q) = coordinate {
        let measured = recording.channel("dq_m_s").or_else(|| recording.channel("dq_rad_s"));
        let rate = if let Some(rate) = measured {
            rate.to_vec()
        } else {
            let time = recording.time_s.as_ref().ok_or_else(clockless)?;
            crate::signal::task::smooth(time, q).slope
        };
        (rate.iter().map(|v| v.abs()).collect::<Vec<_>>(), None)
    } else {
        let TipSeries { velocity, force, .. } = tip_series(recording, "")?;
        let velocity = velocity.ok_or_else(clockless)?;
        let load = force.map(|f| f.iter().map(Vec2::norm).collect::<Vec<_>>());
        (velocity.iter().map(Vec2::norm).collect(), load)
    };
    let usual = percentile(&mut speed.clone(), 0.95);
    let usual_load = load.as_ref().map_or(0.0, |l| percentile(&mut l.clone(), 0.95));
    let thresholds = given.unwrap_or(Thresholds { velocity_m_s: 0.1 * usual, force_n: 0.05 * usual_load });
    Ok((speed, load, thresholds, Vec::new()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use SystemState::{FreeMotion, HoldAboveGround, HoldOnGround, NoState};

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
        let result = assemble(&time, &states, Task::BlockStack, THRESHOLDS, Vec::new());
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
        let result = assemble(&time, &states, Task::BlockStack, THRESHOLDS, Vec::new());
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
        let result = assemble(&time, &states, Task::BlockStack, THRESHOLDS, Vec::new());
        assert_eq!(result.samples_of("carry-block-1").len(), 180);
        assert_eq!(result.samples_of("carry-block-2").len(), 134);
        assert!(result.warnings.iter().any(|w| w.contains("place-block-1")), "{:?}", result.warnings);
    }

    #[test]
    fn a_recording_that_starts_while_holding_says_so() {
        let (time, states) =
            trace(&[(HoldOnGround, 60), (HoldAboveGround, 200), (HoldOnGround, 60), (FreeMotion, 100)]);
        let result = assemble(&time, &states, Task::BlockStack, THRESHOLDS, Vec::new());
        assert_eq!(result.samples_of("carry-block-1").len(), 180);
        assert!(result.warnings.iter().any(|w| w.contains("starts in the middle")), "{:?}", result.warnings);
    }

    #[test]
    fn nothing_held_is_no_carry() {
        let (time, states) = trace(&[(FreeMotion, 500)]);
        let result = assemble(&time, &states, Task::BlockStack, THRESHOLDS, Vec::new());
        assert_eq!(result.sequence(), "1");
        assert!(result.warnings.iter().any(|w| w.contains("no object")));
    }
}
