//! Play, pause, speed, and an overview of the whole recording for navigation.

use crate::text::format;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space, state_color};
use crate::ui::kit::widgets::{call, icon_button};
use egui::{Pos2, Rangef, Rect, Sense, Stroke, StrokeKind, Ui, UiBuilder, vec2};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const SPEED_OF_PLAYING: &str = "Speed of playing";
    pub const PAUSE: &str = "Pause";
    pub const PLAY: &str = "Play";
    pub const TIME: &str = "Time";
}

/// Playback speeds on offer.
const SPEEDS: [f64; 5] = [0.1, 0.25, 0.5, 1.0, 2.0];

/// Draws the line under the band; the slider is between the given edges.
pub fn transport(ui: &mut Ui, document: &mut Document, calibration: &Calibration, area: Rangef) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 30.0), Sense::hover());
    let buttons = Rect::from_min_max(rect.min, Pos2::new(area.min - space::S, rect.bottom()));
    ui.scope_builder(
        UiBuilder::new().max_rect(buttons).layout(egui::Layout::left_to_right(egui::Align::Center)),
        |ui| {
            ui.spacing_mut().item_spacing.x = space::S;
            if play_button(ui, document.playing).clicked() {
                document.toggle_play();
            }
            let text = match document.prepared() {
                Some(prepared) if prepared.clockless() => format!("{:.0}", document.cursor_s),
                _ => format::clock(document.cursor_s),
            };
            ui.add_sized(vec2(62.0, 20.0), egui::Label::new(theme::strong(text)));
            let list = egui::ComboBox::from_id_salt("speed")
                .width(58.0)
                .selected_text(speed_text(document.speed))
                .show_ui(ui, |ui| {
                    for speed in SPEEDS {
                        ui.selectable_value(&mut document.speed, speed, speed_text(speed));
                    }
                });
            call(&list.response, words::SPEED_OF_PLAYING);
        },
    );
    overview(ui, document, calibration, Rect::from_x_y_ranges(area, rect.center().y - 7.0..=rect.center().y + 7.0));
}

fn speed_text(speed: f64) -> String {
    format!("{speed} ×")
}

/// Draws the button for play and pause.
fn play_button(ui: &mut Ui, playing: bool) -> egui::Response {
    let (icon, name) = if playing { (Icon::Pause, words::PAUSE) } else { (Icon::Play, words::PLAY) };
    icon_button(ui, icon, true, name).on_hover_text(format!("{name} (Space)"))
}

/// Draws the whole recording in its states' colours, the visible part framed, the cursor as a handle.
fn overview(ui: &mut Ui, document: &mut Document, calibration: &Calibration, rect: Rect) {
    let Some(prepared) = document.prepared().cloned() else { return };
    let (p, dark) = (palette(ui), ui.visuals().dark_mode);
    let (first, last) = prepared.span();
    let x_of = |t: f64| rect.left() + ((t - first) / (last - first)).clamp(0.0, 1.0) as f32 * rect.width();
    let track = rect.shrink2(vec2(0.0, 3.5));
    ui.painter().rect_filled(track, 3, p.sunken);
    for interval in calibration.segmentation(document.current).iter().flat_map(|s| &s.states) {
        let part = Rect::from_x_y_ranges(x_of(interval.t0)..=x_of(interval.t1), track.y_range());
        ui.painter().rect_filled(part, 0, state_color(dark, interval.state).gamma_multiply(0.75));
    }
    let (from, to) = document.view_s;
    if to - from < 0.999 * (last - first) {
        let window = Rect::from_x_y_ranges(x_of(from)..=x_of(to).max(x_of(from) + 3.0), rect.y_range());
        ui.painter().rect_stroke(window, 3, Stroke::new(1.2, p.secondary), StrokeKind::Outside);
    }
    let response = ui.interact(rect.expand2(vec2(0.0, 6.0)), ui.scope_id().with("overview"), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::slider(true, document.cursor_s, words::TIME));
    if let Some(at) = response.interact_pointer_pos().filter(|_| response.is_pointer_button_down_on()) {
        document.playing = false;
        document.seek(first + f64::from((at.x - rect.left()) / rect.width()) * (last - first));
    }
    let handle = Pos2::new(x_of(document.cursor_s), rect.center().y);
    ui.painter().circle(handle, 7.0, p.accent, Stroke::new(2.0, p.card));
}
