//! Segmentation: which state held when, and to which subtask it belongs.
//!
//! Stage 1 is [`crate::signal::task`]; [`threshold`] chooses thresholds above the noise, [`rules`] is stage 2 (the rules
//! themselves are in the task's [`definition`]) and [`markov`] is its refinement, [`subtasks`] is stage 3. The results are plain intervals, the same for every method.

mod align;
pub mod by_hand;
mod check;
pub mod definition;
mod each;
pub mod evidence;
mod grasps;
pub mod library;
pub mod markov;
pub mod motion;
mod needle;
mod numbers;
pub(crate) mod resting;
pub mod rules;
pub mod score;
pub mod shows;
pub(crate) mod slid;
mod state;
pub mod subtasks;
pub mod threshold;

use crate::cancellation;
use crate::estimate::EstimateError;
use crate::signal::task::{TaskSignals, calmed, is_two_fingered, task_signals, times};
use definition::Definition;
use grasps::Hand;
use haptics::recording::{Recording, Task};
use motion::Motion;
use schemars::JsonSchema;
use score::Score;
use serde::{Deserialize, Serialize};
pub use state::SystemState;
use std::collections::BTreeMap;
pub use threshold::Thresholds;

/// One interval in one state.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Interval {
    /// Start, s (sample number when the log is clockless).
    pub t0: f64,
    /// End, s.
    pub t1: f64,
    /// The state.
    pub state: SystemState,
    /// The subtask it belongs to, when the expected order gives it one.
    pub subtask: Option<String>,
    /// By thresholds: share of the interval's samples that show this state by themselves, before smoothing. By the hidden Markov
    /// model: mean probability of the state over the interval, given the whole recording.
    pub probability: f64,
    /// First sample.
    #[serde(skip)]
    pub first: usize,
    /// One past the last sample.
    #[serde(skip)]
    pub end: usize,
}

/// The answer of a segmentation; serialises to `segment --json`.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Segmentation {
    /// `threshold` or `hmm`.
    pub method: String,
    /// The task it was read as.
    pub task: String,
    /// Intervals in order, without holes.
    pub states: Vec<Interval>,
    /// The thresholds that were used.
    pub thresholds: Thresholds,
    /// The parameters that each state of the task shows.
    #[serde(default)]
    pub shows: BTreeMap<String, Vec<String>>,
    /// Sentences.
    pub warnings: Vec<String>,
    /// How it agrees with the labels of the recording, where it has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub score: Option<Score>,
    /// Whether a person set the intervals.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub by_hand: bool,
    /// What is known of every sample; only the hidden Markov model says so.
    #[serde(skip)]
    pub posterior: Option<StatePosterior>,
    /// The task itself.
    #[serde(skip)]
    pub definition: Option<Box<Definition>>,
}

/// Probability of every state that the recording shows, at every sample.
#[derive(Clone, Debug, PartialEq)]
pub struct StatePosterior {
    /// The states, in the order of the columns.
    pub states: Vec<SystemState>,
    /// One row of states a sample.
    pub values: Vec<f32>,
}

impl StatePosterior {
    /// Probability of a state at a sample; 0 for a state that the recording never shows.
    pub fn at(&self, sample: usize, state: SystemState) -> f64 {
        let column = self.states.iter().position(|s| *s == state);
        let value = column.and_then(|c| self.values.get(sample * self.states.len() + c));
        value.map_or(0.0, |v| f64::from(*v))
    }

    /// Mean probability of a state over the samples `first..end`.
    fn mean(&self, state: SystemState, first: usize, end: usize) -> f64 {
        (first..end).map(|i| self.at(i, state)).sum::<f64>() / (end - first).max(1) as f64
    }
}

impl Segmentation {
    /// What the rules made of a recording.
    fn by_rules(task: &Definition, states: Vec<Interval>, thresholds: Thresholds, warnings: Vec<String>) -> Self {
        Self {
            method: Method::Threshold.name().to_owned(),
            task: task.name.clone(),
            states,
            thresholds,
            shows: task.shown_by_states(),
            warnings,
            score: None,
            by_hand: false,
            posterior: None,
            definition: Some(Box::new(task.clone())),
        }
    }

    /// The sequence of states that subtasks were assigned to, without repeats, in the thesis's symbols.
    pub fn sequence(&self) -> String {
        let mut symbols: Vec<char> = Vec::new();
        let mut last = None;
        for interval in self.states.iter().filter(|i| i.subtask.is_some()) {
            if last != interval.subtask.as_ref() {
                symbols.push(interval.state.symbol());
                last = interval.subtask.as_ref();
            }
        }
        symbols.into_iter().collect()
    }

    /// Samples that belong to the subtask and show its state, 5 % at each end of every interval left out (thesis, 5.2.3).
    pub fn samples_of(&self, subtask: &str) -> Vec<usize> {
        const END_SHARE: f64 = 0.05;
        let mut samples = Vec::new();
        for interval in self.states.iter().filter(|i| i.subtask.as_deref() == Some(subtask)) {
            let length = interval.end - interval.first;
            let cut = (END_SHARE * length as f64).ceil() as usize;
            if length > 2 * cut {
                samples.extend(interval.first + cut..interval.end - cut);
            }
        }
        samples
    }

    /// The built-in task that it is like.
    pub fn like(&self) -> Option<Task> {
        self.definition.as_ref().map(|task| task.like)
    }

    /// The state at every sample.
    pub fn per_sample(&self, samples: usize) -> Vec<SystemState> {
        let mut states = vec![SystemState::NoState; samples];
        for interval in &self.states {
            states[interval.first..interval.end].fill(interval.state);
        }
        states
    }
}

/// The task of a recording: stated, or told from its columns.
pub fn task_of(recording: &Recording, stated: Option<Task>) -> Result<Task, EstimateError> {
    let has = |name: &str| recording.channel(name).is_some();
    if let Some(task) = stated.or(recording.meta.task) {
        return Ok(task);
    }
    if has("q_m") || has("q_rad") || (has("x_m") && has("y_m") && !is_two_fingered(recording)) {
        return Ok(Task::Mechanism);
    }
    Err(EstimateError::UnknownTask { recording: recording.name.clone() })
}

/// How states are told apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, JsonSchema, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Qualitative reasoning: thresholds and rules.
    #[default]
    Threshold,
    /// A hidden Markov model that starts from the rules' result.
    Hmm,
}

impl Method {
    /// The name used in JSON and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Threshold => "threshold",
            Self::Hmm => "hmm",
        }
    }
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
        Task::Crank | Task::Mechanism | Task::Switch => {
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
    if signals.len() < subtasks::LEAST_SAMPLES {
        return Err(EstimateError::TooFewSamples {
            recording: "the recording".to_owned(),
            samples: signals.len(),
            what: " for a segmentation".to_owned(),
            needed: subtasks::LEAST_SAMPLES,
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
