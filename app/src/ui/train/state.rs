//! The state of Train: the live world, lessons, and the person who practises.

use crate::ui::scene::view::Place;
use crate::ui::train::assistant::state::Assistant;
use crate::ui::train::comfort::Comfort;
use crate::ui::train::learning::Learning;
use crate::ui::train::lessons::state::Lessons;
use crate::ui::train::trainer::live::Trainer;
use haptics::world::World;

/// The live world and all that belongs to training in it.
#[derive(Default)]
pub struct Training {
    /// The live world.
    pub trainer: Trainer,
    /// Settings that make training comfortable.
    pub comfort: Comfort,
    /// Who practises, and how they get better.
    pub learning: Learning,
    /// Settings of the assistant over the trainer's picture.
    pub assistant: Assistant,
    /// Lessons.
    pub lessons: Lessons,
    /// Place at which the trainer's picture was drawn last.
    pub trainer_place: Option<Place>,
    /// A world that was opened from a file, for the trainer to take.
    pub opened_world: Option<Box<World>>,
    /// Set by a panel: the trainer should take the calibrated world.
    pub train_calibrated: bool,
}
