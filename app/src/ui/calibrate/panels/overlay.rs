//! Recordings overlaid on the shown one: the menu that chooses them, and the legend with their shifts.

use crate::ui::document::overlays;
use crate::ui::document::overlays::ALIGN;
use crate::ui::document::state::Document;
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, recording as color, space};
use crate::ui::kit::widgets::{quiet_icon_button, swatch};
use crate::ui::plots::choices::PlotChoices;
use crate::ui::session::Session;
use egui::containers::menu::{MenuButton, MenuConfig};
use egui::{DragValue, PopupCloseBehavior, RichText, Ui};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const OVERLAY: &str = "Overlay";
    pub const OVERLAY_MORE: &str = "Lay other recordings of this file over the shown one";
    pub const SHIFT_MORE: &str = "What is added to its times: drag, or click and type";
    pub const ALIGN_MORE: &str =
        "Shift it to where its forces (else its motion) are most like those of the shown recording";
    pub const ALIGN: &str = "Align";
    pub const FIRST_CONTACT_MORE: &str = "Shift it so that its first contact is at that of the shown recording";
    pub const FIRST_CONTACT_NOT: &str = "The states of both recordings must be known first: press Fit";
    pub const FIRST_CONTACT: &str = "First contact";
    pub const TAKE_AWAY: &str = "Take it away";
}

/// Maximum length of a name in the legend, characters.
const LONGEST_NAME: usize = 22;

/// Draws the button with the list of the loaded recordings, if there are several.
pub fn overlay_menu(ui: &mut Ui, document: &Document, plots: &mut PlotChoices) {
    if document.recordings.len() < 2 {
        return;
    }
    let config = MenuConfig::new().close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    let button =
        egui::Button::new((Icon::Layers.atom(icons::SMALL, None), RichText::new(words::OVERLAY).size(11.5))).small();
    let (response, _) = MenuButton::from_button(button).config(config).ui(ui, |ui| {
        ui.set_min_width(220.0);
        for recording in 0..document.recordings.len() {
            let name = document.recordings[recording].recording.name.clone();
            let here = recording == document.current;
            let mut on = here || plots.overlaid.iter().any(|o| o.recording == recording);
            let words = if here { format!("{name} (shown)") } else { name };
            if ui.add_enabled(!here, egui::Checkbox::new(&mut on, words)).changed() {
                overlays::toggle_overlay(plots, recording);
            }
        }
    });
    response.on_hover_text(words::OVERLAY_MORE);
}

/// Draws one entry for each overlaid recording.
pub fn overlay_legend(ui: &mut Ui, session: &mut Session) {
    // A recording is not overlaid on itself.
    let (current, count) = (session.document.current, session.document.recordings.len());
    session.plots.overlaid.retain(|o| o.recording != current && o.recording < count);
    if session.plots.overlaid.is_empty() {
        return;
    }
    let clockless = session.document.prepared().is_some_and(|p| p.clockless());
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().interact_size.y = 20.0;
        ui.spacing_mut().button_padding.y = 2.0;
        ui.label(theme::caption(ui, format!("over {}:", short(&session.document.recordings[current].recording.name))));
        for place in 0..session.plots.overlaid.len() {
            let Some(entry) = session.plots.overlaid.get(place).copied() else { break };
            ui.push_id(("overlay", entry.recording), |ui| one(ui, session, place, entry.recording, clockless));
        }
    });
}

fn one(ui: &mut Ui, session: &mut Session, place: usize, recording: usize, clockless: bool) {
    let dark = ui.visuals().dark_mode;
    ui.add_space(space::S);
    swatch(ui, color(dark, place));
    let name = session.document.recordings[recording].recording.name.clone();
    ui.label(RichText::new(short(&name)).size(11.5).color(palette(ui).text)).on_hover_text(&name);
    let (first, last) = session.document.recordings[session.document.current].span();
    if let Some(entry) = session.plots.overlaid.get_mut(place) {
        let (speed, decimals, unit) = if clockless { (1.0, 0, " samples") } else { (1e-3 * (last - first), 3, " s") };
        let drag = DragValue::new(&mut entry.offset_s).speed(speed.min(0.02)).max_decimals(decimals).suffix(unit);
        ui.add(drag).on_hover_text(words::SHIFT_MORE);
    }
    let running = session.jobs.is_running(ALIGN);
    let hint = words::ALIGN_MORE;
    if ui
        .add_enabled(!running, egui::Button::new((Icon::Align.atom(icons::SMALL, None), words::ALIGN)).small())
        .on_hover_text(hint)
        .clicked()
    {
        let ctx = ui.ctx().clone();
        overlays::align(&session.document, &mut session.jobs, &ctx, recording);
    }
    let known = overlays::first_contact_s(&session.calibration, recording).is_some()
        && overlays::first_contact_s(&session.calibration, session.document.current).is_some();
    let (hint, why) = (words::FIRST_CONTACT_MORE, words::FIRST_CONTACT_NOT);
    let button = egui::Button::new(words::FIRST_CONTACT).small();
    if ui.add_enabled(known, button).on_hover_text(hint).on_disabled_hover_text(why).clicked() {
        overlays::align_by_contact(&session.document, &session.calibration, &mut session.plots, recording);
    }
    if quiet_icon_button(ui, Icon::Close, true, words::TAKE_AWAY).on_hover_text(words::TAKE_AWAY).clicked() {
        overlays::toggle_overlay(&mut session.plots, recording);
    }
}

fn short(name: &str) -> String {
    let count = name.chars().count();
    if count <= LONGEST_NAME {
        return name.to_owned();
    }
    // The end distinguishes recordings of one series.
    format!("…{}", name.chars().skip(count - LONGEST_NAME + 1).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_keep_their_end() {
        assert_eq!(short("crank"), "crank");
        let name = short("a very long name of a recording, trial 17");
        assert!(name.starts_with('…') && name.ends_with("trial 17") && name.chars().count() == LONGEST_NAME, "{name}");
    }
}
