//! Draws the curves of a diagnosis.

use super::axes::{still_plot, time_axis, variable_axis};
use super::residuals::{Cloud, Residuals, Suspect};
use crate::ui::kit::theme::{Palette, palette, role};
use egui::{Color32, Sense, Ui};
use egui_plot::{FilledArea, Line, LineStyle, Plot, PlotBounds, PlotPoint, PlotPoints, Points};
use render::ColorRole;
use std::fmt::Debug;
use std::hash::Hash;

/// Half-width of the noise band, standard deviations.
pub const BAND_SIGMAS: f64 = 2.0;

/// Colours of the curves.
#[derive(Clone, Copy, Debug)]
pub struct Inks {
    /// Colour of the measurement.
    pub measured: Color32,
    /// Colour of the base model.
    pub model: Color32,
    /// Colour of the extended model.
    pub extended: Color32,
    /// Colour of the noise band.
    pub noise: Color32,
}

/// The colours of the theme.
pub fn inks(ui: &Ui) -> Inks {
    let (dark, p) = (ui.visuals().dark_mode, palette(ui));
    Inks {
        measured: role(dark, ColorRole::Measured),
        model: role(dark, ColorRole::Simulated),
        extended: p.good,
        noise: p.faint.gamma_multiply(if dark { 0.30 } else { 0.26 }),
    }
}

/// Measured and modelled force over time, the noise as a band around the extended model.
pub fn force_plot(ui: &mut Ui, height: f32, curves: &Residuals) {
    let (p, inks) = (palette(ui), inks(ui));
    let plot = quiet("force over time", p, height).custom_x_axes(vec![time_axis(p, false)]);
    plot.show(ui, |plot| {
        let (x, y) = (curves.span_s, curves.force);
        plot.set_plot_bounds(PlotBounds::from_min_max([x.0, y.0], [x.1, y.1]));
        for stretch in curves.extended.iter().filter(|s| s.len() > 1) {
            let xs: Vec<f64> = stretch.iter().map(|p| p.x).collect();
            let edge =
                |sign: f64| -> Vec<f64> { stretch.iter().map(|p| p.y + sign * BAND_SIGMAS * curves.noise).collect() };
            let band = FilledArea::new("", &xs, &edge(-1.0), &edge(1.0));
            plot.add(band.fill_color(inks.noise).allow_hover(false));
        }
        for (stretches, color, width) in [
            (&curves.modelled, inks.model, 3.0),
            (&curves.extended, inks.extended, 2.0),
            (&curves.measured, inks.measured, 1.0),
        ] {
            for stretch in stretches {
                let line = Line::new("", PlotPoints::Borrowed(stretch));
                plot.line(line.color(color).width(width).allow_hover(false));
            }
        }
    });
}

/// Draws the force residual against one variable: a cloud for the base model, binned means of both models, and the
/// noise band.
pub fn cloud_plot(ui: &mut Ui, height: f32, cloud: &Cloud, curves: &Residuals) {
    let (p, inks) = (palette(ui), inks(ui));
    let plot = quiet(("residual", cloud.title), p, height).custom_x_axes(vec![variable_axis(p, "")]);
    plot.show(ui, |plot| {
        let (x, y) = (cloud.range, curves.largest);
        plot.set_plot_bounds(PlotBounds::from_min_max([x.0, -y], [x.1, y]));
        let edge = BAND_SIGMAS * curves.noise;
        let band = FilledArea::new("", &[x.0, x.1], &[-edge; 2], &[edge; 2]);
        plot.add(band.fill_color(inks.noise).allow_hover(false));
        let points = Points::new("", PlotPoints::Borrowed(&cloud.before)).radius(1.1).allow_hover(false);
        plot.points(points.color(inks.model.gamma_multiply(0.32)));
        for (trends, color) in [(&cloud.trend_before, inks.model), (&cloud.trend_after, inks.extended)] {
            for (trend, style) in trends.iter().zip([LineStyle::Solid, LineStyle::dashed_loose()]) {
                for part in trend {
                    plot.line(line(part, color).style(style));
                }
            }
        }
    });
}

fn line(points: &[PlotPoint], color: Color32) -> Line<'_> {
    Line::new("", PlotPoints::Borrowed(points)).color(color).width(2.0).allow_hover(false)
}

/// True if the means of a variable are separated by direction of motion.
pub fn has_directions(suspect: Suspect) -> bool {
    suspect != Suspect::Velocity
}

/// Plot without interaction.
fn quiet(id: impl Hash + Debug, p: &Palette, height: f32) -> Plot<'static> {
    still_plot(id, p, height, 8.0, 170.0).sense(Sense::hover())
}
