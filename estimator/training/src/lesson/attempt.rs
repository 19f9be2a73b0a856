//! Facts of a recording about its attempt: enough to grade it again from its file alone.

use super::expert_level::Expert;
use super::format::{Lesson, Over};
use foundation::estimate::EstimateError;
use haptics::recording::Recording;
use serde::{Deserialize, Serialize};

/// The key of a sidecar that holds it.
pub const SIDECAR_KEY: &str = "lesson";

/// Identification of the attempt in a recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Attempted {
    /// The lesson's id.
    pub id: String,
    /// Index of the world among those of the lesson.
    #[serde(default)]
    pub variant: usize,
    /// Answer of the trainee, from 0, if there was a question.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub answer: Option<usize>,
    /// Round trip of the line between hand and world, ms; 0: none.
    #[serde(default)]
    pub delay_ms: f64,
    /// True if a model of the far world answered at once.
    #[serde(default)]
    pub predicted: bool,
    /// The whole lesson, so that it can be graded where that lesson is not known, or is another one by now.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub definition: Option<Box<Lesson>>,
}

impl Attempted {
    /// An attempt without a delay, and without an answer so far.
    pub fn at(lesson: &Lesson, variant: usize) -> Self {
        Self { id: lesson.id.clone(), variant, answer: None, delay_ms: 0.0, predicted: false, definition: None }
    }

    /// Facts of a recording about its attempt; `None` if it is no attempt.
    ///
    /// # Errors
    /// An entry that cannot be read.
    pub fn of(recording: &Recording) -> Result<Option<Self>, EstimateError> {
        let Some(value) = recording.meta.other.get(SIDECAR_KEY) else { return Ok(None) };
        serde_json::from_value(value.clone()).map(Some).map_err(|error| {
            EstimateError::Other(format!("what {} says of its lesson cannot be read: {error}", recording.name))
        })
    }

    /// Writes it into a recording's sidecar.
    pub fn give_to(&self, recording: &mut Recording) {
        recording.meta.other.insert(SIDECAR_KEY.to_owned(), self.to_json());
    }

    /// As it stands in a sidecar.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(self).unwrap_or_default()
    }
}

impl Lesson {
    /// Expert reference under the conditions of an attempt: over its line, if that was measured, else without one.
    pub fn experts(&self, attempted: &Attempted) -> Option<&Expert> {
        let same =
            |over: &&Over| (over.delay_ms - attempted.delay_ms).abs() < 0.5 && over.predicted == attempted.predicted;
        self.expert_over.iter().find(same).map(|over| &over.expert).or(self.expert.as_ref())
    }
}
