//! Quadratic drag as a hypothesis.

use super::hypothesis::{About, Hypothesis};
use super::relations::{Form, Over};
use super::variable::Variable;
use haptics::law::QuadraticDrag;

pub(crate) const ID: &str = "quadratic-drag";

impl Hypothesis for QuadraticDrag {
    fn about(&self) -> About {
        About {
            id: ID,
            law: Some(&QuadraticDrag),
            form: Form::Curve(&[Over::Motion]),
            seen: Variable::Velocity,
            ..About::PLAIN
        }
    }
}
