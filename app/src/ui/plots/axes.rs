//! Axes with even ticks and quiet labels.

use crate::text::format;
use crate::ui::kit::theme::Palette;
use egui::{FontId, Rangef, Vec2};
use egui_plot::{AxisHints, GridMark, Plot};
use std::fmt::Debug;
use std::hash::Hash;

/// Width of the labels of the vertical axis.
pub const AXIS_WIDTH: f32 = 44.0;

/// Plot without pan and zoom: a quiet grid of about `across` vertical lines, more horizontal lines where it is at least
/// `tall`, and values at the left.
pub fn still_plot(id: impl Hash + Debug, p: &Palette, height: f32, across: f64, tall: f32) -> Plot<'static> {
    Plot::new(id)
        .height(height)
        .show_background(false)
        .show_x(false)
        .show_y(false)
        .show_crosshair(false)
        .allow_zoom(false)
        .allow_drag(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_double_click_reset(false)
        .allow_axis_zoom_drag(false)
        .grid_color(p.border)
        .grid_fade(1.2)
        .grid_spacing(Rangef::new(4.0, 40.0))
        .x_grid_spacer(move |input| marks(input.bounds, across))
        .y_grid_spacer(move |input| marks(input.bounds, if height > tall { 6.0 } else { 4.0 }))
        .set_margin_fraction(Vec2::ZERO)
        .custom_y_axes(vec![value_axis(p, height)])
}

/// Seconds, or sample numbers.
pub fn time_axis(p: &Palette, clockless: bool) -> AxisHints<'static> {
    variable_axis(p, if clockless { "" } else { " s" }).label_spacing(Rangef::new(20.0, 30.0))
}

/// Any variable, with its unit behind every number.
pub fn variable_axis(p: &Palette, unit: &'static str) -> AxisHints<'static> {
    AxisHints::new_x()
        .formatter(move |mark, _| format!("{}{unit}", format::number(mark.value, decimals(mark.step_size))))
        .label_spacing(Rangef::new(24.0, 40.0))
        .tick_label_color(p.secondary)
        .tick_label_font(FontId::proportional(11.0))
}

/// Half the height of a label, points.
const HALF_LABEL: f64 = 6.0;

/// Vertical axis in the group's unit, `height` points tall. A label at the very end would be cut in half, so it is
/// omitted.
pub fn value_axis(p: &Palette, height: f32) -> AxisHints<'static> {
    AxisHints::new_y()
        .formatter(move |mark, range| {
            let air = HALF_LABEL * (range.end() - range.start()) / f64::from(height);
            let inside = mark.value >= range.start() + air && mark.value <= range.end() - air;
            if inside { format::number(mark.value, decimals(mark.step_size)) } else { String::new() }
        })
        .min_thickness(AXIS_WIDTH)
        .label_spacing(Rangef::new(10.0, 14.0))
        .tick_label_color(p.secondary)
        .tick_label_font(FontId::proportional(11.0))
}

/// Grid marks, about `wanted` of them, at a step of 1, 2 or 5 times a power of ten.
pub fn marks((low, high): (f64, f64), wanted: f64) -> Vec<GridMark> {
    let rough = ((high - low) / wanted).max(1e-12);
    let decade = 10.0_f64.powf(rough.log10().floor());
    let step_size =
        [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|s| *s >= rough).unwrap_or(10.0 * decade);
    let (first, last) = ((low / step_size).ceil(), (high / step_size).floor());
    let count = (last - first).clamp(-1.0, 100.0);
    (0..=count as i64)
        .filter(|_| count >= 0.0)
        .map(|i| GridMark { value: (first + i as f64) * step_size, step_size })
        .collect()
}

/// Decimals that marks at this step need.
pub fn decimals(step: f64) -> usize {
    (-step.abs().log10().floor()).clamp(0.0, 6.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_even_and_round() {
        let values: Vec<f64> = marks((-0.3, 18.9), 10.0).iter().map(|m| m.value).collect();
        assert_eq!(values, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0]);
        assert!(marks((1.0, 1.0), 5.0).len() < 5, "an empty range has no forest of lines");
    }
}
