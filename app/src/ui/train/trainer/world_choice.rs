//! Choice of the world in the trainer.

use crate::ui::train::trainer::live::Trainer;
use haptics::world::{World, presets};

/// World in the trainer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WorldChoice {
    /// Two blocks to unstack and restack.
    #[default]
    Blocks,
    /// A crank to turn.
    Crank,
    /// A needle on a paper cup.
    Needle,
    /// A barrel on a cable.
    Barrel,
    /// A toggle switch.
    Switch,
    /// A bare table.
    Table,
    /// The world calibrated from the log.
    Calibrated,
    /// A world from a file.
    File,
    /// The base model of a diagnosis.
    Before,
    /// The extended model of a diagnosis.
    After,
}

/// Two worlds that differ in their laws alone, to be felt alternately.
#[derive(Clone, Debug, PartialEq)]
pub struct Compare {
    /// World of the base model.
    pub before: World,
    /// World of the extended model.
    pub after: World,
}

impl WorldChoice {
    /// True for the base and the extended world, which differ in their laws alone.
    fn is_compared(self) -> bool {
        matches!(self, Self::Before | Self::After)
    }

    /// True if the state can be kept on a change to another choice.
    pub(super) fn goes_on_to(self, other: Self) -> bool {
        self != other && self.is_compared() && other.is_compared()
    }

    /// Choice of a built-in world; `None` for others.
    pub fn of(world: &World) -> Option<Self> {
        let built_in = [Self::Blocks, Self::Crank, Self::Needle, Self::Barrel, Self::Switch, Self::Table];
        let nothing_else = Trainer::default();
        built_in.into_iter().find(|choice| nothing_else.world_of(*choice) == *world)
    }
}

impl Trainer {
    /// World in the running trainer, or the one that a start would use.
    pub fn standing_world(&self) -> World {
        self.scene().map_or_else(|| self.world_of(self.choice), |(_, world)| (**world).clone())
    }

    /// World of a choice; the blocks if it is not available.
    pub(super) fn world_of(&self, choice: WorldChoice) -> World {
        match choice {
            WorldChoice::Blocks => presets::stacking(),
            WorldChoice::Crank => presets::crank(),
            WorldChoice::Needle => presets::needle(),
            WorldChoice::Barrel => presets::barrel(),
            WorldChoice::Switch => presets::switch(),
            WorldChoice::Table => presets::table(),
            WorldChoice::Calibrated => self.calibrated.clone().unwrap_or_else(presets::stacking),
            WorldChoice::File => self.file.clone().unwrap_or_else(presets::stacking),
            WorldChoice::Before => self.compare.as_ref().map_or_else(presets::stacking, |c| c.before.clone()),
            WorldChoice::After => self.compare.as_ref().map_or_else(presets::stacking, |c| c.after.clone()),
        }
    }
}
