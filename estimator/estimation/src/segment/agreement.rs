//! Agreement of a segmentation with the labels of its recording.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The agreement of one recording.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Score {
    /// Labelled samples that were compared.
    pub samples: usize,
    /// Share of them that have their label's state.
    pub accuracy: f64,
    /// Every state that is labelled or was found.
    pub states: BTreeMap<String, StateScore>,
    /// F1 of the boundaries between states: of those that are labelled and those that were found, how many belong together.
    pub boundary_f1: f64,
    /// How far they may be apart for that, s. Shorter stays in a state are no event.
    pub tolerance_s: f64,
    /// Median distance of the boundaries that belong together, s; absent where none does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub boundary_error_s: Option<f64>,
    /// Labelled boundaries.
    pub boundaries: usize,
    /// States that the labels do not tell apart and that count as one here.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub as_one: Vec<String>,
    /// Labels that name no state of the program; their samples were left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unknown_labels: Vec<String>,
}

/// The agreement in one state, by samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct StateScore {
    /// 2 · right / (labelled + found).
    pub f1: f64,
    /// Samples that are labelled so.
    pub labelled: usize,
    /// Samples that were found so.
    pub found: usize,
    /// Samples that are both.
    pub right: usize,
}
