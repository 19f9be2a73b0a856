//! The 3D view of the recording: the hand follows the cursor; path, forces and constraints are overlaid.

use crate::ui::calibrate::panels::rules::RulesPanel;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{empty_state, sheet};
use crate::ui::scene::camera_rig::Rig;
use crate::ui::scene::layers::SceneLayers;
use crate::ui::scene::legend::Legend;
use crate::ui::scene::mechanism::Mechanism;
use crate::ui::scene::overlay::{camera_for, options_for, scene_world};
use crate::ui::scene::similarity::Likeness;
use crate::ui::scene::view::{Wheel, scene_view};
use crate::ui::session::Session;
use crate::ui::shell::panel::{Framing, Panel, Picture, Registration, SCENE};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{PopupCloseBehavior, Rect, RichText, Stroke, Ui, UiBuilder, vec2};
use egui_tiles::ContainerKind;
use render::Camera;
use std::sync::Arc;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const THE_RECORDED_HAND: &str =
        "The recorded hand moves here, with its path, forces and the constraints that were found.";
    pub const THE_RECORDING_IN_SPACE: &str = "The recording in space";
    pub const THIS_RECORDING_HAS: &str = "This recording has no path: there is nothing to place in space.";
    pub const NOTHING_TO_SHOW: &str = "Nothing to show in space";
    pub const SHOWN: &str = "Shown";
}

/// Minimum width of a picture with space for switches and legend, points.
const WIDE: f32 = 420.0;
/// Minimum height of a picture with space for a legend, points.
const HIGH: f32 = 180.0;
/// Width of the button beside the switches, points.
const RESET: f32 = 120.0;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Calibrate, 1), (Workspace::Diagnose, 2)],
    neighbours: &[
        (PanelId::VIDEO, ContainerKind::Horizontal, true),
        (PanelId::LOG, ContainerKind::Vertical, true),
        (PanelId::DIAGNOSIS, ContainerKind::Tabs, false),
    ],
    pictures: &[&SCENE_PICTURE],
    ..Registration::new(PanelId::SCENE, "In space", Icon::Scene, || Box::new(ScenePanel::default()))
};

/// The recording in space.
pub static SCENE_PICTURE: Picture = Picture {
    name: "scene",
    place: 70,
    help: "The recording in space",
    line: "The recording in space, in the world that was measured",
    size: SCENE,
    sample: Sample::Stack,
    session: stage::fitted,
    framing: Framing::Panel(|| Box::new(ScenePanel::default())),
};

/// Panel of the 3D view.
pub struct ScenePanel {
    rig: Rig,
    /// Recording for which the camera was set up.
    of: usize,
    /// Agreement of the replay with the recording, with the identity of that replay.
    likeness: Option<(usize, Likeness)>,
}

impl Default for ScenePanel {
    fn default() -> Self {
        Self { rig: Rig::new(Camera::workspace()), of: 0, likeness: None }
    }
}

impl Panel for ScenePanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        if session.calibration.rules.is_some() {
            // The rules replace the picture, so that the states below are seen to follow.
            RulesPanel.ui(ui, session);
            return;
        }
        sheet(ui).show(ui, |ui| {
            ui.set_min_size(ui.available_size());
            let Some(prepared) = session.document.prepared().cloned() else {
                let text = words::THE_RECORDED_HAND;
                empty_state(ui, (Icon::Scene, words::THE_RECORDING_IN_SPACE), text, |_| {});
                return;
            };
            if prepared.tips.is_none() && prepared.tool.is_none() {
                self.one_coordinate(ui, &session.document, &prepared);
                return;
            }
            self.set_up(&session.document, &session.calibration, &prepared);
            let world = scene_world(&session.calibration, &prepared);
            let (state, options) = options_for(session, &prepared, &world);
            let legend = self.legend(ui, session, &prepared);
            let (mut above, mut strip) = (ui.available_rect_before_wrap(), ui.available_rect_before_wrap());
            above.max.y -= legend.as_ref().map_or(0.0, Legend::height);
            strip.min.y = above.max.y;
            let view = ui.scope_builder(UiBuilder::new().max_rect(above), |ui| {
                scene_view(ui, "recording", &mut self.rig, Wheel::Zooms, (world, state, options))
            });
            if let Some(legend) = legend {
                legend.show(ui, strip);
            }
            layers(ui, view.inner.rect, &mut session.layers);
        });
    }
}

impl ScenePanel {
    /// Draws a recording without a position in space.
    fn one_coordinate(&mut self, ui: &mut Ui, document: &Document, prepared: &Arc<Prepared>) {
        let Some(mechanism) = Mechanism::of(prepared, document.cursor_s) else {
            let text = words::THIS_RECORDING_HAS;
            empty_state(ui, (Icon::Scene, words::NOTHING_TO_SHOW), text, |_| {});
            return;
        };
        self.home(mechanism.camera, prepared);
        let scene = (Arc::clone(&mechanism.world), mechanism.state.clone(), mechanism.options.clone());
        let view = scene_view(ui, "recording", &mut self.rig, Wheel::Zooms, scene);
        mechanism.write_over(ui, view.rect, &view.camera, view.size);
    }

