//! The dialog for the name of a layout.

use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::primary_button;
use crate::ui::shell::app::App;
use crate::ui::shell::dock::name_field::WIDTH;
use egui::{Align, Frame, Id, Key, Layout, Modal, RichText, TextEdit, Ui, vec2};

/// Draws the dialog while a name is asked for.
pub fn show(ui: &Ui, app: &mut App) {
    let Some(mut naming) = app.dock.naming.take() else { return };
    let ctx = ui.ctx().clone();
    let frame = Frame::popup(&ctx.global_style()).inner_margin(space::L);
    let (mut done, mut leave) = (false, false);
    let response = Modal::new(Id::unique("name of an arrangement")).frame(frame).show(&ctx, |ui| {
        ui.set_width(WIDTH.min(ctx.content_rect().width() - 80.0));
        let title = if naming.renamed.is_some() { "Rename the arrangement" } else { "Save the arrangement" };
        ui.label(theme::title(title));
        ui.add_space(space::XS);
        let of = format!("Where panels stand in {}. Menu, View, brings it back.", naming.workspace.title());
        ui.label(theme::caption(ui, of));
        ui.add_space(space::S);
        let field = TextEdit::singleline(&mut naming.name).hint_text("Its name").margin(vec2(8.0, 6.0));
        let field = ui.add(field.desired_width(f32::INFINITY));
        field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Name of the arrangement"));
        // The key that opened the dialog must not close it.
        let fresh = !std::mem::replace(&mut naming.begun, true);
        if fresh {
            field.request_focus();
        }
        let why = app.dock.why_not_name(naming.workspace, &naming.name, naming.renamed.as_deref());
        let taken = naming.renamed.is_none() && app.dock.names(naming.workspace).any(|n| n == naming.name.trim());
        let hint = why.unwrap_or(if taken { "The one of this name is replaced." } else { "" });
        ui.label(RichText::new(hint).size(11.5).color(palette(ui).secondary));
        ui.add_space(space::S);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let word = if naming.renamed.is_some() { "Rename" } else { "Save" };
            done = primary_button(ui, why.is_none(), word).clicked();
            leave = ui.button("Cancel").clicked();
        });
        done |= !fresh && why.is_none() && ui.input(|i| i.key_pressed(Key::Enter));
    });
    if done {
        match &naming.renamed {
            Some(old) => app.dock.rename(naming.workspace, old, &naming.name),
            None => app.dock.save_as(naming.workspace, &naming.name),
        };
    } else if !leave && !response.should_close() {
        app.dock.naming = Some(naming);
    }
}
