//! The 3-D view as a widget: picture, orbit, zoom, pan, reset; by mouse and by keys.

use super::callback::{picture, pixels};
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::palette;
use crate::ui::scene::camera_rig::Rig;
use egui::{Key, PointerButton, Rect, Response, Sense};
use haptics::world::{State, World};
use render::{Camera, ViewOptions};
use std::sync::Arc;

/// Orbit per point of drag, rad.
const ORBIT_RAD: f32 = 0.006;
/// Rotation rate of a held key, rad/s, and its magnification rate, 1/s.
const KEY_RAD_S: f32 = 1.2;
const KEY_ZOOM: f32 = 2.6;

/// Description of the picture for a screen reader.
const SPOKEN: &str = "Scene in space. W, A, S and D turn it, Q and E magnify, 0 brings it back.";

/// Result of the view.
pub struct SceneResponse {
    /// Response of the whole picture.
    pub response: Response,
    /// Rectangle of the picture, points.
    pub rect: Rect,
    /// Its size, pixels.
    pub size: [u32; 2],
    /// Camera of the drawn picture.
    pub camera: Camera,
    /// True while the camera is being moved.
    pub camera_moves: bool,
}

/// Projection of the world's plane into the window.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    rect: Rect,
    size: [u32; 2],
    camera: Camera,
    pixels_per_point: f32,
}

impl Place {
    /// Position of a point of the plane in the window, points.
    pub fn at(&self, point_in_world: haptics::Vec2) -> egui::Pos2 {
        let pixel = self.camera.pixel_of(point_in_world, self.size);
        self.rect.min + egui::vec2(pixel.x, pixel.y) / self.pixels_per_point
    }
}

impl SceneResponse {
    /// Projection of the plane in this picture.
    pub fn place(&self, ui: &egui::Ui) -> Place {
        let pixels_per_point = ui.pixels_per_point();
        Place { rect: self.rect, size: self.size, camera: self.camera, pixels_per_point }
    }

    /// Point of the world's plane under a pointer position.
    pub fn point_in_world(&self, ui: &egui::Ui, position: egui::Pos2) -> Option<haptics::Vec2> {
        let offset = (position - self.rect.min) * ui.pixels_per_point();
        self.camera.point_in_plane([offset.x, offset.y].into(), self.size)
    }
}

/// Role of the wheel without Ctrl.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Wheel {
    /// The wheel magnifies.
    Zooms,
    /// The wheel zooms with Ctrl only; without it, it has another use.
    ZoomsWithCtrl,
}

/// Draws the scene into the available space. Right drag orbits, middle drag pans, the wheel zooms. The keys W A S D, Q
/// and E do so, too, while the pointer is over the picture or it has the focus.
pub fn scene_view(
    ui: &mut egui::Ui,
    view: &'static str,
    rig: &mut Rig,
    wheel: Wheel,
    scene: (Arc<World>, State, ViewOptions),
) -> SceneResponse {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, SPOKEN));
    let size = pixels(ui, rect);
    let camera_moves = steer(ui, &response, rig, wheel, size);
    if rig.advance(ui.input(|i| i.stable_dt)) {
        ui.ctx().request_repaint();
    }
    let camera = rig.shown();
    let (world, state, options) = scene;
    let options = ViewOptions { camera, theme: theme::scene_theme(ui.visuals().dark_mode), ..options };
    if !picture(ui, rect, view, world, state, options) {
        let p = palette(ui);
        ui.painter().rect_filled(rect, 0, p.sunken);
        let text = "No graphics device: the picture cannot be drawn.";
        ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, text, egui::FontId::proportional(13.0), p.faint);
    }
    round_corners(ui, rect);
    reset_button(ui, rect, rig);
    SceneResponse { response, rect, size, camera, camera_moves }
}

fn steer(ui: &egui::Ui, response: &Response, rig: &mut Rig, wheel: Wheel, size: [u32; 2]) -> bool {
    let mut moves = false;
    let turned_by = rig.turned_by;
    let camera = rig.goal();
    let drag = response.drag_delta();
    if response.dragged_by(turned_by) {
        camera.orbit(-drag.x * ORBIT_RAD, drag.y * ORBIT_RAD);
        moves = true;
    }
    if response.dragged_by(PointerButton::Middle) {
        let drag = drag * ui.pixels_per_point();
        camera.pan([drag.x, drag.y].into(), size);
        moves = true;
    }
    if response.hovered() {
        let (scroll, pinch, ctrl) =
            ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta(), i.modifiers.ctrl || i.modifiers.command));
        if pinch != 1.0 {
            camera.zoom(pinch);
        } else if scroll != 0.0 && (wheel == Wheel::Zooms || ctrl) {
            camera.zoom((scroll * 0.004).exp());
        }
    }
    let elsewhere = ui.ctx().egui_wants_keyboard_input();
    if response.has_focus() || (response.hovered() && !elsewhere) {
        by_keys(ui, camera);
    }
    moves
}

/// Rotates and zooms at a constant rate while keys are held.
fn by_keys(ui: &egui::Ui, camera: &mut Camera) {
    let (held, seconds) = ui.input(|i| {
        // With Ctrl or Alt the keys have another meaning.
        let plain = !i.modifiers.any() || i.modifiers.shift_only();
        let held = |key| f32::from(u8::from(plain && i.key_down(key)));
        let pairs = [(Key::D, Key::A), (Key::W, Key::S), (Key::E, Key::Q)];
        (pairs.map(|(more, less)| held(more) - held(less)), i.stable_dt.min(0.1))
    });
    let [right, up, closer] = held;
    if held != [0.0; 3] {
        camera.orbit(right * KEY_RAD_S * seconds, up * KEY_RAD_S * seconds);
        camera.zoom(KEY_ZOOM.powf(closer * seconds));
        ui.ctx().request_repaint();
    }
}

/// Rounds the corners of the square picture to match its card.
fn round_corners(ui: &egui::Ui, rect: Rect) {
    let p = palette(ui);
    let painter = ui.painter().with_clip_rect(rect.expand(1.0));
    painter.rect_stroke(rect, theme::CARD_RADIUS, egui::Stroke::new(5.0, p.window), egui::StrokeKind::Outside);
    painter.rect_stroke(rect, theme::CARD_RADIUS, egui::Stroke::new(1.0, p.border), egui::StrokeKind::Inside);
}

fn reset_button(ui: &mut egui::Ui, rect: Rect, rig: &mut Rig) {
    if rig.is_home() {
        return;
    }
    if ui.input(|i| i.key_pressed(Key::Num0)) && !ui.ctx().egui_wants_keyboard_input() {
        rig.go_home();
        return;
    }
    let size = egui::vec2(106.0, 26.0);
    let at = Rect::from_min_size(rect.right_top() + egui::vec2(-size.x - 12.0, 12.0), size);
    let button = egui::Button::new((
        Icon::Reset.atom(icons::SMALL, Some(palette(ui).secondary)),
        theme::caption(ui, "Reset view"),
    ))
    .gap(5.0)
    .fill(palette(ui).card);
    let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(at));
    if ui.put(at, button).on_hover_text("Key 0").clicked() {
        rig.go_home();
    }
}
