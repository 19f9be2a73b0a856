//! Segmentation: which state held when, and to which subtask it belongs.
//!
//! Stage 1 is [`crate::signal::task`]; [`threshold`] chooses thresholds above the noise, [`rules`] are stage 2 (thesis, table
//! 5.2), [`subtasks`] is stage 3. The results are plain intervals, the same for every method.

pub mod rules;
pub mod subtasks;
pub mod threshold;

use crate::estimate::EstimateError;
use crate::signal::task::{TaskSignals, calmed, is_two_fingered, task_signals};
use haptics::recording::{Recording, Task};
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
    /// Share of the interval's samples that show this state by themselves, before smoothing.
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
    /// `threshold`.
    pub method: String,
    /// The task it was read as.
    pub task: String,
    /// Intervals in order, without holes.
    pub states: Vec<Interval>,
    /// The thresholds that were used.
    pub thresholds: Thresholds,
    /// Sentences.
    pub warnings: Vec<String>,
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

/// Segments a recording by qualitative reasoning, all three stages. `given` thresholds replace those chosen from the noise.
pub fn segment(
    recording: &Recording,
    task: Option<Task>,
    given: Option<Thresholds>,
) -> Result<Segmentation, EstimateError> {
    let task = task_of(recording, task)?;
    match task {
        Task::BlockStack | Task::Barrel => {
            let signals = task_signals(recording)?;
            segment_signals(&signals, task, given)
        }
        Task::Crank | Task::Mechanism => subtasks::segment_motion(recording, task, given),
        Task::Needle | Task::Switch => Err(EstimateError::Other(format!(
            "recordings of the task {} cannot be segmented yet; block-stack, barrel, crank and mechanism can",
            task.name()
        ))),
    }
}

/// Stages 2 and 3 on the task signals of blocks.
pub fn segment_signals(
    signals: &TaskSignals,
    task: Task,
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
    let thresholds = given.unwrap_or_else(|| threshold::choose(&calm, &levels));
    let quality = rules::qualify(&calm, &levels, &thresholds);
    let raw = rules::states(&quality);
    Ok(subtasks::assemble(&signals.time_s, &raw, task, thresholds, levels.warnings()))
}
