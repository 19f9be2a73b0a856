//! The diagnosis of what is loaded: what is asked, what came out, and the worlds before and after.

use super::jobs::change;
use super::session::Session;
use crate::ui::diagnosis_state::{Answer, DIAGNOSE, EXTEND, SIMULATE_EXTENDED, ask, extend, reachable};
use crate::ui::refits::replay_forces;
use crate::ui::trainer::choice::{Compare, WorldChoice};
use crate::ui::workspace::Workspace;
use estimator::diagnose::{Progress, Worlds};
use std::sync::Arc;

impl Session {
    /// Diagnoses in the background.
    pub fn diagnose(&mut self, ctx: &egui::Context) {
        if self.document.recordings.is_empty() {
            return;
        }
        self.diagnosing.forget();
        self.jobs.cancel_after(DIAGNOSE);
        let (recordings, choice, from) =
            (self.document.recordings.clone(), self.calibration.choice.clone(), self.diagnosing.from);
        let job = self.jobs.start(ctx, DIAGNOSE, "Diagnosing", move |ticket| {
            let ticket = ticket.clone();
            let answer = ask(&recordings, &choice, from, Progress::new(move |share| ticket.goes_on(share)));
            change(|session: &mut Self, _| session.diagnosed(answer))
        });
        job.if_given_up(|session: &mut Self, _| {
            session.diagnosing.problem = Some("The diagnosis was cancelled before it came to an answer.".to_owned());
        });
    }

    /// Makes the worlds without and with what was found, in the background.
    pub fn extend_model(&mut self, ctx: &egui::Context) {
        let Some(answer) = self.diagnosing.answer.clone() else { return };
        let (recordings, choice, from) =
            (self.document.recordings.clone(), self.calibration.choice.clone(), self.diagnosing.from);
        self.jobs.start(ctx, EXTEND, "Extending the model", move |_| {
            let worlds = extend(&recordings, &choice, from, &answer);
            change(|session: &mut Self, ctx| session.extended(ctx, worlds))
        });
    }

    /// A diagnosis has ended.
    pub(super) fn diagnosed(&mut self, answer: Result<Answer, String>) {
        match answer {
            Ok(answer) => self.diagnosing.answer = Some(Arc::new(answer)),
            Err(problem) => self.diagnosing.problem = Some(problem),
        }
    }

    /// The model was extended.
    pub(super) fn extended(&mut self, ctx: &egui::Context, worlds: Result<Worlds, String>) {
        match worlds {
            Ok(worlds) => {
                let worlds = Arc::new(worlds);
                self.diagnosing.worlds = Some(Arc::clone(&worlds));
                let recordings = self.document.recordings.clone();
                self.jobs.start(ctx, SIMULATE_EXTENDED, "Replaying in the extended world", move |_| {
                    let replays = replay_forces(&worlds.after, &recordings);
                    change(|session: &mut Self, _| session.diagnosing.replays = replays)
                });
            }
            Err(problem) => self.diagnosing.worlds_problem = Some(problem),
        }
    }

    /// Takes both worlds into the trainer; what is in the way is said.
    pub fn feel(&mut self) {
        let chosen = self.comparison().and_then(|compare| {
            self.training.trainer.compare = Some(compare);
            self.training.trainer.choose(WorldChoice::After)
        });
        match chosen {
            Ok(()) => self.workspace = Workspace::Train,
            Err(problem) => self.messages.fail(problem),
        }
    }

    /// What the trainer switches between; an error says why the worlds cannot be felt.
    pub fn comparison(&self) -> Result<Compare, String> {
        let worlds = self.diagnosing.worlds.as_ref().ok_or("Extend the model first.")?;
        let world = &worlds.after;
        if world.blocks.is_empty() && world.crank.is_none() {
            return Err(
                "A mechanism that is driven directly has no handle for the hand; save the extended world instead."
                    .to_owned(),
            );
        }
        Ok(Compare { before: reachable(&worlds.before)?, after: reachable(&worlds.after)? })
    }
}
