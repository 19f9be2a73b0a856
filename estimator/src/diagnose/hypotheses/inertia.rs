//! Inertia as a hypothesis.

use super::hypothesis::Hypothesis;
use super::relations::Relation;
use super::variable::Variable;
use haptics::law::{Inertia, Law};

pub(crate) const ID: &str = "inertia";

impl Hypothesis for Inertia {
    fn id(&self) -> &'static str {
        ID
    }

    fn law(&self) -> Option<&'static dyn Law> {
        Some(&Inertia)
    }

    fn relations(&self) -> &'static [Relation] {
        &[Relation::NeedsForce]
    }

    fn best_seen_against(&self, _planar: bool) -> Variable {
        Variable::Acceleration
    }
}
