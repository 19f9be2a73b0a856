//! A wrong zero of a joint angle as a hypothesis. Tasks that have a finger's path make its regressor.

use super::hypothesis::Hypothesis;
use super::relations::{Form, Over};

pub(crate) const ID: &str = "joint-offset";

pub(crate) struct JointOffset;

impl Hypothesis for JointOffset {
    fn id(&self) -> &'static str {
        ID
    }

    fn form(&self) -> Form {
        Form::Exact(&[Over::Path])
    }
}
