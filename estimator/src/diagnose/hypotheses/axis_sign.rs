//! A mirrored or swapped axis as a hypothesis, which is found before any regression.

use super::hypothesis::{About, Elsewhere};

pub(crate) const ID: &str = "axis-sign";

pub(crate) static AXIS_SIGN: Elsewhere = Elsewhere(About { id: ID, ..About::PLAIN });
