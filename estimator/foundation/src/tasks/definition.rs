//! Definition of a task: its states with their rules, its subtasks, and the choice of its thresholds. Tasks are JSON
//! files; the built-in ones are in `assets/tasks`, users add their own (`docs/tasks.md`).

use super::sign::Sign;
use super::state::SystemState;
use super::thresholds::Thresholds;
use crate::estimate::EstimateError;
use haptics::recording::{Recording, Task};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Most objects carried in one recording.
pub const MOST_CARRIES: usize = 100;

/// The key of a sidecar that holds a whole task of its own.
pub const SIDECAR_KEY: &str = "task_definition";

/// A task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Definition {
    /// The name in files and on the command line.
    pub name: String,
    /// The name for people.
    pub title: String,
    /// The built-in task whose signals are looked at and whose fit applies.
    pub like: Task,
    /// Choice of the thresholds.
    pub thresholds: Policy,
    /// States with their rules; of several rules that hold, the first one names the state.
    pub states: Vec<StateRule>,
    /// Subtasks.
    pub subtasks: Subtasks,
}

/// Distinction of the qualitative values +, 0, −.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Policy {
    /// Source of the learned thresholds.
    pub from: Learned,
    /// Share of its threshold (0 to 1) below which a signal counts as 0 again.
    pub leave: f64,
    /// A velocity threshold that replaces the learned one, m/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_m_s: Option<f64>,
    /// A force threshold that replaces the learned one, N.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force_n: Option<f64>,
}

/// Source of the learned thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Learned {
    /// Above the noise of the phases in which nothing is touched.
    FreeMotion,
}

/// Conditions under which a state holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StateRule {
    /// The state.
    pub state: SystemState,
    /// Signal → its allowed values, e.g. `"+"` or `"0-"`. Signals that are not named may be anything.
    pub when: BTreeMap<String, String>,
    /// Parameters that the state can show.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shows: Vec<String>,
}

/// The steps of a task.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Subtasks {
    /// One after the other; the repeated steps come once for every object.
    Ordered(Ordered),
    /// Whenever the state lasts a while: no order is expected.
    Each(Each),
}

/// See [`Subtasks::Ordered`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ordered {
    /// Steps before the first object.
    pub first: Vec<Step>,
    /// Steps of every object.
    pub repeat: Vec<Step>,
    /// Most objects.
    pub most: usize,
}

/// See [`Subtasks::Each`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Each {
    /// The steps.
    pub each: Vec<Step>,
}

/// One step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// Its name; `{n}` is the number of the object or of the occurrence, from 1.
    pub name: String,
    /// The state that holds.
    pub state: SystemState,
    /// From this step or a later one of the same object one may have to begin again (a failed attempt at lifting).
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub retry: bool,
}

impl Step {
    /// The step of an object, by its number.
    pub fn numbered(&self, number: usize) -> Subtask {
        let name = self.name.replace("{n}", &number.to_string());
        Subtask { name, state: self.state, retry: self.retry, object: number }
    }
}

/// Signals that rules may speak of, by the task they are like, with their values.
pub fn signals(like: Task) -> &'static [(&'static str, &'static [&'static str])] {
    const SIGNS: &[&str] = &["+", "0", "-"];
    const SIZES: &[&str] = &["+", "0"];
    match like {
        Task::BlockStack | Task::Barrel => {
            &[("contact", SIZES), ("grip", SIGNS), ("net_force_y", SIGNS), ("velocity_x", SIGNS), ("velocity_y", SIGNS)]
        }
        Task::Crank | Task::Mechanism | Task::Switch => &[("load", SIZES), ("speed", SIZES)],
        Task::Payload => &[("speed", SIZES)],
        Task::Needle => &[("phase", &["free", "insertion", "penetration", "extraction"])],
    }
}

impl Definition {
    /// The built-in task of a kind.
    pub fn built_in(task: Task) -> Result<Self, EstimateError> {
        let (name, text) = match task {
            Task::BlockStack => ("block-stack.json", include_str!("../../../../assets/tasks/block-stack.json")),
            Task::Barrel => ("barrel.json", include_str!("../../../../assets/tasks/barrel.json")),
            Task::Crank => ("crank.json", include_str!("../../../../assets/tasks/crank.json")),
            Task::Mechanism => ("mechanism.json", include_str!("../../../../assets/tasks/mechanism.json")),
            Task::Switch => ("switch.json", include_str!("../../../../assets/tasks/switch.json")),
            Task::Needle => ("needle.json", include_str!("../../../../assets/tasks/needle.json")),
            Task::Payload => ("payload.json", include_str!("../../../../assets/tasks/payload.json")),
        };
        Self::parse(text, name)
    }

    /// Reads a task of a user's file.
    pub fn read(path: &Path) -> Result<Self, EstimateError> {
        let text = haptics::text_file::read(path).map_err(|error| {
            EstimateError::Other(format!("the task {} cannot be read: {error}; check its path", path.display()))
        })?;
        Self::parse(&text, &path.display().to_string())
    }

