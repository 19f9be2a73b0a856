//! The file of a lesson, and what makes it one that can be done.

use super::expert_level::Expert;
use super::goal::{self, Goal, Rule};
use crate::definitions::Definition;
use foundation::estimate::EstimateError;
use haptics::device::Act;
use haptics::world::{World, presets};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Version of the file format.
pub const SCHEMA: u32 = 1;

/// A lesson, as its file says.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lesson {
    /// Version of the format, [`SCHEMA`].
    pub schema: u32,
    /// Its name in files and in the history: letters, digits, `-` and `_`.
    pub id: String,
    /// Its name for people.
    pub title: String,
    /// Where it stands in the list; equal places go by title.
    #[serde(default)]
    pub place: u32,
    /// What it is about, in one sentence.
    pub goal: String,
    /// A built-in world by name, or a whole world.
    pub world: Base,
    /// Changes of that world, as a JSON patch (RFC 6902).
    #[serde(default, skip_serializing_if = "is_empty")]
    #[schemars(with = "Vec<serde_json::Value>")]
    pub changes: json_patch::Patch,
    /// Worlds of which each attempt draws one; each is a JSON patch of the world above. Empty: always the same.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(with = "Vec<Vec<serde_json::Value>>")]
    pub variants: Vec<json_patch::Patch>,
    /// A force of a finger above this is too large, N.
    pub limit_n: f64,
    /// After this an attempt ends by itself, s.
    pub at_most_s: f64,
    /// What is to be reached.
    pub goals: Vec<Goal>,
    /// What must not happen.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rules: Vec<Rule>,
    /// What is asked at the end, if anything.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub question: Option<Question>,
    /// How an expert does it.
    pub demonstration: Vec<Step>,
    /// What a score is made of.
    pub judged: Vec<Judged>,
    /// What experts need for it; absent until it was measured ([`expert::measure`]).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expert: Option<Expert>,
    /// What they need over slow lines ([`expert::measure_over`]); an attempt over another line is held against those without one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub expert_over: Vec<Over>,
    /// The text for people, Markdown: from the file beside it.
    #[serde(skip)]
    pub text: String,
}

/// What experts need over a slow line.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Over {
    /// Round trip, ms.
    pub delay_ms: f64,
    /// A model of the far world answered at once.
    pub predicted: bool,
    /// What they need.
    pub expert: Expert,
}

// serde hands over a reference.
fn is_empty(patch: &json_patch::Patch) -> bool {
    patch.0.is_empty()
}

/// The world that a lesson begins with.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Base {
    /// The name of a built-in world.
    Named(String),
    /// A world.
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    Whole(Box<World>),
}

/// One step of the demonstration.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Step {
    /// What is shown, in a few words.
    pub says: String,
    /// What is done.
    #[serde(flatten)]
    pub act: Act,
}

/// One measure of a score.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Judged {
    /// Key of its definition.
    pub measure: String,
    /// How much it counts beside the others, positive.
    pub weight: f64,
}

/// What is asked at the end of an attempt.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Question {
    /// The question.
    pub asks: String,
    /// The answers, in the order of the variants: the one of the variant that was touched is right.
    pub answers: Vec<String>,
}

pub(super) fn wrong(what: impl Into<String>) -> EstimateError {
    EstimateError::Other(what.into())
}

impl Lesson {
    /// Reads a lesson and checks it.
    ///
    /// # Errors
    /// One sentence that names the fault.
    pub fn from_json(json: &str, text: &str) -> Result<Self, EstimateError> {
        let mut lesson: Self = serde_json::from_str(json)
            .map_err(|error| wrong(format!("this is no lesson: {error}; docs/lessons.md shows how one is written")))?;
        text.trim().clone_into(&mut lesson.text);
        lesson.check()?;
        Ok(lesson)
    }

    /// Reads a lesson from its file, with the text beside it (`NAME.md`) where there is one.
    ///
    /// # Errors
    /// One sentence that ends in the path.
    pub fn load(path: &Path) -> Result<Self, EstimateError> {
        let at = |error: &dyn std::fmt::Display| {
            wrong(format!("{}: {}", haptics::text_file::one_line(&error.to_string()), path.display()))
        };
        let json = haptics::text_file::read(path).map_err(|error| at(&error))?;
        let text = haptics::text_file::read(&path.with_extension("md")).unwrap_or_default();
        Self::from_json(&json, &text).map_err(|error| at(&error))
    }

