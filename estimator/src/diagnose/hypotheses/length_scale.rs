//! A wrong scale of all lengths as a hypothesis. Tasks with known lengths make its regressor.

use super::hypothesis::Hypothesis;
use super::relations::{Form, Over};

pub(crate) const ID: &str = "length-scale";

pub(crate) struct LengthScale;

impl Hypothesis for LengthScale {
    fn id(&self) -> &'static str {
        ID
    }

    fn form(&self) -> Form {
        Form::Exact(&[Over::Path])
    }
}