    /// Reads a task; `place` is named in errors.
    pub fn parse(text: &str, place: &str) -> Result<Self, EstimateError> {
        let task: Self = serde_json::from_str(text).map_err(|error| {
            let error = haptics::text_file::one_line(&error.to_string());
            EstimateError::Other(format!(
                "the task {place} is not understood: {error}; docs/tasks.md shows a whole one"
            ))
        })?;
        task.checked(place)
    }

    /// The task that a recording is read as: the one in its sidecar, else the built-in one.
    pub fn of(recording: &Recording, task: Task) -> Result<Self, EstimateError> {
        let place = || format!("in the sidecar of {} ({SIDECAR_KEY})", recording.name);
        match recording.meta.other.get(SIDECAR_KEY) {
            Some(value) => {
                let own: Self = serde_json::from_value(value.clone()).map_err(|error| {
                    EstimateError::Other(format!(
                        "the task {} is not understood: {error}; docs/tasks.md shows a whole one",
                        place()
                    ))
                })?;
                // Another task was asked for.
                if own.like == task { own.checked(&place()) } else { Self::built_in(task) }
            }
            None => Self::built_in(task),
        }
    }

    /// Makes a recording one of this task.
    pub fn give_to(&self, recording: &mut Recording) {
        recording.meta.task = Some(self.like);
        if let Ok(value) = serde_json::to_value(self) {
            recording.meta.other.insert(SIDECAR_KEY.to_owned(), value);
        }
    }

    /// The task, when it can be used; `place` is named in the sentence that says why not.
    pub fn checked(self, place: &str) -> Result<Self, EstimateError> {
        match self.fault() {
            Some(fault) => {
                let fault = haptics::text_file::one_line(&fault);
                Err(EstimateError::Other(format!("the task {place} cannot be used: {fault}")))
            }
            None => Ok(self),
        }
    }

    /// The expected order for a number of objects; nothing if no order is expected.
    pub fn order(&self, objects: usize) -> Vec<Subtask> {
        let Subtasks::Ordered(ordered) = &self.subtasks else { return Vec::new() };
        let first = ordered.first.iter().map(|step| Subtask { object: 0, ..step.numbered(1) });
        first.chain((1..=objects).flat_map(|n| ordered.repeat.iter().map(move |step| step.numbered(n)))).collect()
    }

    /// The thresholds: given ones, else the task's own, else the learned ones.
    pub fn thresholds(&self, given: Option<Thresholds>, learned: impl FnOnce() -> Thresholds) -> Thresholds {
        if let Some(given) = given {
            return given;
        }
        let (velocity, force) = (self.thresholds.velocity_m_s, self.thresholds.force_n);
        if let (Some(velocity_m_s), Some(force_n)) = (velocity, force) {
            return Thresholds { velocity_m_s, force_n };
        }
        let learned = learned();
        Thresholds { velocity_m_s: velocity.unwrap_or(learned.velocity_m_s), force_n: force.unwrap_or(learned.force_n) }
    }

    /// The state of a needle's phase.
    pub fn state_of_phase(&self, phase: &str) -> SystemState {
        let holds = |rule: &&StateRule| rule.when.get("phase").is_none_or(|wanted| wanted == phase);
        self.states.iter().find(holds).map_or(SystemState::NoState, |rule| rule.state)
    }

    /// The rules, ready for many samples.
    pub fn rules(&self) -> Rules {
        let known = signals(self.like);
        let condition = |(signal, allowed): (&String, &String)| {
            let index = known.iter().position(|(name, _)| name == signal).unwrap_or(usize::MAX);
            (index, [Sign::Plus, Sign::Zero, Sign::Minus].map(|sign| allowed.contains(sign.symbol())))
        };
        Rules(self.states.iter().map(|rule| (rule.state, rule.when.iter().map(condition).collect())).collect())
    }
}

/// Rules of a task: conditions are the number of a signal (in the order of [`signals`]) and which of +, 0, − are allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct Rules(Vec<(SystemState, Vec<Condition>)>);

/// The number of a signal, and whether it may be +, 0, −.
type Condition = (usize, [bool; 3]);

impl Rules {
    /// The state of the first rule that holds. A signal that is not measured satisfies no condition.
    pub fn state(&self, values: &[Option<Sign>]) -> SystemState {
        let meets = |(signal, allowed): &Condition| {
            values.get(*signal).copied().flatten().is_some_and(|sign| allowed[sign as usize])
        };
        self.0.iter().find(|(_, when)| when.iter().all(meets)).map_or(SystemState::NoState, |(state, _)| *state)
    }
}

/// A step of the task: its name and the state the system is then in.
#[derive(Clone, Debug, PartialEq)]
pub struct Subtask {
    /// E.g. `carry-block-1`.
    pub name: String,
    /// The state that holds.
    pub state: SystemState,
    /// One may have to begin the object again.
    pub retry: bool,
    /// The number of its object, from 1; 0: a step before the first object.
    pub object: usize,
}
