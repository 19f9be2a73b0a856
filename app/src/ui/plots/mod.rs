//! Plots that stay fast: thinned to what a pixel can show, kept until the view changes.

mod axes;
mod decimate;
mod doubts;
mod row;

pub use axes::{marks, time_axis, value_axis};
pub use decimate::{Levels, decimate};
pub use doubts::places;
pub use row::{GUTTER, PlotCache, RowInput, axis_height, row};
