//! Plots that stay fast: thinned to what a pixel can show, kept until the view changes.

pub mod axes;
pub mod choices;
pub mod curves;
pub mod data_warnings;
pub mod decimate;
pub mod derived;
pub mod interaction;
pub mod levels;
pub mod line;
pub mod noise;
pub mod plot_cache;
pub mod plot_header;
pub mod plot_input;
pub mod residual_plot;
pub mod residuals;
pub mod shift;
pub mod time_plot;
pub mod title_menu;
pub mod xy;
