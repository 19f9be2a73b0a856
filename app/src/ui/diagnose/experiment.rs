//! The experiment that a diagnosis asks for: rehearsed on simulated objects, done by a person in Train, or loaded from a file.

use crate::experiment::motion_plan::MotionPlan;
use crate::experiment::rehearse::Rehearsal;
use crate::experiment::simulated::simulated_object;
use crate::recorder::folder;
use crate::text::file_name::name_of;
use crate::ui::background::jobs::Jobs;
use crate::ui::background::jobs::no_change;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::experiment_state::{
    Experiments, GUIDE, REHEARSE, ROUNDS, Stage, free_path, guided_as_if, rehearse_now, write,
};
use crate::ui::diagnose::guided_experiment::Guided;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::document::files::{SAVE, saved};
use crate::ui::document::project_files;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::{Messages, Tone};
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::Trainer;
use haptics::law::Coordinate;
use haptics::world::MechanismPath;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Rehearses the experiment in the background.
pub fn rehearse(
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
) {
    let Some(answer) = diagnosing.answer.clone() else { return };
    (diagnosing.rehearsal, diagnosing.rehearsal_problem) = (None, None);
    let (recordings, choice) = (document.recordings.clone(), calibration.choice.clone());
    jobs.start(ctx, REHEARSE, "Rehearsing the experiment", move |ticket| {
        let rehearsal = match rehearse_now(&recordings, &choice, &answer, ROUNDS, &|share| ticket.goes_on(share)) {
            Err(None) => return no_change(),
            Err(Some(problem)) => Err(problem),
            Ok(rehearsal) => Ok(rehearsal),
        };
        change(|session, _| rehearsed(&mut session.diagnosing, rehearsal))
    });
}

/// A rehearsal has ended.
pub(crate) fn rehearsed(diagnosing: &mut Diagnosing, rehearsal: Result<Rehearsal, String>) {
    match rehearsal {
        Ok(rehearsal) => diagnosing.rehearsal = Some(Arc::new(rehearsal)),
        Err(problem) => diagnosing.rehearsal_problem = Some(problem),
    }
}

/// Takes the experiment to Train, for a person to do; what has to be computed for it, in the background.
pub fn guide(session: &mut Session, ctx: &egui::Context, stage: Stage) {
    let Some(answer) = session.diagnosing.answer.clone() else { return };
    let (recordings, choice) = (session.document.recordings.clone(), session.calibration.choice.clone());
    let standing = session.training.trainer.standing_world();
    session.jobs.start(ctx, GUIDE, "Preparing the experiment", move |_| {
        let guided = match stage {
            Stage::AsIf(id) => guided_as_if(&recordings, &choice, &answer, &id),
            Stage::AsItStands => Guided::in_world(&standing, &answer.diagnosis),
        };
        change(|session, _| {
            take_guided(
                &mut session.workspace,
                &mut session.experiments,
                &mut session.training.trainer,
                &mut session.messages,
                guided,
            );
        })
    });
}

/// The experiment is ready for a person.
pub(crate) fn take_guided(
    workspace: &mut Workspace,
    experiments: &mut Experiments,
    trainer: &mut Trainer,
    messages: &mut Messages,
    guided: Result<Guided, String>,
) {
    match guided.and_then(|guided| guided.take_over(trainer).map(|()| guided)) {
        Ok(guided) => {
            experiments.guided = Some(Box::new(guided));
            *workspace = Workspace::Train;
        }
        Err(problem) => messages.fail(problem),
    }
}

/// Adds a recording of the experiment to those that are diagnosed, and asks again.
pub fn add_experiment(session: &mut Session, ctx: &egui::Context, path: &Path) {
    if session.document.sources.is_empty() {
        session.messages.fail("The recordings that were diagnosed are no files; save them first, then add this one.");
        return;
    }
    session.experiments.asks_again = true;
    session.experiments.path_field.clear();
    session.workspace = Workspace::Diagnose;
    project_files::add_log(session, ctx, path);
}

/// Writes a rehearsed recording into the folder of recordings and adds it, as what it is: a simulation.
pub fn add_rehearsed(
    diagnosing: &Diagnosing,
    trainer: &Trainer,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    outcome: usize,
) {
    let rehearsal = diagnosing.rehearsal.clone();
    let round = rehearsal.as_ref().and_then(|r| r.outcomes.get(outcome)?.rounds.first());
    let Some(recording) = round.map(|r| r.recording.clone()) else { return };
    let Some(folder) = folder_of_recordings(trainer, messages) else { return };
    jobs.start(ctx, SAVE, "", move |_| {
        let path = write(&folder, recording)?;
        change(move |session, ctx| performed(session, ctx, &path))
    });
}

/// Writes the plan of a mechanism's motion into the folder of recordings.
pub fn save_motion_plan(session: &mut Session, ctx: &egui::Context, plan: &MotionPlan, coordinate: Coordinate) {
    let Some(folder) = folder_of_recordings(&session.training.trainer, &mut session.messages) else { return };
    let text = match path_of_tool(&session.document, &session.calibration) {
        Some((path, is_planar)) => plan.places_to_csv(&path, is_planar),
        None => plan.to_csv(coordinate),
    };
    session.jobs.start(ctx, SAVE, "", move |_| {
        let path = free_path(&folder, "plan")?;
        std::fs::write(&path, text).map_err(|e| format!("The plan cannot be written ({e}): {}", path.display()))?;
        saved(path)
    });
}

/// Path of the recorded tool, and true if it lies in a plane; `None` where the coordinate itself was recorded.
pub fn path_of_tool(document: &Document, calibration: &Calibration) -> Option<(MechanismPath, bool)> {
    let recording = &document.recordings.first()?.recording;
    if recording.channel("q_m").or(recording.channel("q_rad")).is_some() {
        return None;
    }
    let path = calibration.analysis.as_ref()?.world.mechanism.as_ref()?.path?;
    Some((path, recording.channel("z_m").is_none()))
}

fn folder_of_recordings(trainer: &Trainer, messages: &mut Messages) -> Option<PathBuf> {
    let folder = trainer.recordings_folder.clone().or_else(folder::of_user);
    if folder.is_none() {
        messages.fail(
            "The system names no folder for recordings; set HOME or XDG_DATA_HOME, then start the program again.",
        );
    }
    folder
}

/// Names of the open recordings that were simulated.
pub fn simulated(document: &Document) -> Vec<&str> {
    let simulated = document.recordings.iter().filter(|p| simulated_object(&p.recording).is_some());
    simulated.map(|p| p.recording.name.as_str()).collect()
}

/// A recording of the experiment was written.
pub(crate) fn performed(session: &mut Session, ctx: &egui::Context, path: &Path) {
    session.messages.say(Tone::Done, format!("Saved {}.", name_of(path)));
    add_experiment(session, ctx, path);
}
