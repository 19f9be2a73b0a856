//! A grasp that slips as a hypothesis. Tasks with a grasp make its regressor.

use super::hypothesis::Hypothesis;
use super::relations::{Form, Over};

pub(crate) const ID: &str = "fingertip-slip";

pub(crate) struct FingertipSlip;

impl Hypothesis for FingertipSlip {
    fn id(&self) -> &'static str {
        ID
    }

    fn form(&self) -> Form {
        Form::Curve(&[Over::Path])
    }
}
