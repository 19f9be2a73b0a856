//! Input and result of one plot over time.

use crate::ui::document::prepared::{Group, Prepared};
use crate::ui::kit::theme;
use crate::ui::kit::theme::Palette;
use crate::ui::plots::curves::{Curve, Drawn, Layer};
use crate::ui::plots::shift::Grasp;
use egui::{Color32, Rangef};
use estimator::segment::Segmentation;
use std::sync::Arc;

/// Opacity of other recordings' curves.
const DIMMED: f32 = 0.75;

/// Content of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum RowKind {
    /// Curves of a quantity.
    Curves,
    /// Residuals of the models.
    LeftOver,
}

/// Input of a row.
pub struct RowInput<'a> {
    /// Index of the row.
    pub index: usize,
    /// Content of the row.
    pub kind: RowKind,
    /// Quantity of the row.
    pub group: &'a Group,
    /// The shown recording.
    pub prepared: &'a Arc<Prepared>,
    /// The curves.
    pub drawn: &'a Drawn,
    /// True if the fitted world predicts a curve, shown or hidden.
    pub has_simulated: bool,
    /// True if the extended world predicts a curve, shown or hidden.
    pub has_extended: bool,
    /// States, as a faint tint.
    pub segmentation: Option<&'a Segmentation>,
    /// Visible time range, s.
    pub view_s: (f64, f64),
    /// Time of the cursor, s.
    pub cursor_s: f64,
    /// True if the time axis is labelled here.
    pub time_axis: bool,
    /// Height, points.
    pub height: f32,
    /// Shift of the recording that is dragged by its curve, as text, and whether it has snapped.
    pub held: Option<(String, bool)>,
    /// Index of the overlaid recording under the pointer, or dragged by it; its curves are emphasised.
    pub grasped: Option<usize>,
}

/// Result of the user's actions in a row.
pub struct RowOutcome {
    /// New time of the cursor, s.
    pub seek: Option<f64>,
    /// New visible time range, s.
    pub view_s: Option<(f64, f64)>,
    /// Part that was marked, s.
    pub part_s: Option<(f64, f64)>,
    /// Horizontal extent of the plot area, points.
    pub area: Rangef,
    /// Interaction with the curve of another recording.
    pub grasp: Option<Grasp>,
}

impl RowOutcome {
    /// Of a row in which the user did nothing.
    pub fn at(area: Rangef) -> Self {
        Self { area, seek: None, view_s: None, part_s: None, grasp: None }
    }
}

/// Colour of a curve: its own, or that of the model.
pub fn curve_color(input: &RowInput<'_>, curve: &Curve, dark: bool, p: &Palette) -> Color32 {
    let trace = &input.group.traces[curve.trace];
    let own = theme::curve(dark, trace.role, trace.second);
    let alone = input.group.traces.len() == 1;
    match curve.layer {
        Layer::Other(place) => theme::recording(dark, place).gamma_multiply(DIMMED),
        Layer::Simulated => theme::role(dark, render::ColorRole::Simulated).gamma_multiply(0.75),
        Layer::Extended => p.good,
        Layer::LeftSimulated if alone => theme::role(dark, render::ColorRole::Simulated),
        Layer::LeftExtended if alone => p.good,
        // Several traces are distinguished by their own colours, the models by opacity.
        Layer::LeftSimulated if input.drawn.has(Layer::LeftExtended) => own.gamma_multiply(0.45),
        Layer::Measured | Layer::LeftSimulated | Layer::LeftExtended => own,
    }
}
