//! The chosen scripted operator: a skill level, and deliberate mistakes.

use crate::operator;
use haptics::device::{Act, Mistake, ScriptedOperator, Skill};
use haptics::world::{State, World};
use std::sync::Arc;

/// Skill and mistakes of the scripted operator.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// Name of the level in [`operator::LEVELS`].
    pub level: &'static str,
    /// Deliberate mistake; ignored in worlds without an opportunity for it.
    pub mistake: Option<Mistake>,
    /// Acts that it performs as an expert; `None` for the task of the world.
    pub acts: Option<Arc<[Act]>>,
}

impl Default for Script {
    fn default() -> Self {
        Self { level: operator::USUAL, mistake: None, acts: None }
    }
}

impl Script {
    /// Mistake that will be made in this world.
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
