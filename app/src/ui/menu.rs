//! The menu: the same actions as in the palette, by group.

use super::actions::{self, Action, Group};
use super::app::App;
use super::theme::palette;
use egui::{Button, RichText, Ui};

/// The button that opens it.
pub fn button(ui: &mut Ui, app: &mut App) {
    let response = ui.menu_button("Menu", |ui| {
        ui.set_min_width(150.0);
        for group in Group::MENUS {
            ui.menu_button(group.title(), |ui| entries(ui, app, group));
        }
    });
    response.response.on_hover_text("Everything that can be done; Ctrl+P finds it by its name");
}

fn entries(ui: &mut Ui, app: &mut App, group: Group) {
    ui.set_min_width(230.0);
    let all: Vec<Action> = Action::all(&app.session).filter(|a| a.group() == group).collect();
    for action in all {
        let why = action.why_not(app);
        let tick = if action.is_on(app) == Some(true) { "✔ " } else { "" };
        let keys = RichText::new(actions::key_text(ui, &action)).size(11.0).color(palette(ui).secondary);
        let entry = Button::new(format!("{tick}{}", action.title())).right_text(keys);
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
