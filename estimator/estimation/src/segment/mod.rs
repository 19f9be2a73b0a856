//! Segmentation: the states with their times, and the subtask to which each belongs.
//!
//! Stage 1 is [`foundation::signal::task`]; [`threshold`] chooses thresholds above the noise, [`rules`] is stage 2 (the
//! rules themselves are in task's [`Definition`]). [`markov`] is its refinement, [`subtasks`] is stage 3. The
//! results are plain intervals, the same for every method.

pub mod agreement;
mod align;
pub mod by_hand;
mod each;
pub mod evidence;
mod grasps;
pub mod markov;
pub mod motion;
mod needle;
mod numbers;
pub mod poses;
pub(crate) mod resting;
pub mod rules;
pub mod runs;
pub mod score;
mod segmentation;
mod single_tool;
pub mod slid;
pub mod subtasks;
pub mod threshold;

use foundation::cancellation;
use foundation::estimate::EstimateError;
use foundation::signal::task::{TaskSignals, calmed, is_two_fingered, task_signals, times};
use foundation::signal::wrench::is_payload;
use foundation::tasks::Thresholds;
use foundation::tasks::definition::Definition;
use grasps::Hand;
use haptics::recording::{Recording, Task};
use motion::Motion;
pub use segmentation::{Interval, Method, Segmentation, StatePosterior};

/// The task of a recording: stated, or told from its columns.
pub fn task_of(recording: &Recording, stated: Option<Task>) -> Result<Task, EstimateError> {
    let has = |name: &str| recording.channel(name).is_some();
    if let Some(task) = stated.or(recording.meta.task) {
        return Ok(task);
    }
    if is_payload(recording) {
        return Ok(Task::Payload);
    }
    if has("q_m") || has("q_rad") || (has("x_m") && has("y_m") && !is_two_fingered(recording)) {
        return Ok(Task::Mechanism);
    }
    Err(EstimateError::UnknownTask { recording: recording.name.clone() })
}

/// Segments a recording by qualitative reasoning, all three stages. `given` thresholds replace those chosen from the noise.
pub fn segment(
    recording: &Recording,
    task: Option<Task>,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    segment_by(Method::Threshold, recording, task, given)
}

/// Segments a recording by either method, all three stages. `given` thresholds replace those chosen from the noise; the hidden
/// Markov model starts from them.
pub fn segment_by(
    method: Method,
    recording: &Recording,
    task: Option<Task>,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    let task = Definition::of(recording, task_of(recording, task)?)?;
    cancellation::check()?;
    let found = by_definition(method, recording, &task, given)?;
    let mut found =
        if recording.meta.segments.is_empty() { found } else { by_hand::put(found, recording, &times(recording)) };
    found.score = score::score(recording, &found);
    // It may be kept for the next fit: only a whole one.
    cancellation::check()?;
    Ok(found)
}

fn by_definition(
    method: Method,
    recording: &Recording,
    task: &Definition,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    match task.like {
        Task::BlockStack | Task::Barrel => segment_signals_by(method, &task_signals(recording)?, task, given),
        Task::Crank | Task::Mechanism | Task::Switch | Task::Payload => {
            let mut motion = Motion::of(recording, given, task)?;
            let warnings = std::mem::take(&mut motion.warnings);
            let (time_s, thresholds) = (&motion.time_s, motion.thresholds);
            match method {
                Method::Threshold => {
                    Ok(subtasks::assemble(time_s, &motion.states(task), task, thresholds, warnings, None))
                }
                Method::Hmm => {
                    let decoded = markov::decode(time_s, &evidence::of_motion(&motion, task))?;
                    let by_path = subtasks::assemble(time_s, &decoded.path, task, thresholds, warnings, None);
                    Ok(decoded.into_segmentation(by_path))
                }
            }
        }
        Task::Needle => needles(method, recording, task, given),
    }
}

fn needles(
    method: Method,
    recording: &Recording,
    task: &Definition,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    let time_s = times(recording);
    if method == Method::Hmm
        && let Some((evidence, thresholds)) = needle::evidence(recording, &time_s, task, given)?
    {
        let decoded = markov::decode(&time_s, &evidence)?;
        let by_path = subtasks::assemble(&time_s, &decoded.path, task, thresholds, Vec::new(), None);
        return Ok(decoded.into_segmentation(by_path));
    }
    let raw = needle::states(&time_s, &needle::phases(recording)?, |phase| task.state_of_phase(phase));
    // Strokes are told from turning points and peaks, not by thresholds.
    let thresholds = task.thresholds(given, || Thresholds { velocity_m_s: 0.0, force_n: 0.0 });
    Ok(subtasks::assemble(&time_s, &raw, task, thresholds, Vec::new(), None))
}

/// Stages 2 and 3 on the task signals of blocks, by the rules of the built-in task.
pub fn segment_signals(
    signals: &TaskSignals,
    task: Task,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    segment_signals_by(Method::Threshold, signals, &Definition::built_in(task)?, given)
}

/// Stages 2 and 3 on the task signals of blocks, by either method.
pub fn segment_signals_by(
    method: Method,
    signals: &TaskSignals,
    task: &Definition,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    if signals.len() < runs::LEAST_SAMPLES {
        return Err(EstimateError::TooFewSamples {
            recording: "the recording".to_owned(),
            samples: signals.len(),
            what: " for a segmentation".to_owned(),
            needed: runs::LEAST_SAMPLES,
        });
    }
    let calm = calmed(signals);
    let levels = threshold::Levels::of(&calm);
    let thresholds = task.thresholds(given, || threshold::choose(&calm, &levels));
    let (time_s, warnings) = (&signals.time_s, levels.warnings());
    let bias_n = levels.bias_n[0].y + levels.bias_n[1].y;
    let lift_n: Vec<f64> = calm.net_force_n.iter().map(|force| force.y - bias_n).collect();
    let hand = Hand { position: &signals.position, width_m: &signals.grip_width_m, lift_n: &lift_n };
    match method {
        Method::Threshold => {
            let quality = rules::qualify(&calm, &levels, &thresholds, task.thresholds.leave);
            let mut raw = rules::states(&quality, &task.rules());
            slid::put_down(&calm, &thresholds, &mut raw);
            Ok(subtasks::assemble(time_s, &raw, task, thresholds, warnings, Some(&hand)))
        }
        Method::Hmm => {
            let mut decoded = markov::decode(time_s, &evidence::of_blocks(&calm, &levels, &thresholds, task))?;
            slid::put_down(&calm, &thresholds, &mut decoded.path);
            let by_path = subtasks::assemble(time_s, &decoded.path, task, thresholds, warnings, Some(&hand));
            Ok(decoded.into_segmentation(by_path))
        }
    }
}
