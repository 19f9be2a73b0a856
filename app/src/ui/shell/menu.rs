//! The menu: the same actions as in the palette, by group.

use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme::palette;
use crate::ui::shell::actions::list::{Action, Group};
use crate::ui::shell::actions::search;
use crate::ui::shell::app::App;
use egui::{Atom, Button, RichText, ScrollArea, Ui};

/// Room for the bar above a menu, and for the edge of the window below, points.
const ABOVE: f32 = 110.0;

/// The button that opens it.
pub fn button(ui: &mut Ui, app: &mut App) {
    let response = ui.menu_button((Icon::Menu, "Menu"), |ui| {
        ui.set_min_width(150.0);
        for group in Group::MENUS {
            ui.menu_button(group.title(), |ui| entries(ui, app, group));
        }
    });
    response.response.on_hover_text("Everything that can be done; Ctrl+P finds it by its name");
}

fn entries(ui: &mut Ui, app: &mut App, group: Group) {
    ui.set_min_width(230.0);
    let all: Vec<Action> = Action::all(app).filter(|a| a.group() == group).collect();
    // Recent files and named arrangements make long menus.
    let height = ui.ctx().content_rect().height() - ABOVE;
    ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| all_of(ui, app, all));
}

fn all_of(ui: &mut Ui, app: &mut App, all: Vec<Action>) {
    for action in all {
        let why = action.why_not(app);
        let on = action.is_on(app) == Some(true);
        let keys = RichText::new(search::key_text(ui, &action)).size(11.0).color(palette(ui).secondary);
        let ink = palette(ui).secondary;
        // Names stand below each other, with or without an icon before them.
        let icon = action.icon().map_or_else(|| blank(icons::SIZE), |icon| icon.atom(icons::SIZE, Some(ink)));
        let entry = Button::new((icon, action.title())).gap(8.0).right_text(keys).selected(on);
        let response = ui.add_enabled(why.is_none(), entry);
        let clicked = response.clicked();
        if let Some(why) = why {
            response.on_disabled_hover_text(why);
        }
        if clicked {
            let ctx = ui.ctx().clone();
            action.run(&ctx, app);
            ui.close();
        }
    }
}

fn blank(side: f32) -> Atom<'static> {
    Atom { size: Some(egui::vec2(side, side)), ..Atom::default() }
}
