//! Viscous friction as a hypothesis.

use super::hypothesis::Hypothesis;
use super::relations::{Form, Over};
use super::variable::Variable;
use haptics::law::{Law, ViscousFriction};

pub(crate) const ID: &str = "viscous-friction";

impl Hypothesis for ViscousFriction {
    fn id(&self) -> &'static str {
        ID
    }

    fn law(&self) -> Option<&'static dyn Law> {
        Some(&ViscousFriction)
    }

    fn form(&self) -> Form {
        Form::Exact(&[Over::Motion])
    }

    fn best_seen_against(&self, _planar: bool) -> Variable {
        Variable::Velocity
    }
}
