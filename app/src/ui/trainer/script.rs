//! The scripted operator as it was chosen: a level of skill, and what it does wrong on purpose.

use crate::operator;
use haptics::device::{Act, Mistake, ScriptedOperator, Skill};
use haptics::world::{State, World};
use std::sync::Arc;

/// How well the scripted operator does it, and what it does wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// The level by its name in [`operator::LEVELS`].
    pub level: &'static str,
    /// The deliberate mistake; left out in worlds that give no occasion for it.
    pub mistake: Option<Mistake>,
    /// What it is told to do, as an expert; nothing: the task of the world.
    pub acts: Option<Arc<[Act]>>,
}

impl Default for Script {
    fn default() -> Self {
        Self { level: operator::USUAL, mistake: None, acts: None }
    }
}

impl Script {
    /// The mistake that will be made in this world.
    pub fn mistake_in(&self, world: &World) -> Option<Mistake> {
        self.mistake.filter(|mistake| operator::mistakes_in(world).contains(mistake))
    }

    /// The operator for a world.
    pub fn operator(&self, world: &World, state: &State, seed: u64) -> ScriptedOperator {
        if let Some(acts) = &self.acts {
            return ScriptedOperator::doing(world, state, acts, Skill::expert(), seed);
        }
        let skill = Skill::from_name(self.level).unwrap_or_default();
        let mistakes: Vec<Mistake> = self.mistake_in(world).into_iter().collect();
        ScriptedOperator::with_mistakes(world, state, skill, &mistakes, seed)
    }
}
