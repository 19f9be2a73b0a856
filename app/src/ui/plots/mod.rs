//! Plots that stay fast: thinned to what a pixel can show, kept until the view changes.

mod axes;
pub mod choices;
mod curves;
mod decimate;
mod derived;
mod doubts;
mod gutter;
mod levels;
mod line;
mod noise;
mod react;
mod residual_plot;
mod residuals;
mod row;
pub mod shift;
mod title_menu;
mod xy;

pub use axes::{AXIS_WIDTH, decimals, marks, time_axis, value_axis};
pub use choices::{LogView, PlotChoices};
pub use curves::{Drawn, Layer, Sources, can_compare, curves};
pub use decimate::{Columns, decimate, decimate_in};
pub use derived::Recipe;
pub use doubts::places;
pub use levels::{Levels, Samples};
pub use residual_plot::{BAND_SIGMAS, cloud_plot, force_plot, has_directions, inks};
pub use residuals::{Cloud, Residuals, Suspect};
pub use row::{GUTTER, PlotCache, RowInput, RowKind, axis_height, row};
pub use xy::{XyCache, XyInput, xy_plot};
