//! The recording in space: the hand follows the cursor, path, forces and constraints lie over it.

use super::Panel;
use crate::ui::prepare::Prepared;
use crate::ui::scene::{Wheel, camera_for, mechanism_view, options_for, scene_view, scene_world};
use crate::ui::session::Session;
use crate::ui::theme::{palette, space};
use crate::ui::widgets::{empty_state, sheet};
use egui::{Rect, RichText, Stroke, Ui, UiBuilder, vec2};
use render::Camera;
use std::sync::Arc;

/// The 3-D view of the recording.
pub struct ScenePanel {
    camera: Camera,
    home: Camera,
    /// The recording that the camera was set up for.
    of: usize,
}

impl Default for ScenePanel {
    fn default() -> Self {
        Self { camera: Camera::workspace(), home: Camera::workspace(), of: 0 }
    }
}

impl Panel for ScenePanel {
    fn title(&self) -> &'static str {
        "Scene"
    }

    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        sheet(ui).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            let Some(prepared) = session.prepared().cloned() else {
                let text = "The recorded hand moves here, with its path, forces and the constraints that were found.";
                empty_state(ui, "The recording in space", text, |_| {});
                return;
            };
            if prepared.tips.is_none() && prepared.tool.is_none() {
                mechanism_view(ui, session, &prepared);
                return;
            }
            self.set_up(session, &prepared);
            let world = scene_world(session, &prepared);
            let (state, options) = options_for(session, &prepared, &world);
            let view = scene_view(ui, "recording", &mut self.camera, self.home, Wheel::Zooms, (world, state, options));
            layers(ui, view.rect, session);
        });
    }
}

impl ScenePanel {
    /// Another recording, or a fit of it, changes what the whole picture is; a camera that was moved stays.
    fn set_up(&mut self, session: &Session, prepared: &Arc<Prepared>) {
        let of = Arc::as_ptr(prepared) as usize;
        let home = camera_for(session, prepared);
        if self.of != of || self.camera == self.home {
            (self.camera, self.of) = (home, of);
        }
        self.home = home;
    }
}

/// Switches in the corner of the picture.
fn layers(ui: &mut Ui, rect: Rect, session: &mut Session) {
    let line = Rect::from_min_size(rect.left_top() + vec2(space::M, space::M), vec2(rect.width() - 120.0, 24.0));
    // A child of its own: it lies over the picture and takes no room.
    let mut ui = ui.new_child(UiBuilder::new().max_rect(line).layout(egui::Layout::left_to_right(egui::Align::Center)));
    ui.spacing_mut().item_spacing.x = 6.0;
    ui.spacing_mut().button_padding = vec2(9.0, 2.0);
    let layers = &mut session.layers;
    toggle(&mut ui, &mut layers.path, "Path", "Where the fingers went, in the visible time");
    toggle(&mut ui, &mut layers.forces_on_path, "Forces", "Net force along the path");
    toggle(&mut ui, &mut layers.constraints, "Constraints", "Centres of rotation and directions of motion");
    toggle(&mut ui, &mut layers.contacts, "Contacts", "Contacts of the replay through the fitted world");
}

fn toggle(ui: &mut Ui, on: &mut bool, label: &str, hint: &str) {
    let p = palette(ui);
    let ink = if *on { p.text } else { p.secondary };
    let fill = if *on { p.card } else { p.card.gamma_multiply(0.45) };
    let edge = if *on { p.accent } else { p.border };
    let button = egui::Button::new(RichText::new(label).size(11.5).color(ink)).corner_radius(11).fill(fill);
    let response = ui.add(button.min_size(vec2(0.0, 22.0)).stroke(Stroke::new(1.0, edge))).on_hover_text(hint);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, *on, label));
    if response.clicked() {
        *on = !*on;
    }
}
