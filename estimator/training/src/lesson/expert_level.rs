//! The level of experts in a lesson: mean and spread of each judged measure.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Mean and standard deviation of something.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sd: f64,
}

/// What experts need.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expert {
    /// Attempts that were completed, of those that were made.
    pub completed: [usize; 2],
    /// Version of the measures.
    pub measures_version: u32,
    /// By key of the measure.
    pub measures: BTreeMap<String, Spread>,
    /// How far the experts' attempts are worse than their own mean ([`grade::badness`]).
    pub badness: Spread,
}
