//! A stiffness that rises with the load as a hypothesis. Tasks with a contact make its regressor.

use super::hypothesis::{About, Elsewhere};

pub(crate) const ID: &str = "stiffness-hardening";

pub(crate) static STIFFNESS_HARDENING: Elsewhere = Elsewhere(About { id: ID, ..About::PLAIN });
