//! The diagnosis of what is loaded: what is asked, what came out, and the worlds before and after.

use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::refits::replay_forces;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::state::{Answer, DIAGNOSE, Diagnosing, EXTEND, SIMULATE_EXTENDED, ask, extend, reachable};
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::Trainer;
use crate::ui::train::trainer::world_choice::{Compare, WorldChoice};
use estimator::diagnose::{Progress, Worlds};
use std::sync::Arc;

/// Diagnoses in the background.
pub fn diagnose(
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
) {
    if document.recordings.is_empty() {
        return;
    }
    diagnosing.forget();
    jobs.cancel_after(DIAGNOSE);
    let (recordings, choice, from) = (document.recordings.clone(), calibration.choice.clone(), diagnosing.from);
    let job = jobs.start(ctx, DIAGNOSE, "Diagnosing", move |ticket| {
        let ticket = ticket.clone();
        let answer = ask(&recordings, &choice, from, Progress::new(move |share| ticket.goes_on(share)));
        change(|session, _| diagnosed(&mut session.diagnosing, answer))
    });
    job.if_given_up(|session, _| {
        session.diagnosing.problem = Some("The diagnosis was cancelled before it came to an answer.".to_owned());
    });
}

/// The recordings are there: asks again if they came for that.
pub(crate) fn ask_again(session: &mut Session, ctx: &egui::Context) {
    if std::mem::take(&mut session.experiments.asks_again) {
        diagnose(&session.document, &session.calibration, &mut session.diagnosing, &mut session.jobs, ctx);
    }
}

/// Makes the worlds of the base model and of the extended model in the background.
pub fn extend_model(
    document: &Document,
    calibration: &Calibration,
    diagnosing: &Diagnosing,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
) {
    let Some(answer) = diagnosing.answer.clone() else { return };
    let (recordings, choice, from) = (document.recordings.clone(), calibration.choice.clone(), diagnosing.from);
    jobs.start(ctx, EXTEND, "Extending the model", move |_| {
        let worlds = extend(&recordings, &choice, from, &answer);
        change(|session, ctx| extended(&session.document, &mut session.diagnosing, &mut session.jobs, ctx, worlds))
    });
}

/// A diagnosis has ended.
pub(crate) fn diagnosed(diagnosing: &mut Diagnosing, answer: Result<Answer, String>) {
    match answer {
        Ok(answer) => diagnosing.answer = Some(Arc::new(answer)),
        Err(problem) => diagnosing.problem = Some(problem),
    }
}

/// The model was extended.
pub(crate) fn extended(
    document: &Document,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    worlds: Result<Worlds, String>,
) {
    match worlds {
        Ok(worlds) => {
            let worlds = Arc::new(worlds);
            diagnosing.worlds = Some(Arc::clone(&worlds));
            let recordings = document.recordings.clone();
            jobs.start(ctx, SIMULATE_EXTENDED, "Replaying in the extended world", move |_| {
                let replays = replay_forces(&worlds.after, &recordings);
                change(|session, _| session.diagnosing.replays = replays)
            });
        }
        Err(problem) => diagnosing.worlds_problem = Some(problem),
    }
}

/// Takes both worlds into the trainer; what is in the way is said.
pub fn feel(workspace: &mut Workspace, diagnosing: &Diagnosing, trainer: &mut Trainer, messages: &mut Messages) {
    let chosen = comparison(diagnosing).and_then(|compare| {
        trainer.compare = Some(compare);
        trainer.choose(WorldChoice::After)
    });
    match chosen {
        Ok(()) => *workspace = Workspace::Train,
        Err(problem) => messages.fail(problem),
    }
}

/// Worlds that the trainer switches between; an error says why they cannot be felt.
pub fn comparison(diagnosing: &Diagnosing) -> Result<Compare, String> {
    let worlds = diagnosing.worlds.as_ref().ok_or("Extend the model first.")?;
    let world = &worlds.after;
    if world.blocks.is_empty() && world.crank.is_none() {
        return Err("A mechanism that is driven directly has no handle for the hand; save the extended world instead."
            .to_owned());
    }
    Ok(Compare { before: reachable(&worlds.before)?, after: reachable(&worlds.after)? })
}
