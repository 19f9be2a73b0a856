//! Friction in proportion to the load as a hypothesis, if the recording has a load.

use super::candidate::Candidate;
use super::dictionary::Dictionary;
use super::hypothesis::{About, Hypothesis};
use super::relations::{Form, Over, Relation};
use super::variable::Variable;
use haptics::law::LoadFriction;

pub(crate) const ID: &str = "load-friction";

impl Hypothesis for LoadFriction {
    fn about(&self) -> About {
        About {
            id: ID,
            law: Some(&LoadFriction),
            form: Form::Exact(&[Over::Motion]),
            relations: &[Relation::DryFriction],
            seen: Variable::Across,
        }
    }

    fn candidates(&self, data: &Dictionary<'_>) -> Vec<Candidate> {
        data.track.planar.then(|| data.plain(&LoadFriction, &[1.0], 0).positive()).into_iter().collect()
    }
}
