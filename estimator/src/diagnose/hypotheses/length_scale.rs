//! A wrong scale of all lengths as a hypothesis. Tasks with known lengths make its regressor.

use super::hypothesis::{About, Elsewhere};
use super::relations::{Form, Over};

pub(crate) const ID: &str = "length-scale";

pub(crate) static LENGTH_SCALE: Elsewhere =
    Elsewhere(About { id: ID, form: Form::Exact(&[Over::Path]), ..About::PLAIN });
