//! Which world is touched.

use crate::ui::trainer::live::Trainer;
use haptics::world::{World, presets};

/// Which world is touched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WorldChoice {
    /// Two blocks to be unstacked and restacked.
    #[default]
    Blocks,
    /// A crank to be turned.
    Crank,
    /// A needle on a paper cup.
    Needle,
    /// A barrel on a cable.
    Barrel,
    /// A toggle switch.
    Switch,
    /// A bare table.
    Table,
    /// The world that was measured from the log.
    Calibrated,
    /// A world from a file.
    File,
    /// The model that was diagnosed.
    Before,
    /// The same with what was found.
    After,
}

/// Two worlds that differ in their laws alone, to be felt by turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Compare {
    /// The model that was diagnosed.
    pub before: World,
    /// The same with what was found.
    pub after: World,
}

impl WorldChoice {
    /// One of two worlds that differ in their laws alone.
    fn is_compared(self) -> bool {
        matches!(self, Self::Before | Self::After)
    }

    /// True when everything can stay where it is on the way to another choice.
    pub(super) fn goes_on_to(self, other: Self) -> bool {
        self != other && self.is_compared() && other.is_compared()
    }

    /// The built-in world that this one is, if it is one.
    pub fn of(world: &World) -> Option<Self> {
        let built_in = [Self::Blocks, Self::Crank, Self::Needle, Self::Barrel, Self::Switch, Self::Table];
        let nothing_else = Trainer::default();
        built_in.into_iter().find(|choice| nothing_else.world_of(*choice) == *world)
    }
}

impl Trainer {
    /// The world that is touched, or would be.
    pub fn standing_world(&self) -> World {
        self.scene().map_or_else(|| self.world_of(self.choice), |(_, world)| (**world).clone())
    }

    /// The world of a choice; the blocks where the choice has none.
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
