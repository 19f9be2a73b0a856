//! The grade of an attempt, with the figures behind it.

use crate::Measures;
use schemars::JsonSchema;
use serde::Serialize;

/// Version of the computation of scores from measures. Scores of different versions are not compared.
pub const GRADE_VERSION: u32 = 1;

/// A measure of an attempt beside that of experts.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Figure {
    /// Key of its definition.
    pub measure: String,
    /// How much it counts.
    pub weight: f64,
    /// Its value, in the definition's unit.
    pub value: f64,
    /// The experts' mean.
    pub expert_mean: f64,
    /// Their standard deviation.
    pub expert_sd: f64,
    /// Their mean, worse by one standard deviation: what a proficient attempt keeps.
    pub criterion: f64,
    /// Whether it is kept.
    pub meets_criterion: bool,
    /// How many units it is worse than the experts' mean; below zero it is better.
    pub worse_by: f64,
}

/// A goal, and whether it was reached.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Reached {
    /// The goal's words.
    pub says: String,
    /// Whether it was reached (a rule: kept).
    pub reached: bool,
}

/// What an attempt is worth.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Grade {
    /// [`GRADE_VERSION`].
    pub version: u32,
    /// The lesson's id.
    pub lesson: String,
    /// Every goal reached, every rule kept, the question answered rightly.
    pub completed: bool,
    /// The goals.
    pub goals: Vec<Reached>,
    /// The rules.
    pub rules: Vec<Reached>,
    /// Whether the answer was right, where there was a question.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub answered_rightly: Option<bool>,
    /// 100 is the experts' average; absent for an attempt that was not completed.
    pub score: Option<f64>,
    /// The score that a proficient attempt reaches: the experts' mean, worse by one standard deviation.
    pub score_criterion: f64,
    /// Completed, and the score reaches it.
    pub meets_criterion: bool,
    /// What was judged, in the lesson's order.
    pub figures: Vec<Figure>,
    /// What to do better next, in one sentence.
    pub advice: String,
    /// Everything that was measured.
    pub measures: Measures,
    /// From the hand's first motion until the last goal was reached, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub completed_s: Option<f64>,
}
