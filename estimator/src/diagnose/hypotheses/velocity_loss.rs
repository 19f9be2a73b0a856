//! Loss of velocity in an impact as a hypothesis. The thrown body makes its regressor.

use super::hypothesis::{About, Elsewhere};

pub(crate) const ID: &str = "velocity-loss";

pub(crate) static VELOCITY_LOSS: Elsewhere = Elsewhere(About { id: ID, ..About::PLAIN });
