//! The experiment that a diagnosis asks for: rehearsed on simulated objects, done by a person in Train, or loaded from a file.

use super::files::{SAVE, saved};
use super::guided::Guided;
use super::jobs::{change, no_change};
use super::session::Session;
use crate::experiment::motion_plan::MotionPlan;
use crate::experiment::rehearse::Rehearsal;
use crate::experiment::simulated::simulated_object;
use crate::recorder::folder;
use crate::text::file_name::name_of;
use crate::ui::experiments::{GUIDE, REHEARSE, ROUNDS, Stage, free_path, guided_as_if, rehearse_now, write};
use crate::ui::message_list::Tone;
use crate::ui::workspace::Workspace;
use haptics::law::Coordinate;
use haptics::world::MechanismPath;
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl Session {
    /// Rehearses the experiment in the background.
    pub fn rehearse(&mut self, ctx: &egui::Context) {
        let Some(answer) = self.diagnosing.answer.clone() else { return };
        (self.diagnosing.rehearsal, self.diagnosing.rehearsal_problem) = (None, None);
        let (recordings, choice) = (self.document.recordings.clone(), self.calibration.choice.clone());
        self.jobs.start(ctx, REHEARSE, "Rehearsing the experiment", move |ticket| {
            let rehearsal = match rehearse_now(&recordings, &choice, &answer, ROUNDS, &|share| ticket.goes_on(share)) {
                Err(None) => return no_change(),
                Err(Some(problem)) => Err(problem),
                Ok(rehearsal) => Ok(rehearsal),
            };
            change(|session: &mut Self, _| session.rehearsed(rehearsal))
        });
    }

    /// A rehearsal has ended.
    pub(super) fn rehearsed(&mut self, rehearsal: Result<Rehearsal, String>) {
        match rehearsal {
            Ok(rehearsal) => self.diagnosing.rehearsal = Some(Arc::new(rehearsal)),
            Err(problem) => self.diagnosing.rehearsal_problem = Some(problem),
        }
    }

    /// Takes the experiment to Train, for a person to do; what has to be computed for it, in the background.
    pub fn guide(&mut self, ctx: &egui::Context, stage: Stage) {
        let Some(answer) = self.diagnosing.answer.clone() else { return };
        let (recordings, choice) = (self.document.recordings.clone(), self.calibration.choice.clone());
        let standing = self.training.trainer.standing_world();
        self.jobs.start(ctx, GUIDE, "Preparing the experiment", move |_| {
            let guided = match stage {
                Stage::AsIf(id) => guided_as_if(&recordings, &choice, &answer, &id),
                Stage::AsItStands => Guided::in_world(&standing, &answer.diagnosis),
            };
            change(|session: &mut Self, _| session.guided(guided))
        });
    }

    /// The experiment is ready for a person.
    pub(super) fn guided(&mut self, guided: Result<Guided, String>) {
        match guided.and_then(|guided| guided.take_over(&mut self.training.trainer).map(|()| guided)) {
            Ok(guided) => {
                self.experiments.guided = Some(Box::new(guided));
                self.workspace = Workspace::Train;
            }
            Err(problem) => self.messages.fail(problem),
        }
    }

    /// Adds a recording of the experiment to those that are diagnosed, and asks again.
    pub fn add_experiment(&mut self, ctx: &egui::Context, path: &Path) {
        if self.document.sources.is_empty() {
            self.messages.fail("The recordings that were diagnosed are no files; save them first, then add this one.");
            return;
        }
        self.experiments.asks_again = true;
        self.experiments.path_field.clear();
        self.workspace = Workspace::Diagnose;
        self.add_log(ctx, path);
    }

    /// Writes a rehearsed recording into the folder of recordings and adds it, as what it is: a simulation.
    pub fn add_rehearsed(&mut self, ctx: &egui::Context, outcome: usize) {
        let rehearsal = self.diagnosing.rehearsal.clone();
        let round = rehearsal.as_ref().and_then(|r| r.outcomes.get(outcome)?.rounds.first());
        let Some(recording) = round.map(|r| r.recording.clone()) else { return };
        let Some(folder) = self.folder_of_recordings() else { return };
        self.jobs.start(ctx, SAVE, "", move |_| {
            let path = write(&folder, recording)?;
            change(move |session: &mut Self, ctx| session.performed(ctx, &path))
        });
    }

    /// Writes the plan of a mechanism's motion into the folder of recordings.
    pub fn save_motion_plan(&mut self, ctx: &egui::Context, plan: &MotionPlan, coordinate: Coordinate) {
        let Some(folder) = self.folder_of_recordings() else { return };
        let text = match self.path_of_tool() {
            Some((path, is_planar)) => plan.places_to_csv(&path, is_planar),
            None => plan.to_csv(coordinate),
        };
        self.jobs.start(ctx, SAVE, "", move |_| {
            let path = free_path(&folder, "plan")?;
            std::fs::write(&path, text).map_err(|e| format!("The plan cannot be written ({e}): {}", path.display()))?;
            saved(path)
        });
    }

    /// Where the tool went that was recorded, and whether in a plane; nothing where the coordinate itself was recorded.
    pub fn path_of_tool(&self) -> Option<(MechanismPath, bool)> {
        let recording = &self.document.recordings.first()?.recording;
        if recording.channel("q_m").or(recording.channel("q_rad")).is_some() {
            return None;
        }
        let path = self.calibration.analysis.as_ref()?.world.mechanism.as_ref()?.path?;
        Some((path, recording.channel("z_m").is_none()))
    }

    fn folder_of_recordings(&mut self) -> Option<PathBuf> {
        let folder = self.training.trainer.recordings_folder.clone().or_else(folder::of_user);
        if folder.is_none() {
            self.messages.fail(
                "The system names no folder for recordings; set HOME or XDG_DATA_HOME, then start the program again.",
            );
        }
        folder
    }

    /// Which of the open recordings were simulated.
    pub fn simulated(&self) -> Vec<&str> {
        let simulated = self.document.recordings.iter().filter(|p| simulated_object(&p.recording).is_some());
        simulated.map(|p| p.recording.name.as_str()).collect()
    }

    /// The recordings are there: asks again if they came for that.
    pub(super) fn ask_again(&mut self, ctx: &egui::Context) {
        if std::mem::take(&mut self.experiments.asks_again) {
            self.diagnose(ctx);
        }
    }

    /// A recording of the experiment was written.
    pub(super) fn performed(&mut self, ctx: &egui::Context, path: &Path) {
        self.messages.say(Tone::Done, format!("Saved {}.", name_of(path)));
        self.add_experiment(ctx, path);
    }
}
