//! Marks over the trainer's picture: flashes of impacts, and the device's position while its tips are on a virtual
//! coupling.

use crate::ui::kit::theme::role;
use crate::ui::scene::view::SceneResponse;
use crate::ui::train::trainer::impacts::Impacts;
use egui::{Color32, Pos2, Stroke, Ui};
use haptics::Vec2;
use haptics::servo::Snapshot;
use render::ColorRole;

/// Radius of the strongest flash, points.
const LARGEST: f64 = 34.0;
/// Colour of flashes in both themes: a spark.
const SPARK: Color32 = Color32::from_rgb(0xFF, 0xB3, 0x1A);
/// Distance below which a device is not drawn beside its tip, m.
const SAME_M: f64 = 2e-4;

fn on_screen(ui: &Ui, view: &SceneResponse, point_in_world: Vec2) -> Pos2 {
    let pixel = view.camera.pixel_of(point_in_world, view.size);
    view.rect.min + egui::vec2(pixel.x, pixel.y) / ui.pixels_per_point()
}

/// Draws a spark and a growing, fading ring for each impact, by its speed.
pub fn flashes(ui: &Ui, view: &SceneResponse, impacts: &Impacts) {
    let painter = ui.painter().with_clip_rect(view.rect);
    for flash in impacts.flashes() {
        let at = on_screen(ui, view, flash.at_in_world);
        let (size, faded) = (LARGEST * flash.strength(), flash.faded());
        let left = (1.0 - faded) as f32;
        painter.circle_filled(at, (0.35 * size * (1.0 - faded)) as f32, SPARK.gamma_multiply(0.8 * left));
        let ring = Stroke::new(1.0 + 2.0 * left, SPARK.gamma_multiply(left));
        painter.circle_stroke(at, (size * (0.35 + 0.65 * faded)) as f32, ring);
    }
}

/// Draws the device's own fingers as rings, connected to the tips in the world.
pub fn device(ui: &Ui, view: &SceneResponse, snapshot: &Snapshot) {
    if snapshot.coupling.is_none() {
        return;
    }
    let painter = ui.painter().with_clip_rect(view.rect);
    let tick = &snapshot.tick;
    for finger in 0..2 {
        let (device, tip) = (tick.device_in_world[finger], tick.input.tip_in_world[finger]);
        if (device - tip).norm() < SAME_M {
            continue;
        }
        let color = role(ui.visuals().dark_mode, ColorRole::Finger(finger));
        let [device, tip] = [device, tip].map(|point| on_screen(ui, view, point));
        painter.line_segment([device, tip], Stroke::new(1.5, color));
        painter.circle_stroke(device, 5.0, Stroke::new(1.5, color));
    }
}
