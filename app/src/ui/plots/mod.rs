//! Plots that stay fast: thinned to what a pixel can show, kept until the view changes.

mod axes;
mod decimate;
mod doubts;
mod residual_plot;
mod residuals;
mod row;

pub use axes::{decimals, marks, time_axis, value_axis};
pub use decimate::{Levels, decimate};
pub use doubts::places;
pub use residual_plot::{BAND_SIGMAS, cloud_plot, force_plot, has_directions, inks};
pub use residuals::{Cloud, Residuals, Suspect};
pub use row::{GUTTER, PlotCache, RowInput, axis_height, row};
