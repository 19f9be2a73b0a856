//! Give of the pads as a hypothesis. Tasks with pads make its regressor.

use super::hypothesis::Hypothesis;
use super::relations::{Form, Over};

pub(crate) const ID: &str = "pad-compliance";

pub(crate) struct PadCompliance;

impl Hypothesis for PadCompliance {
    fn id(&self) -> &'static str {
        ID
    }

    fn form(&self) -> Form {
        Form::Exact(&[Over::Path])
    }
}
