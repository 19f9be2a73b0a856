//! A grasp that slips as a hypothesis. Tasks with a grasp make its regressor.

use super::hypothesis::{About, Elsewhere};
use super::relations::{Form, Over};

pub(crate) const ID: &str = "fingertip-slip";

pub(crate) static FINGERTIP_SLIP: Elsewhere =
    Elsewhere(About { id: ID, form: Form::Curve(&[Over::Path]), ..About::PLAIN });
