//! An experiment that a person does in Train: which world, what is to be done when, the recording of it.

use super::jobs::change;
use super::recorder::RECORD;
use super::session::Session;
use crate::experiment::perform::what_is_known;
use crate::experiment::simulated::SIMULATED;
use crate::experiment::timetable::{Step, Timetable};
use crate::ui::trainer::choice::WorldChoice;
use crate::ui::trainer::live::{Operator, Trainer};
use estimator::diagnose::{Diagnosis, Experiment};
use haptics::device::HandGoal;
use haptics::recording::Meta;
use haptics::world::World;
use std::path::PathBuf;

/// How far a person is.
#[derive(Clone, Debug, PartialEq)]
pub enum Phase {
    /// Nothing has begun.
    Ready,
    /// The experiment began at a time of the world, s, and is recorded.
    Going(f64),
    /// The file gets its end.
    Ending,
    /// It is there.
    Recorded(PathBuf),
}

/// The experiment, and how far it is.
#[derive(Clone, Debug)]
pub struct Guided {
    /// What is to be done when.
    pub table: Timetable,
    /// How far it is.
    pub phase: Phase,
    /// Which object is simulated for it; nothing where the world of Train stays what it is.
    pub about: Option<String>,
    asked: Experiment,
}

impl Guided {
    /// An experiment that has not begun.
    pub fn new(table: Timetable, asked: Experiment, about: Option<String>) -> Self {
        Self { table, phase: Phase::Ready, about, asked }
    }

    /// What a diagnosis asks for, in the world that stands in Train.
    pub fn in_world(world: &World, diagnosis: &Diagnosis) -> Result<Self, String> {
        let next = diagnosis.next_experiment.as_ref().ok_or("Nothing is open.")?;
        let asked = next.experiment.as_ref().ok_or("This experiment is known in words only.")?;
        Ok(Self::new(Timetable::new(world, asked, &next.motion)?, asked.clone(), None))
    }

    /// The weight that is hung on the object, N.
    pub fn hung_n(&self) -> f64 {
        self.asked.added_weight_n
    }

    /// Puts its world into the trainer, for a person.
    pub fn take_over(&self, trainer: &mut Trainer) -> Result<(), String> {
        trainer.file = Some(self.table.world.clone());
        (trainer.operator, trainer.choice) = (Operator::You, WorldChoice::File);
        trainer.restart()
    }

    /// Time since the beginning, s; nothing while it does not run.
    pub fn time_s(&self, trainer: &Trainer) -> Option<f64> {
        let Phase::Going(start_s) = self.phase else { return None };
        Some(trainer.scene()?.0.state.time_s - start_s)
    }

    /// What is to be done now, how long still, s, and where the hand is wanted.
    pub fn now(&self, trainer: &Trainer) -> Option<(&Step, f64, HandGoal)> {
        let time_s = self.time_s(trainer)?;
        let (step, left_s) = self.table.step_at(time_s)?;
        Some((step, left_s, self.table.route.at(time_s).0))
    }

    /// What its recording states of itself: what was simulated, and what was hung on.
    fn stated(&self) -> Meta {
        let mut stated = Meta { known: what_is_known(&self.asked), ..Meta::default() };
        if let Some(about) = &self.about {
            stated.other.insert(SIMULATED.to_owned(), about.as_str().into());
        }
        stated
    }

    /// Begins from the start, and records.
    fn begin(&mut self, trainer: &mut Trainer) -> Result<(), String> {
        trainer.discard_recording();
        self.take_over(trainer)?;
        trainer.stated = self.stated();
        let begun = trainer.start_recording();
        trainer.stated = Meta::default();
        begun?;
        self.phase = Phase::Going(trainer.scene().map_or(0.0, |(snapshot, _)| snapshot.state.time_s));
        Ok(())
    }
}

impl Session {
    /// Begins the experiment that is ready, or begins it again.
    pub fn begin_experiment(&mut self) {
        let Some(guided) = &mut self.experiments.guided else { return };
        if let Err(problem) = guided.begin(&mut self.trainer) {
            guided.phase = Phase::Ready;
            self.fail(problem);
        }
    }

    /// Leaves the experiment; a recording that is not over is removed.
    pub fn leave_experiment(&mut self) {
        let guided = self.experiments.guided.take();
        if guided.is_some_and(|g| matches!(g.phase, Phase::Going(_))) {
            self.trainer.discard_recording();
        }
    }

    /// Once a frame: ends the experiment when its time is over.
    pub(super) fn follow_experiment(&mut self, ctx: &egui::Context) {
        let Some(guided) = &mut self.experiments.guided else { return };
        let Some(time_s) = guided.time_s(&self.trainer) else { return };
        if !self.trainer.is_recording() {
            // Another world was chosen, or the disk is full: what there is of it was saved and said.
            guided.phase = Phase::Ready;
            return;
        }
        if time_s < guided.table.duration_s() {
            return;
        }
        guided.phase = Phase::Ending;
        let Some(stopping) = self.trainer.stop_recording() else { return };
        self.jobs.start(ctx, RECORD, "", move |_| {
            let path = stopping.wait().map(|finished| finished.path);
            change(|session: &mut Self, _| session.followed(path))
        });
    }

    /// The recording of the experiment has its end.
    pub(super) fn followed(&mut self, path: Result<PathBuf, String>) {
        let phase = match path {
            Ok(path) => Phase::Recorded(path),
            Err(problem) => {
                self.fail(problem);
                Phase::Ready
            }
        };
        if let Some(guided) = &mut self.experiments.guided {
            guided.phase = phase;
        }
    }

    /// A hand on the mouse that follows the rings, for pictures and tests: the trainer's clock must be a manual one.
    pub fn follow_rings(&mut self, seconds: f64) {
        const FRAME_S: f64 = 1.0 / 60.0;
        let mut left_s = seconds;
        while left_s > 0.0 {
            let Some(guided) = &self.experiments.guided else { return };
            let Some((step, _, goal)) = guided.now(&self.trainer) else { return };
            let (holds, firmer_n) = (step.holds, goal.pinch_n - self.trainer.pinch.strength_n());
            let pinch = &mut self.trainer.pinch;
            pinch.move_to(goal.center_m);
            pinch.button = holds;
            if holds && firmer_n > 0.0 {
                pinch.strengthen(firmer_n);
            }
            self.trainer.advance(FRAME_S);
            left_s -= FRAME_S;
        }
    }

    /// Adds the recorded experiment to the diagnosis.
    pub fn add_followed(&mut self, ctx: &egui::Context) {
        let Some(guided) = self.experiments.guided.take() else { return };
        if let Phase::Recorded(path) = guided.phase {
            self.add_experiment(ctx, &path);
        }
    }
}
