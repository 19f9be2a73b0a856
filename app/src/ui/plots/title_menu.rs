//! The title of a plot, with the menu of its transforms.

use super::choices::{GroupChoice, name};
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::plots::plot_input::RowInput;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{DragValue, PopupCloseBehavior, RichText, Sense, Stroke, Ui, vec2};
use estimator::signal::transform::Transform;

/// Default cut-off of a low-pass, as a share of the sampling rate.
const USUAL_CUTOFF: f64 = 0.02;
/// Highest cut-off as a share of the sampling rate.
const HIGHEST_CUTOFF: f64 = 0.45;

/// Draws the title; a click opens the menu.
pub fn title_menu(ui: &mut Ui, choice: &mut GroupChoice, input: &RowInput<'_>) {
    let p = palette(ui);
    let title = RichText::new(&input.group.title).font(egui::FontId::new(13.0, theme::semibold()));
    let button = egui::Button::new(title).frame(false).small();
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let (response, _) = MenuButton::from_button(button).config(config).ui(ui, |ui| menu(ui, choice, input));
    arrow(ui);
    let words = match choice.transform {
        Transform::None => String::new(),
        Transform::LowPass(cutoff) => format!("< {}", cutoff_text(cutoff, input.prepared.clockless())),
        other => short(other).to_owned(),
    };
    if !words.is_empty() {
        ui.label(RichText::new(words).size(11.5).color(p.accent));
    }
    let hint = format!("{}: what is made of these curves, and what the models leave of them", input.group.title);
    // The chips above have the same label.
    let spoken = format!("{} menu", input.group.title);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &spoken));
    response.on_hover_text(hint);
}

fn short(transform: Transform) -> &'static str {
    match transform {
        Transform::Derivative => "derivative",
        Transform::SecondDerivative => "2nd derivative",
        Transform::Integral => "integral",
        Transform::MinusMean => "minus mean",
        Transform::LowPass(_) | Transform::None => "",
    }
}

/// Draws a small triangle to show that the title opens a menu. It is drawn, so no font needs the glyph.
fn arrow(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(7.0, 12.0), Sense::hover());
    let (c, ink) = (rect.center(), palette(ui).faint);
    let points = vec![c + vec2(-3.5, -1.5), c + vec2(3.5, -1.5), c + vec2(0.0, 3.0)];
    ui.painter().add(egui::Shape::convex_polygon(points, ink, Stroke::NONE));
}

fn menu(ui: &mut Ui, choice: &mut GroupChoice, input: &RowInput<'_>) {
    ui.set_min_width(220.0);
    ui.spacing_mut().item_spacing.y = 3.0;
    let clockless = input.prepared.clockless();
    let rate = rate(input);
    let low_pass = match choice.transform {
        Transform::LowPass(cutoff) => Transform::LowPass(cutoff),
        _ => Transform::LowPass(usual_cutoff(rate)),
    };
    let choices = [
        (Transform::None, "The curves as they were recorded"),
        (Transform::Derivative, "How fast they change, by differences over both neighbours"),
        (Transform::SecondDerivative, "How fast that changes; noise grows with the square of the sampling rate"),
        (
            low_pass,
            "Fourth-order Butterworth, forwards and backwards: nothing is shifted in time, −6 dB at the cut-off",
        ),
        (Transform::Integral, "The area under them since the beginning"),
        (Transform::MinusMean, "Less the mean over the whole recording"),
    ];
    for (transform, hint) in choices {
        let on = std::mem::discriminant(&choice.transform) == std::mem::discriminant(&transform);
        if ui.radio(on, name(transform)).on_hover_text(hint).clicked() && !on {
            choice.transform = transform;
        }
        if let (Transform::LowPass(cutoff), true) = (&mut choice.transform, matches!(transform, Transform::LowPass(_)))
        {
            ui.horizontal(|ui| {
                ui.add_space(space::XL);
                ui.label(theme::caption(ui, "up to"));
                // Menus remove the frames of their buttons; an editable number needs one.
                let p = palette(ui);
                let field = &mut ui.visuals_mut().widgets.inactive;
                (field.weak_bg_fill, field.bg_stroke) = (p.raised, Stroke::new(1.0, p.border));
                let speed = 0.005 * *cutoff;
                let drag = DragValue::new(cutoff).range(1e-4 * rate..=HIGHEST_CUTOFF * rate).speed(speed);
                ui.add(drag.max_decimals(4).suffix(if clockless { " / sample" } else { " Hz" }));
            });
        }
    }
    ui.separator();
    let comparable = input.has_simulated || input.has_extended;
    let hint = if comparable {
        "A second plot below: measured less simulated, measured less extended"
    } else {
        "There is nothing to compare these curves with: a fitted world predicts forces"
    };
    ui.add_enabled(comparable, egui::Checkbox::new(&mut choice.left_over, "Show what is left over"))
        .on_hover_text(hint)
        .on_disabled_hover_text(hint);
}

/// Samples per second, or 1 per sample without a clock.
fn rate(input: &RowInput<'_>) -> f64 {
    let (first, last) = input.prepared.span();
    let steps = input.prepared.times.len().saturating_sub(1).max(1) as f64;
    (steps / (last - first)).max(1e-9)
}

/// Rounded cut-off near the default share of the rate.
fn usual_cutoff(rate: f64) -> f64 {
    let rough = USUAL_CUTOFF * rate;
    let decade = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .min_by(|a, b| (a * decade - rough).abs().total_cmp(&(b * decade - rough).abs()));
    step.unwrap_or(1.0) * decade
}

fn cutoff_text(cutoff: f64, clockless: bool) -> String {
    format!("{} {}", crate::text::format::significant(cutoff, 2), if clockless { "/ sample" } else { "Hz" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_cut_off_is_a_round_number() {
        assert_eq!([1000.0, 100.0, 4000.0].map(usual_cutoff), [20.0, 2.0, 100.0]);
        assert!((usual_cutoff(1.0) - 0.02).abs() < 1e-12, "without a clock, per sample");
    }
}
