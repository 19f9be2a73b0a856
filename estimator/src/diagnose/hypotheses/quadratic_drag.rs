//! Quadratic drag as a hypothesis.

use super::hypothesis::Hypothesis;
use super::relations::{Form, Over};
use super::variable::Variable;
use haptics::law::{Law, QuadraticDrag};

pub(crate) const ID: &str = "quadratic-drag";

impl Hypothesis for QuadraticDrag {
    fn id(&self) -> &'static str {
        ID
    }

    fn law(&self) -> Option<&'static dyn Law> {
        Some(&QuadraticDrag)
    }

    fn form(&self) -> Form {
        Form::Curve(&[Over::Motion])
    }

    fn best_seen_against(&self, _planar: bool) -> Variable {
        Variable::Velocity
    }
}
