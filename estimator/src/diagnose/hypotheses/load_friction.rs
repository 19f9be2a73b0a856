//! Friction in proportion to the load as a hypothesis, if the recording has a load.

use super::candidate::Candidate;
use super::hypothesis::Hypothesis;
use super::library::Dictionary;
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use haptics::law::{Law, LoadFriction};

pub(crate) const ID: &str = "load-friction";

impl Hypothesis for LoadFriction {
    fn id(&self) -> &'static str {
        ID
    }

    fn law(&self) -> Option<&'static dyn Law> {
        Some(&LoadFriction)
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        data.track.planar.then(|| data.plain(&LoadFriction, &[1.0], 0).positive()).into_iter().collect()
    }

    fn form(&self) -> Form {
        Form::Exact(&[Over::Motion])
    }

    fn relations(&self) -> &'static [Relation] {
        &[Relation::DryFriction]
    }

    fn best_seen_against(&self, _planar: bool) -> Variable {
        Variable::Across
    }
}
