//! The experiment that a diagnosis asks for: rehearsed on simulated objects, or prepared for a person.

use crate::experiment::like::Like;
use crate::experiment::rehearse::{Rehearsal, rehearse};
use crate::experiment::timetable::Timetable;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::JobKind;
use crate::ui::diagnose::guided_experiment::Guided;
use crate::ui::diagnose::state::{Answer, DIAGNOSE, options, plain, reachable};
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use estimator::diagnose::{self, Progress, Suspect};
use haptics::recording::Recording;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Rehearsing the experiment that a diagnosis asks for.
pub const REHEARSE: JobKind = JobKind::new("rehearse").after(&DIAGNOSE);

/// Preparing that experiment for a person.
pub(crate) const GUIDE: JobKind = JobKind::new("guide");

/// Number of simulations of every object.
pub const ROUNDS: u64 = 3;

/// State of the experiments that the window keeps while recordings come and go.
#[derive(Default)]
pub struct Experiments {
    /// The path field of a recording that was made elsewhere.
    pub path_field: String,
    /// The plan of a mechanism's motion is shown.
    pub shows_plan: bool,
    /// The experiment that a person does in Train.
    pub guided: Option<Box<Guided>>,
    /// Folder for the recording of a gallery picture; it lives as long as the session.
    pub scratch: Option<tempfile::TempDir>,
    /// A recording is being added: the question is asked again once it is there.
    pub asks_again: bool,
}

/// Object that a person does the experiment on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The world that stands in Train.
    AsItStands,
    /// The calibrated object as if this cause were in it.
    AsIf(String),
}

/// Rehearses; the sentence of an error, or nothing when nobody wants it any more.
pub fn rehearse_now(
    recordings: &[Arc<Prepared>],
    choice: &FitChoice,
    answer: &Answer,
    rounds: u64,
    goes_on: &dyn Fn(f64) -> bool,
) -> Result<Rehearsal, Option<String>> {
    let next = answer.diagnosis.next_experiment.as_ref().ok_or_else(|| Some("Nothing is open.".to_owned()))?;
    let plain = plain(recordings, choice);
    let suspects = suspects(&plain, choice, answer)?;
    let options = options(&plain, choice, answer.from, Progress::default());
    let again = |more: &Recording| {
        let all: Vec<Recording> = plain.iter().chain([more]).cloned().collect();
        diagnose::diagnose(&all, &options).map_err(|error| sentence(&error.to_string()))
    };
    let first = plain.first().ok_or_else(|| Some("No recording is open.".to_owned()))?;
    let like = Like { recording: first, noise_n: answer.diagnosis.noise_floor_n };
    rehearse(&suspects, next, (rounds, like), &again, goes_on)
}

pub(crate) fn suspects(
    plain: &[Recording],
    choice: &FitChoice,
    answer: &Answer,
) -> Result<Vec<Suspect>, Option<String>> {
    let options = options(plain, choice, answer.from, Progress::default());
    diagnose::suspects(plain, &options, &answer.diagnosis).map_err(|error| Some(sentence(&error.to_string())))
}

/// The experiment in the world of one suspect, where the hand reaches it.
pub fn guided_as_if(
    recordings: &[Arc<Prepared>],
    choice: &FitChoice,
    answer: &Answer,
    id: &str,
) -> Result<Guided, String> {
    let suspects = suspects(&plain(recordings, choice), choice, answer).map_err(Option::unwrap_or_default)?;
    let suspect = suspects.iter().find(|s| s.id == id).ok_or("This cause cannot be simulated.")?;
    let next = answer.diagnosis.next_experiment.as_ref().ok_or("Nothing is open.")?;
    let asked = next.experiment.as_ref().ok_or("This experiment is known in words only.")?;
    let table = Timetable::new(&reachable(&suspect.world)?, asked, &next.motion)?.leaking_once_held();
    Ok(Guided::new(table, asked.clone(), Some(format!("as if {}", id.replace('-', " ")))))
}

/// Writes a recording beside others, under a name of its own.
pub(crate) fn write(folder: &Path, recording: Recording) -> Result<PathBuf, String> {
    let path = free_path(folder, &recording.name.replace(", ", "-").replace(' ', "-"))?;
    let recording = Recording { labels: None, ..recording };
    estimator::log::write_csv(&recording, &path)
        .and_then(|()| estimator::log::write_meta(&recording, &path))
        .map_err(|error| sentence(&error.to_string()))?;
    Ok(path)
}

/// A name in a folder, which is made, that no file has yet.
pub(crate) fn free_path(folder: &Path, stem: &str) -> Result<PathBuf, String> {
    std::fs::create_dir_all(folder).map_err(|e| format!("The folder cannot be made ({e}): {}", folder.display()))?;
    let mut free = (1..u32::MAX).map(|k| folder.join(format!("{stem}-{k}.csv"))).filter(|path| !path.exists());
    free.next().ok_or_else(|| format!("No name for another file is free in {}", folder.display()))
}
