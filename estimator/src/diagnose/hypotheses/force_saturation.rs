//! A saturated force channel as a hypothesis. The raw samples show it, no regressor does.

use super::hypothesis::{About, Elsewhere};
use super::relations::Relation;
use super::variable::Variable;

pub(crate) const ID: &str = "force-saturation";

pub(crate) static FORCE_SATURATION: Elsewhere =
    Elsewhere(About { id: ID, relations: &[Relation::NeedsForce], seen: Variable::Force, ..About::PLAIN });
