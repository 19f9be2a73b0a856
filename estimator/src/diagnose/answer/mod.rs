pub mod atlas;
pub(crate) mod build;
pub(crate) mod cause;
pub(crate) mod named;
pub(crate) mod part;
pub(crate) mod put_back;
pub(crate) mod resolved_questions;
pub mod time_series;
