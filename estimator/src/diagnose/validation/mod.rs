pub(crate) mod on_other_recordings;
