//! A faulty channel as a hypothesis. The raw samples show it, no regressor does.

use super::hypothesis::{About, Elsewhere};

pub(crate) const ID: &str = "channel-fault";

pub(crate) static CHANNEL_FAULT: Elsewhere = Elsewhere(About { id: ID, ..About::PLAIN });
