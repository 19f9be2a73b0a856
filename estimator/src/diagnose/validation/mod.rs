pub(crate) mod on_other_recordings;
pub(crate) mod twins;
