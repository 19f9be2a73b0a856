//! An attempt at a lesson, as the history keeps it.

use estimator::training::progress::Try;
use jiff::Timestamp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::PathBuf;

/// Under what an attempt was made: only attempts under the same conditions are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(default)]
pub struct Conditions {
    /// Round trip of the line to the remote side, ms; 0: none.
    pub delay_ms: f64,
    /// Whether a predictive model of the remote side was shown.
    pub predicted: bool,
}

/// An attempt at a lesson that is over.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Attempt {
    /// Name of the trainee.
    pub trainee: String,
    /// Id of the lesson.
    pub lesson: String,
    /// Under what.
    #[serde(default)]
    pub conditions: Conditions,
    /// When it began, UTC.
    #[schemars(with = "String")]
    pub began: Timestamp,
    /// How long it took, s.
    pub duration_s: f64,
    /// Whether the task was done to its end.
    pub completed: bool,
    /// What it was graded with, by the lesson's own scale; nothing where it could not be graded.
    pub score: Option<f64>,
    /// Whether it met the lesson's criterion.
    pub meets_criterion: bool,
    /// Whether the trainee was proficient after it.
    pub proficient: bool,
    /// All measures as they were taken.
    pub measures: Value,
    /// Version of their definitions.
    pub measures_version: u32,
    /// Version of the lesson's grading.
    pub grade_version: u32,
    /// Its recording, where one was kept.
    #[serde(default)]
    pub recording: Option<PathBuf>,
}

impl Attempt {
    /// True if both are of the same trainee at the same lesson under the same conditions.
    pub fn is_like(&self, other: &Self) -> bool {
        (&self.trainee, &self.lesson, self.conditions) == (&other.trainee, &other.lesson, other.conditions)
    }

    /// Point of the learning curve, by its score; `None` without one.
    pub fn as_try(&self) -> Option<Try> {
        let began_s = self.began.as_microsecond() as f64 * 1e-6;
        Some(Try { began_s, value: self.score?, meets_criterion: self.meets_criterion })
    }
}

impl Conditions {
    /// `, 150 ms, predicted`; empty for a link without latency.
    pub fn in_words(&self) -> String {
        let delay = if self.delay_ms > 0.0 { format!(", {} ms", self.delay_ms) } else { String::new() };
        format!("{delay}{}", if self.predicted { ", predicted" } else { "" })
    }
}

/// The user's history; `None` if the system defines no data folder.
pub fn of_user() -> Option<PathBuf> {
    eframe::storage_dir("touchstone").map(|folder| folder.join("history.sqlite"))
}
