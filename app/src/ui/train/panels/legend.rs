//! Legends of the force gauges and of their live curve.

use crate::text::format::number;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, role};
use crate::ui::kit::widgets::{compact, swatch};
use egui::{Color32, Sense, Shape, Stroke, Ui, vec2};
use render::ColorRole;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const WHAT_IS_MORE: &str =
        "What is more is cut off before it reaches your device; the light Saturated says so.";
    pub const GRIP_MORE: &str = "What both fingers press against each other, N";
    pub const NET_UP: &str = "net, up";
    pub const NET_UP_MORE: &str = "The sum of what both fingers lift with, N; below the line they press down";
    pub const LIMIT_MORE: &str = "The largest force that is passed on";
}

/// Legend below the gauges: the upright mark.
pub fn gauges(ui: &mut Ui, limit_n: f64) {
    compact(ui, |ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(10.0, 12.0), Sense::hover());
        ui.painter().vline(rect.center().x, rect.y_range(), Stroke::new(1.5, palette(ui).secondary));
        ui.label(theme::caption(ui, format!("largest force that is passed on, {} N", number(limit_n, 1))))
            .on_hover_text(words::WHAT_IS_MORE);
    });
}

/// Legend below the live curve.
pub fn strip(ui: &mut Ui, seconds: f64) {
    let (dark, p) = (ui.visuals().dark_mode, palette(ui));
    compact(ui, |ui| {
        ui.spacing_mut().item_spacing.x = 5.0;
        for (color, label, tip) in
            [(ColorRole::Measured, "grip", words::GRIP_MORE), (ColorRole::Block(0), words::NET_UP, words::NET_UP_MORE)]
        {
            swatch(ui, role(dark, color));
            ui.label(theme::caption(ui, label)).on_hover_text(tip);
        }
        dashes(ui, p.danger.gamma_multiply(0.6));
        ui.label(theme::caption(ui, "limit")).on_hover_text(words::LIMIT_MORE);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.label(theme::caption(ui, format!("last {} s", number(seconds, 0))));
        });
    });
}

fn dashes(ui: &mut Ui, color: Color32) {
    let (rect, _) = ui.allocate_exact_size(vec2(16.0, 10.0), Sense::hover());
    let line = [rect.left_center(), rect.right_center()];
    ui.painter().extend(Shape::dashed_line(&line, Stroke::new(1.2, color), 4.0, 3.0));
}
