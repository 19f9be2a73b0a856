//! A diagnosis as far as it has come, and the questions that it answers.

use crate::experiment::rehearse::Rehearsal;
use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::JobKind;
use crate::ui::calibrate::replayed::Replayed;
use crate::ui::diagnose::atlas_sheet::Sheet;
use crate::ui::diagnose::checked::Checked;
use crate::ui::document::file_kind::LOAD;
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use crate::ui::plots::residuals::Residuals;
use estimator::diagnose::{self, Findings, Options, Progress, Twins, Worlds};
use haptics::recording::{Recording, Task};
use haptics::world::World;
use std::sync::Arc;

/// Looking for what the model gets wrong.
pub const DIAGNOSE: JobKind = JobKind::new("diagnose").after(&LOAD);

/// Making the worlds without and with the causes.
pub const EXTEND: JobKind = JobKind::new("extend").after(&DIAGNOSE);

/// Replaying the measured motion through the extended world.
pub const SIMULATE_EXTENDED: JobKind = JobKind::new("simulate-extended").after(&EXTEND);

/// The model of a mechanism to start from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StartFrom {
    /// Inertia alone.
    Mass,
    /// Inertia and viscous friction.
    Viscous,
    /// Inertia, viscous friction and dry friction.
    #[default]
    Coulomb,
}

impl StartFrom {
    /// As the command line has it.
    fn baseline(self) -> &'static str {
        match self {
            Self::Mass => "mass",
            Self::Viscous => "mass+viscous",
            Self::Coulomb => "mass+viscous+coulomb",
        }
    }
}

/// A diagnosis, ready to be shown.
#[derive(Clone, Debug)]
pub struct Answer {
    /// Findings of the diagnosis.
    pub diagnosis: Findings,
    /// Its curves, one a recording.
    pub residuals: Vec<Residuals>,
    /// Residual atlas: the share of the force that each suspect would explain, one sheet a recording.
    pub atlas: Vec<Sheet>,
    /// The model that it started from.
    pub from: StartFrom,
}

/// The diagnosis of the loaded recordings, as far as it has come.
#[derive(Debug, Default)]
pub struct Diagnosing {
    /// The model of a mechanism to start from.
    pub from: StartFrom,
    /// True if the atlas is shown in place of the curves.
    pub shows_atlas: bool,
    /// The suspect that is shown large.
    pub atlas_open: Option<String>,
    /// The cause that was asked about: why not?
    pub asked_about: Option<String>,
    /// Answer to the last question.
    pub answer: Option<Arc<Answer>>,
    /// Why nothing did, in one sentence.
    pub problem: Option<String>,
    /// Worlds of the base model and of the extended model, once they were made.
    pub worlds: Option<Arc<Worlds>>,
    /// Why there are none, in one sentence.
    pub worlds_problem: Option<String>,
    /// The recordings' motion through the extended world, once that is there.
    pub replays: Vec<Option<Replayed>>,
    /// Rehearsal of the requested experiment on simulated objects: the causes that it would tell apart.
    pub rehearsal: Option<Arc<Rehearsal>>,
    /// Checks of the answer on other recordings.
    pub checked: Vec<Checked>,
    /// False alarms in replays without any cause, or why there are none, in one sentence.
    pub twins: Option<Result<Twins, String>>,
    /// The path field of a recording to check on.
    pub check_field: String,
    /// Why it could not be rehearsed, in one sentence.
    pub rehearsal_problem: Option<String>,
}

impl Diagnosing {
    /// Replay of a recording through the world with what the diagnosis found.
    pub fn replay(&self, recording: usize) -> Option<&Replayed> {
        self.replays.get(recording)?.as_ref()
    }

    /// Forgets everything but the question.
    pub fn forget(&mut self) {
        *self = Self { from: self.from, shows_atlas: self.shows_atlas, ..Self::default() };
    }
}

/// Diagnoses; the sentence of an error.
pub fn ask(
    recordings: &[Arc<Prepared>],
    choice: &FitChoice,
    from: StartFrom,
    progress: Progress,
) -> Result<Answer, String> {
    let plain = plain(recordings, choice);
    let options = Options { atlas: true, ..options(&plain, choice, from, progress) };
    let diagnosis = diagnose::diagnose(&plain, &options).map_err(|error| sentence(&error.to_string()))?;
    let residuals = (0..recordings.len()).map(|k| Residuals::new(&diagnosis, k)).collect();
    let atlas = (0..recordings.len()).map(|k| Sheet::new(&diagnosis, k)).collect();
    Ok(Answer { diagnosis, residuals, atlas, from })
}

/// Worlds of the base model and of the extended model, or the sentence of an error.
pub fn extend(
    recordings: &[Arc<Prepared>],
    choice: &FitChoice,
    from: StartFrom,
    answer: &Answer,
) -> Result<Worlds, String> {
    let plain = plain(recordings, choice);
    let options = options(&plain, choice, from, Progress::default());
    diagnose::worlds(&plain, &options, &answer.diagnosis).map_err(|error| sentence(&error.to_string()))
}

pub(crate) fn plain(recordings: &[Arc<Prepared>], choice: &FitChoice) -> Vec<Recording> {
    choice.given_to_all(recordings)
}

pub(crate) fn options(recordings: &[Recording], choice: &FitChoice, from: StartFrom, progress: Progress) -> Options {
    let task = choice.task;
    let is_mechanism = recordings.first().is_some_and(|r| is_mechanism(r, task));
    Options { task, baseline: is_mechanism.then(|| from.baseline().to_owned()), progress, ..Options::default() }
}

/// True when the diagnosis starts from a model that can be chosen.
pub fn is_mechanism(recording: &Recording, task: Option<Task>) -> bool {
    estimator::segment::task_of(recording, task).is_ok_and(|task| task == Task::Mechanism)
}

/// The world with its crank where the hand reaches all of the circle: other people's recordings have their origin elsewhere. What is
/// felt does not depend on the place.
pub(crate) fn reachable(world: &World) -> Result<World, String> {
    world.check().map_err(|error| sentence(&error.to_string()))?;
    let mut world = world.clone();
    let reach = world.hand.workspace;
    if let Some(crank) = &mut world.crank {
        if crank.radius_m > reach.radius_m {
            return Err(format!(
                "The crank's radius of {} mm is larger than the hand's reach of {} mm; save the extended world instead.",
                format::number(1e3 * crank.radius_m, 0),
                format::number(1e3 * reach.radius_m, 0)
            ));
        }
        if (crank.center_m - reach.center_m).norm() + crank.radius_m > reach.radius_m {
            crank.center_m = reach.center_m;
        }
    }
    Ok(world)
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::Vec2;
    use haptics::world::presets;

    #[test]
    fn a_crank_out_of_reach_comes_to_the_hand_and_one_that_is_too_large_is_refused() {
        let near = presets::crank();
        assert_eq!(reachable(&near).as_ref(), Ok(&near));
        let mut far = near.clone();
        far.crank.as_mut().expect("a crank").center_m += Vec2::new(0.4, 0.1);
        assert_eq!(reachable(&far).as_ref(), Ok(&near));
        far.crank.as_mut().expect("a crank").radius_m = 0.3;
        assert!(reachable(&far).is_err_and(|why| why.contains("300 mm") && why.ends_with('.')));
        let mut still = near;
        still.crank.as_mut().expect("a crank").effects.clear();
        assert!(reachable(&still).is_err_and(|why| why.contains("inertia")), "nothing moves without inertia");
    }
}
