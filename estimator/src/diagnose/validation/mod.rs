pub(crate) mod fitted_terms;
pub(crate) mod on_other_recordings;
