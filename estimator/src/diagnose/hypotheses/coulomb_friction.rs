//! Coulomb friction as a hypothesis.

use super::hypothesis::{About, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use haptics::law::CoulombFriction;

pub(crate) const ID: &str = "coulomb-friction";

impl Hypothesis for CoulombFriction {
    fn about(&self) -> About {
        About {
            id: ID,
            law: Some(&CoulombFriction),
            form: Form::Exact(&[Over::Motion]),
            relations: &[Relation::DryFriction],
            seen: Variable::Velocity,
        }
    }
}
