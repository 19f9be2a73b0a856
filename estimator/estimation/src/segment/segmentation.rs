//! A segmentation: intervals of states, how they were told apart, and what is known of every sample.

use super::agreement::Score;
use foundation::tasks::definition::Definition;
use foundation::tasks::{SystemState, Thresholds};
use haptics::recording::Task;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

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
    pub(super) fn mean(&self, state: SystemState, first: usize, end: usize) -> f64 {
        (first..end).map(|i| self.at(i, state)).sum::<f64>() / (end - first).max(1) as f64
    }
}

impl Segmentation {
    /// Segmentation of a recording by the rules.
    pub(super) fn by_rules(
        task: &Definition,
        states: Vec<Interval>,
        thresholds: Thresholds,
        warnings: Vec<String>,
    ) -> Self {
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
