//! Structured force that no law of the catalogue describes, as a rival of the causes.

pub(crate) mod competition;
pub(crate) mod evidence;
pub(crate) mod null_model;
pub(crate) mod of_channel;
pub(crate) mod of_coordinate;
pub(crate) mod of_path;
pub(crate) mod smooth;
pub(crate) mod standing;
pub(crate) mod twin;
