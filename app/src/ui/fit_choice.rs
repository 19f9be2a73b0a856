//! How a recording is to be segmented and fitted.

use super::prepare::Prepared;
use super::session::sentence;
use crate::tasks::Chosen;
use estimator::segment::definition::Definition;
use estimator::segment::{Method, Thresholds};
use haptics::recording::{Recording, Task};
use std::sync::Arc;

/// How the fit is to be made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitChoice {
    /// The task; absent: told from the recording.
    pub task: Option<Task>,
    /// A task of the user's, which is like `task`.
    pub own: Option<Arc<Definition>>,
    /// Thresholds given by hand; absent: chosen above the noise.
    pub thresholds: Option<Thresholds>,
    /// How states are told apart.
    pub method: Method,
}

impl FitChoice {
    /// The task with its rules for a recording, where that is known.
    pub fn definition(&self, prepared: &Prepared) -> Option<Result<Definition, String>> {
        let recording = &prepared.recording;
        let found = match (&self.own, self.task) {
            (Some(own), _) => Ok((**own).clone()),
            (None, Some(task)) => Definition::built_in(task),
            (None, None) => Definition::of(recording, prepared.task?),
        };
        Some(found.map_err(|error| sentence(&error.to_string())))
    }

    /// A recording that is of the chosen task.
    pub fn given_to(&self, recording: &Recording) -> Recording {
        let mut recording = recording.clone();
        let chosen = match (&self.own, self.task) {
            (Some(own), _) => Chosen::Own(Box::new((**own).clone())),
            (None, Some(task)) => Chosen::BuiltIn(task),
            (None, None) => return recording,
        };
        chosen.give_to(&mut recording);
        recording
    }
}