    /// Number of worlds that attempts are drawn from.
    pub fn variant_count(&self) -> usize {
        self.variants.len().max(1)
    }

    /// The world of a variant.
    ///
    /// # Errors
    /// The base is unknown, a change fits nothing, or the result is no world.
    pub fn world(&self, variant: usize) -> Result<World, EstimateError> {
        let base = match &self.world {
            Base::Whole(world) => (**world).clone(),
            Base::Named(name) => presets::named(name).ok_or_else(|| {
                let names = presets::BUILT_IN.map(|(name, _)| name).join(", ");
                wrong(format!("there is no world `{name}`; name one of {names}, or write a whole world"))
            })?,
        };
        let mut json = serde_json::to_value(&base).map_err(|error| wrong(error.to_string()))?;
        for patch in [Some(&self.changes), self.variants.get(variant)].into_iter().flatten() {
            json_patch::patch(&mut json, patch)
                .map_err(|error| wrong(format!("a change of the world fits nothing there: {error}")))?;
        }
        let mut world: World =
            serde_json::from_value(json).map_err(|error| wrong(format!("the changes leave no world: {error}")))?;
        if matches!(self.world, Base::Named(_)) {
            world.name.clone_from(&self.title);
        }
        world.check().map_err(|error| wrong(error.to_string()))?;
        Ok(world)
    }

    /// The acts of the demonstration.
    pub fn acts(&self) -> Vec<Act> {
        self.demonstration.iter().map(|step| step.act.clone()).collect()
    }

    pub(super) fn check(&self) -> Result<(), EstimateError> {
        if self.schema > SCHEMA {
            let newer = self.schema;
            return Err(wrong(format!(
                "the lesson has format {newer} and this program knows up to {SCHEMA}; get a newer program"
            )));
        }
        if !foundation::tasks::library::is_name(&self.id) {
            return Err(wrong(format!("`{}` cannot be a lesson's id: use letters, digits, - and _", self.id)));
        }
        let is_possible =
            self.limit_n > 0.0 && self.limit_n.is_finite() && self.at_most_s > 0.0 && self.at_most_s <= 3600.0;
        if !is_possible {
            return Err(wrong("`limit_n` must be a force above 0 and `at_most_s` a time up to 3600 s"));
        }
        if self.goals.is_empty() || self.judged.is_empty() || self.demonstration.is_empty() {
            return Err(wrong("a lesson needs `goals`, a `demonstration` and what is `judged`, at least one of each"));
        }
        for judged in &self.judged {
            let known = Definition::of(&judged.measure).is_some_and(|d| d.less_is_better.is_some() && d.grain > 0.0);
            let counts = judged.weight > 0.0 && judged.weight.is_finite();
            if !(known && counts) {
                return Err(wrong(format!(
                    "`{}` with the weight {} cannot be judged: name a measure of docs/training.md that can be better or worse, with a \
                     weight above 0",
                    judged.measure, judged.weight
                )));
            }
        }
        if let Some(question) = &self.question
            && (question.answers.len() != self.variants.len() || question.answers.len() < 2)
        {
            return Err(wrong("a question needs one answer for each of the `variants`, two or more"));
        }
        (0..self.variant_count()).try_for_each(|variant| self.check_in(&self.world(variant)?))
    }

    fn check_in(&self, world: &World) -> Result<(), EstimateError> {
        let in_goals = self.goals.iter().find_map(|g| Some((&g.says, goal::lacks(&g.kind, world)?)));
        let in_rules = self.rules.iter().find_map(|r| Some((&r.says, goal::forbids_nothing(&r.kind, world)?)));
        let in_steps =
            self.demonstration.iter().find_map(|s| Some((&s.says, s.act.lacks(world).or_else(|| s.act.wrong())?)));
        match in_goals.or(in_rules).or(in_steps) {
            Some((says, why)) => Err(wrong(format!("`{says}` cannot be done: {why}"))),
            None => Ok(()),
        }
    }
}
