//! Plots that stay fast: thinned to what a pixel can show, kept until the view changes.

pub mod axes;
pub mod choices;
pub mod curves;
pub mod decimate;
pub mod derived;
pub mod doubts;
pub mod gutter;
pub mod levels;
pub mod line;
pub mod noise;
pub mod react;
pub mod residual_plot;
pub mod residuals;
pub mod row;
pub mod shift;
pub mod title_menu;
pub mod xy;
