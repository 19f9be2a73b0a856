//! An experiment that a person does in Train: which world, what is to be done when, the recording of it.

use crate::experiment::perform::what_is_known;
use crate::experiment::simulated::SIMULATED;
use crate::experiment::timetable::{Step, Timetable};
use crate::ui::train::trainer::live::{Operator, Trainer};
use crate::ui::train::trainer::world_choice::WorldChoice;
use estimator::diagnose::{Experiment, Findings};
use haptics::device::HandGoal;
use haptics::recording::Meta;
use haptics::world::World;
use std::path::PathBuf;

/// Progress of a person in an experiment.
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
    /// Timetable of the steps.
    pub table: Timetable,
    /// Progress of the experiment.
    pub phase: Phase,
    /// Object that is simulated for it; `None` where the world of Train stays as it is.
    pub about: Option<String>,
    asked: Experiment,
}

impl Guided {
    /// An experiment that has not begun.
    pub fn new(table: Timetable, asked: Experiment, about: Option<String>) -> Self {
        Self { table, phase: Phase::Ready, about, asked }
    }

    /// The experiment that a diagnosis asks for, in the world that stands in Train.
    pub fn in_world(world: &World, diagnosis: &Findings) -> Result<Self, String> {
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

    /// Current step, its remaining time, s, and the wanted position of the hand.
    pub fn now(&self, trainer: &Trainer) -> Option<(&Step, f64, HandGoal)> {
        let time_s = self.time_s(trainer)?;
        let (step, left_s) = self.table.step_at(time_s)?;
        Some((step, left_s, self.table.route.at(time_s).0))
    }

    /// Metadata that its recording states: the simulated object, and the added mass.
    fn stated(&self) -> Meta {
        let mut stated = Meta { known: what_is_known(&self.asked), ..Meta::default() };
        if let Some(about) = &self.about {
            stated.other.insert(SIMULATED.to_owned(), about.as_str().into());
        }
        stated
    }

    /// Begins from the start, and records.
    pub(crate) fn begin(&mut self, trainer: &mut Trainer) -> Result<(), String> {
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
