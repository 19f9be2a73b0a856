//! Coulomb friction as a hypothesis.

use super::hypothesis::Hypothesis;
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use haptics::law::{CoulombFriction, Law};

pub(crate) const ID: &str = "coulomb-friction";

impl Hypothesis for CoulombFriction {
    fn id(&self) -> &'static str {
        ID
    }

    fn law(&self) -> Option<&'static dyn Law> {
        Some(&CoulombFriction)
    }

    fn form(&self) -> Form {
        Form::Exact(&[Over::Motion])
    }

    fn relations(&self) -> &'static [Relation] {
        &[Relation::DryFriction]
    }

    fn best_seen_against(&self, _planar: bool) -> Variable {
        Variable::Velocity
    }
}
