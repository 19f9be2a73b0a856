//! Inertia as a hypothesis.

use super::hypothesis::{About, Hypothesis};
use super::relations::Relation;
use super::variable::Variable;
use haptics::law::Inertia;

pub(crate) const ID: &str = "inertia";

impl Hypothesis for Inertia {
    fn about(&self) -> About {
        About {
            id: ID,
            law: Some(&Inertia),
            relations: &[Relation::NeedsForce],
            seen: Variable::Acceleration,
            ..About::PLAIN
        }
    }
}
