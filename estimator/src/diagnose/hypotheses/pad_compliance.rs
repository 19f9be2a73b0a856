//! Give of the pads as a hypothesis. Tasks with pads make its regressor.

use super::hypothesis::{About, Elsewhere};
use super::relations::{Form, Over};

pub(crate) const ID: &str = "pad-compliance";

pub(crate) static PAD_COMPLIANCE: Elsewhere =
    Elsewhere(About { id: ID, form: Form::Exact(&[Over::Path]), ..About::PLAIN });
