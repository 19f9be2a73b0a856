//! A wrong zero of a joint angle as a hypothesis. Tasks that have a finger's path make its regressor.

use super::hypothesis::{About, Elsewhere};
use super::relations::{Form, Over};

pub(crate) const ID: &str = "joint-offset";

pub(crate) static JOINT_OFFSET: Elsewhere =
    Elsewhere(About { id: ID, form: Form::Exact(&[Over::Path]), ..About::PLAIN });