    /// Legend, if it is switched on and there is space.
    fn legend(&mut self, ui: &Ui, session: &Session, prepared: &Prepared) -> Option<Legend> {
        let room = ui.available_size();
        if !session.layers.legend || room.x < WIDE || room.y < HIGH {
            return None;
        }
        self.compare(&session.document, &session.calibration, &session.layers, prepared);
        Some(Legend::new(ui, room.x, session, prepared, self.likeness.as_ref().map(|(_, like)| like)))
    }

    /// Compares the replay with the recording, once per replay.
    fn compare(&mut self, document: &Document, calibration: &Calibration, layers: &SceneLayers, prepared: &Prepared) {
        let found = calibration.replay(document.current).zip(calibration.analysis.as_ref()).filter(|_| layers.replay);
        let Some((replay, analysis)) = found else {
            self.likeness = None;
            return;
        };
        let of = std::ptr::from_ref(replay) as usize ^ Arc::as_ptr(analysis) as usize;
        if self.likeness.is_none_or(|(known, _)| known != of) {
            self.likeness = Some((of, Likeness::of(replay, &analysis.world, prepared)));
        }
    }

    /// Resets the camera's home for another recording or fit, which changes the extent of the picture; a camera that
    /// was moved stays.
    fn set_up(&mut self, document: &Document, calibration: &Calibration, prepared: &Arc<Prepared>) {
        self.home(camera_for(document, calibration, prepared), prepared);
    }

    fn home(&mut self, home: Camera, prepared: &Arc<Prepared>) {
        let of = Arc::as_ptr(prepared) as usize;
        if self.of == of {
            self.rig.move_home(home);
        } else {
            self.of = of;
            self.rig.cut_to(home);
        }
    }
}

/// Switch of a layer: name, hint, and its field.
type Switch = (&'static str, &'static str, fn(&mut SceneLayers) -> &mut bool);
const SWITCHES: [Switch; 7] = [
    ("Path", "Where the fingers went, in the visible time", |l| &mut l.path),
    ("Forces", "Net force of the hand along the path (thesis, figure 5.10)", |l| &mut l.forces_on_path),
    (
        "Unexplained",
        "What weight and friction do not explain of the force: that of the constraint (thesis, figure 5.12)",
        |l| &mut l.unexplained,
    ),
    ("Constraints", "Centres, lines, curves and surfaces that were found", |l| &mut l.constraints),
    ("Contacts", "Contacts of the replay through the fitted world", |l| &mut l.contacts),
    (
        "Real and virtual",
        "The virtual object under the measured fingers: its forces, its handle, and how far they are off",
        |l| &mut l.replay,
    ),
    ("Legend", "What the marks mean", |l| &mut l.legend),
];

/// Draws the switches in the corner of the picture; a small picture has them in a menu.
fn layers(ui: &mut Ui, rect: Rect, layers: &mut SceneLayers) {
    let room = Rect::from_min_size(rect.left_top() + vec2(space::M, space::M), vec2(rect.width() - RESET, 26.0));
    // A child of its own: it covers the picture and takes no space.
    let rows =
        egui::Layout::left_to_right(egui::Align::Center).with_main_wrap(true).with_cross_align(egui::Align::Center);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(room).layout(rows));
    ui.spacing_mut().item_spacing = vec2(6.0, 4.0);
    ui.spacing_mut().button_padding = vec2(9.0, 2.0);
    ui.spacing_mut().interact_size.y = 22.0;
    if rect.width() >= WIDE {
        for (label, hint, of) in SWITCHES {
            toggle(&mut ui, of(layers), label, hint);
        }
        return;
    }
    let p = palette(&ui);
    let button = egui::Button::new((Icon::Layers.atom(icons::SMALL, None), RichText::new(words::SHOWN).size(11.5)))
        .corner_radius(11)
        .fill(p.card);
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    MenuButton::from_button(button.stroke(Stroke::new(1.0, p.border))).config(config).ui(&mut ui, |ui| {
        for (label, hint, of) in SWITCHES {
            ui.checkbox(of(layers), label).on_hover_text(hint);
        }
    });
}

fn toggle(ui: &mut Ui, on: &mut bool, label: &str, hint: &str) {
    let p = palette(ui);
    let ink = if *on { p.text } else { p.secondary };
    let fill = if *on { p.card } else { p.card.gamma_multiply(0.78) };
    let edge = if *on { p.accent } else { p.border };
    let text = RichText::new(label).size(11.5).color(ink);
    let button = egui::Button::new(text).wrap_mode(egui::TextWrapMode::Extend).corner_radius(11).fill(fill);
    let response = ui.add(button.min_size(vec2(0.0, 22.0)).stroke(Stroke::new(1.0, edge))).on_hover_text(hint);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::CheckBox, true, *on, label));
    if response.clicked() {
        *on = !*on;
    }
}
