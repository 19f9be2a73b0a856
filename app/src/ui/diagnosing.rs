//! The diagnosis of what is loaded: what is asked, what came out, and the worlds before and after.

use super::session::{Session, change};
use crate::ui::diagnosis_state::{Answer, DIAGNOSE, EXTEND, SIMULATE_EXTENDED, ask, extend, reachable};
use crate::ui::refits::replay_forces;
use crate::ui::trainer::choice::{Compare, WorldChoice};
use crate::ui::workspace::Workspace;
use estimator::diagnose::{Progress, Worlds};
use std::sync::Arc;

/// Diagnoses in the background.
pub fn diagnose(session: &mut Session, ctx: &egui::Context) {
    if session.document.recordings.is_empty() {
        return;
    }
    session.diagnosing.forget();
    session.jobs.cancel_after(DIAGNOSE);
    let (recordings, choice, from) =
        (session.document.recordings.clone(), session.calibration.choice.clone(), session.diagnosing.from);
    let job = session.jobs.start(ctx, DIAGNOSE, "Diagnosing", move |ticket| {
        let ticket = ticket.clone();
        let answer = ask(&recordings, &choice, from, Progress::new(move |share| ticket.goes_on(share)));
        change(|session, _| diagnosed(session, answer))
    });
    job.if_given_up(|session, _| {
        session.diagnosing.problem = Some("The diagnosis was cancelled before it came to an answer.".to_owned());
    });
}

/// Makes the worlds of the base model and of the extended model in the background.
pub fn extend_model(session: &mut Session, ctx: &egui::Context) {
    let Some(answer) = session.diagnosing.answer.clone() else { return };
    let (recordings, choice, from) =
        (session.document.recordings.clone(), session.calibration.choice.clone(), session.diagnosing.from);
    session.jobs.start(ctx, EXTEND, "Extending the model", move |_| {
        let worlds = extend(&recordings, &choice, from, &answer);
        change(|session, ctx| extended(session, ctx, worlds))
    });
}

/// A diagnosis has ended.
pub(crate) fn diagnosed(session: &mut Session, answer: Result<Answer, String>) {
    match answer {
        Ok(answer) => session.diagnosing.answer = Some(Arc::new(answer)),
        Err(problem) => session.diagnosing.problem = Some(problem),
    }
}

/// The model was extended.
pub(crate) fn extended(session: &mut Session, ctx: &egui::Context, worlds: Result<Worlds, String>) {
    match worlds {
        Ok(worlds) => {
            let worlds = Arc::new(worlds);
            session.diagnosing.worlds = Some(Arc::clone(&worlds));
            let recordings = session.document.recordings.clone();
            session.jobs.start(ctx, SIMULATE_EXTENDED, "Replaying in the extended world", move |_| {
                let replays = replay_forces(&worlds.after, &recordings);
                change(|session, _| session.diagnosing.replays = replays)
            });
        }
        Err(problem) => session.diagnosing.worlds_problem = Some(problem),
    }
}

/// Takes both worlds into the trainer; what is in the way is said.
pub fn feel(session: &mut Session) {
    let chosen = comparison(session).and_then(|compare| {
        session.training.trainer.compare = Some(compare);
        session.training.trainer.choose(WorldChoice::After)
    });
    match chosen {
        Ok(()) => session.workspace = Workspace::Train,
        Err(problem) => session.messages.fail(problem),
    }
}

/// Worlds that the trainer switches between; an error says why they cannot be felt.
pub fn comparison(session: &Session) -> Result<Compare, String> {
    let worlds = session.diagnosing.worlds.as_ref().ok_or("Extend the model first.")?;
    let world = &worlds.after;
    if world.blocks.is_empty() && world.crank.is_none() {
        return Err("A mechanism that is driven directly has no handle for the hand; save the extended world instead."
            .to_owned());
    }
    Ok(Compare { before: reachable(&worlds.before)?, after: reachable(&worlds.after)? })
}
