//! Viscous friction as a hypothesis.

use super::hypothesis::{About, Hypothesis};
use super::relations::{Form, Over};
use super::variable::Variable;
use haptics::law::ViscousFriction;

pub(crate) const ID: &str = "viscous-friction";

impl Hypothesis for ViscousFriction {
    fn about(&self) -> About {
        About {
            id: ID,
            law: Some(&ViscousFriction),
            form: Form::Exact(&[Over::Motion]),
            seen: Variable::Velocity,
            ..About::PLAIN
        }
    }
}
