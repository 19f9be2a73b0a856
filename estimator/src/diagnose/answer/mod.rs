pub(crate) mod along_coordinate;
pub mod atlas;
pub(crate) mod build;
pub(crate) mod excitation;
pub(crate) mod rejected;
pub(crate) mod residual_table;
pub(crate) mod resolved_questions;
pub mod time_series;
