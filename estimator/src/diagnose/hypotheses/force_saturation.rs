//! A saturated force channel as a hypothesis. The raw samples show it, no regressor does.

use super::hypothesis::Hypothesis;
use super::relations::Relation;
use super::variable::Variable;

pub(crate) const ID: &str = "force-saturation";

pub(crate) struct ForceSaturation;

impl Hypothesis for ForceSaturation {
    fn id(&self) -> &'static str {
        ID
    }

    fn relations(&self) -> &'static [Relation] {
        &[Relation::NeedsForce]
    }

    fn best_seen_against(&self, _planar: bool) -> Variable {
        Variable::Force
    }
}
