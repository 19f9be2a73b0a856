//! Segmentation: which state held when, and to which subtask it belongs.
//!
//! Stage 1 is [`crate::signal::task`]; [`threshold`] chooses thresholds above the noise, [`rules`] is stage 2 (the rules
//! themselves are in the task's [`definition`]) and [`markov`] is its refinement, [`subtasks`] is stage 3. The results are plain intervals, the same for every method.

mod align;
pub mod definition;
mod each;
pub mod evidence;
pub mod markov;
pub mod motion;
mod needle;
pub mod rules;
pub mod subtasks;
pub mod threshold;

use crate::estimate::EstimateError;
use crate::signal::task::{TaskSignals, calmed, is_two_fingered, task_signals, times};
use definition::Definition;
use haptics::recording::{Recording, Task};
use motion::Motion;
use serde::{Deserialize, Serialize};
pub use threshold::Thresholds;

/// Contact configuration of the system.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SystemState {
    /// Nothing is touched.
    FreeMotion,
    /// An object is held and rests on something.
    HoldOnGround,
    /// An object is held in the air.
    HoldAboveGround,
    /// An object is held and slides over what it rests on.
    SlidingOnGround,
    /// A crank or mechanism is moved.
    Turning,
    /// A crank or mechanism is held still.
    Holding,
    /// A needle presses a sheet in.
    Insertion,
    /// A needle goes on through the sheet.
    Penetration,
    /// A needle is drawn out.
    Extraction,
    /// None of the known states: these samples enter no estimate.
    NoState,
}

impl SystemState {
    /// The name used in JSON and in labels.
    pub fn name(self) -> &'static str {
        match self {
            Self::FreeMotion => "free-motion",
            Self::HoldOnGround => "hold-on-ground",
            Self::HoldAboveGround => "hold-above-ground",
            Self::SlidingOnGround => "sliding-on-ground",
            Self::Turning => "turning",
            Self::Holding => "holding",
            Self::Insertion => "insertion",
            Self::Penetration => "penetration",
            Self::Extraction => "extraction",
            Self::NoState => "no-state",
        }
    }

    /// The thesis's symbol in figure 5.5: 1 free motion, 2 hold above ground, 3 hold on ground, x sliding, 0 none.
    pub fn symbol(self) -> char {
        match self {
            Self::FreeMotion => '1',
            Self::HoldAboveGround => '2',
            Self::HoldOnGround => '3',
            Self::SlidingOnGround => 'x',
            Self::Turning => 't',
            Self::Holding => 'h',
            Self::Insertion => 'i',
            Self::Penetration => 'p',
            Self::Extraction => 'e',
            Self::NoState => '0',
        }
    }
}

/// One interval in one state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Segmentation {
    /// `threshold` or `hmm`.
    pub method: String,
    /// The task it was read as.
    pub task: String,
    /// Intervals in order, without holes.
    pub states: Vec<Interval>,
    /// The thresholds that were used.
    pub thresholds: Thresholds,
    /// Sentences.
    pub warnings: Vec<String>,
    /// What is known of every sample; only the hidden Markov model says so.
    #[serde(skip)]
    pub posterior: Option<StatePosterior>,
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
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
    match task.like {
        Task::BlockStack | Task::Barrel => segment_signals_by(method, &task_signals(recording)?, &task, given),
        Task::Crank | Task::Mechanism | Task::Switch => {
            let mut motion = Motion::of(recording, given, &task)?;
            let warnings = std::mem::take(&mut motion.warnings);
            let (time_s, thresholds) = (&motion.time_s, motion.thresholds);
            match method {
                Method::Threshold => Ok(subtasks::assemble(time_s, &motion.states(&task), &task, thresholds, warnings)),
                Method::Hmm => {
                    let decoded = markov::decode(time_s, &evidence::of_motion(&motion, &task))?;
                    let by_path = subtasks::assemble(time_s, &decoded.path, &task, thresholds, warnings);
                    Ok(decoded.into_segmentation(by_path))
                }
            }
        }
        Task::Needle => needles(method, recording, &task, given),
    }
}

fn needles(
    method: Method,
    recording: &Recording,
    task: &Definition,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    if method == Method::Hmm {
        return Err(EstimateError::Other(format!(
            "{} is a needle recording: its phases come from the strokes, for which there is no hidden Markov model; use the method threshold",
            recording.name
        )));
    }
    let time_s = times(recording);
    let raw = needle::states(&time_s, &needle::phases(recording)?, |phase| task.state_of_phase(phase));
    // Strokes are told from turning points and peaks, not by thresholds.
    let thresholds = task.thresholds(given, || Thresholds { velocity_m_s: 0.0, force_n: 0.0 });
    Ok(subtasks::assemble(&time_s, &raw, task, thresholds, Vec::new()))
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
    match method {
        Method::Threshold => {
            let quality = rules::qualify(&calm, &levels, &thresholds, task.thresholds.leave);
            let raw = rules::states(&quality, &task.rules());
            Ok(subtasks::assemble(time_s, &raw, task, thresholds, warnings))
        }
        Method::Hmm => {
            let decoded = markov::decode(time_s, &evidence::of_blocks(&calm, &levels, &thresholds, task))?;
            let by_path = subtasks::assemble(time_s, &decoded.path, task, thresholds, warnings);
            Ok(decoded.into_segmentation(by_path))
        }
    }
}
