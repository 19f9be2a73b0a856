//! The comfort card beside the trainer's picture, and the message over the picture while the world is paused.

use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{compact, plain_card};
use crate::ui::train::comfort::Comfort;
use crate::ui::train::trainer::live::Trainer;
use egui::{Align2, Key, Modifiers, Rect, Sense, Ui, UiBuilder};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const COMFORT: &str = "Comfort";
    pub const LEFT_HANDED: &str = "Left-handed";
    pub const LEFT_HANDED_MORE: &str =
        "Controls stand left of the picture; the right mouse button pinches, the left one turns the view";
    pub const PAUSE_WHEN_THE_WINDOW: &str = "Pause when the window loses the focus";
    pub const PAUSE_WHEN_THE_WINDOW_MORE: &str =
        "The world stands still and the force goes until you go on; the time of a lesson does not count meanwhile";
    pub const THIS_BUILD_IS_SILENT: &str =
        "This build is silent: impacts flash. Build it with its feature “sound” to hear them.";
    pub const MUTE: &str = "Mute";
    pub const MUTE_MORE: &str = "No knocks, no scraping, no warning tone";
    pub const HOW_LOUD_CONTACTS: &str = "How loud contacts, slips and warnings are";
    pub const VOLUME: &str = "Volume";
}

/// Card of the persistent comfort settings.
pub fn card(ui: &mut Ui, comfort: &mut Comfort) {
    plain_card(ui, words::COMFORT, |ui| {
        let choices = [
            (&mut comfort.left_handed, words::LEFT_HANDED, words::LEFT_HANDED_MORE),
            (&mut comfort.pauses, words::PAUSE_WHEN_THE_WINDOW, words::PAUSE_WHEN_THE_WINDOW_MORE),
        ];
        for (choice, label, hint) in choices {
            compact(ui, |ui| ui.checkbox(choice, label).on_hover_text(hint));
        }
        sound(ui, comfort);
    });
}

/// Volume control. A build without sound says so.
fn sound(ui: &mut Ui, comfort: &mut Comfort) {
    if !cfg!(feature = "sound") {
        let text = words::THIS_BUILD_IS_SILENT;
        ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
        return;
    }
    compact(ui, |ui| {
        ui.checkbox(&mut comfort.muted, words::MUTE).on_hover_text(words::MUTE_MORE);
        let mut percent = 100.0 * comfort.volume;
        let slider = egui::Slider::new(&mut percent, 0.0..=100.0).suffix(" %").fixed_decimals(0);
        let response = ui.add_enabled(!comfort.muted, slider).on_hover_text(words::HOW_LOUD_CONTACTS);
        response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(percent), words::VOLUME));
        if response.changed() {
            comfort.volume = percent / 100.0;
        }
    });
}

/// Message over the picture while the world is paused; a click there or the space bar resumes.
pub fn paused(ui: &mut Ui, picture: Rect, trainer: &mut Trainer) {
    let Some((what, then)) = trainer.held_words() else { return };
    let p = palette(ui);
    ui.painter().rect_filled(picture, theme::CARD_RADIUS, p.window.gamma_multiply(0.45));
    let size = egui::vec2(320.0_f32.min(picture.width() - 2.0 * space::M), 62.0);
    let rect = Align2::CENTER_CENTER.align_size_within_rect(size, picture);
    let id = ui.scope_id().with("paused");
    let response = ui.interact(rect, id, Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("{what} {then}")));
    let mut ui = ui.new_child(UiBuilder::new().max_rect(rect));
    let edge = if response.hovered() { p.accent } else { p.caution };
    egui::Frame::new()
        .fill(p.card)
        .stroke(egui::Stroke::new(1.5, edge))
        .corner_radius(theme::CARD_RADIUS)
        .inner_margin(space::M)
        .show(&mut ui, |ui| {
            ui.set_min_size(size - egui::Vec2::splat(2.0 * space::M));
            ui.vertical_centered(|ui| {
                ui.add(egui::Label::new(theme::strong(what)).selectable(false));
                ui.add_space(space::XS);
                ui.add(egui::Label::new(theme::caption(ui, then)).selectable(false));
            });
        });
    let space_bar = !ui.ctx().egui_wants_keyboard_input()
        && ui.input_mut(|i| i.focused && i.consume_key(Modifiers::NONE, Key::Space));
    if response.clicked() || space_bar {
        trainer.go_on();
    }
}
