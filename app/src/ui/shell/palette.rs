//! The command palette: every action by a few letters of its name.

use crate::ui::kit::icons;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::shell::actions::list::Action;
use crate::ui::shell::actions::search;
use crate::ui::shell::app::App;
use crate::ui::shell::command_palette::{GROUP, HEIGHT, LINE, WIDTH, moved_by_keys};
use egui::{Align, Align2, Frame, Key, Layout, Modal, RichText, ScrollArea, Sense, TextEdit, Ui, vec2};

/// Draws it over the window while it is open, and does what is chosen.
pub fn show(ui: &Ui, app: &mut App) {
    if !app.palette.shown {
        return;
    }
    let ctx = ui.ctx().clone();
    let mut found = found_for(app);
    let mut run = None;
    let frame = Frame::popup(&ctx.global_style()).inner_margin(space::M);
    let area = Modal::default_area(egui::Id::unique("command palette")).anchor(Align2::CENTER_TOP, [0.0, 90.0]);
    let response = Modal::new(egui::Id::unique("command palette")).area(area).frame(frame).show(&ctx, |ui| {
        ui.set_width(WIDTH.min(ctx.content_rect().width() - 80.0));
        moved_by_keys(ui, &mut app.palette, found.len());
        let field = TextEdit::singleline(&mut app.palette.query).hint_text("What do you want to do?");
        let field = ui.add(field.desired_width(f32::INFINITY).margin(vec2(8.0, 7.0)));
        field.request_focus();
        if field.changed() {
            app.palette.chosen = 0;
            // Whoever types quickly presses Enter before another picture is drawn: what it chooses is of these letters.
            found = found_for(app);
        }
        ui.add_space(space::XS);
        if found.is_empty() {
            ui.label(theme::caption(ui, "Nothing has such a name."));
        }
        ScrollArea::vertical().max_height(HEIGHT).auto_shrink([false, true]).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (index, action) in found.iter().enumerate() {
                if line(ui, app, action, index) {
                    run = Some(action.clone());
                }
            }
        });
        if ui.input(|i| i.key_pressed(Key::Enter)) {
            run = found.get(app.palette.chosen).cloned();
        }
    });
    let picked = run.filter(|action| action.why_not(app).is_none());
    if response.should_close() || picked.is_some() {
        app.palette.shown = false;
    }
    if let Some(action) = picked {
        action.run(&ctx, app);
    }
}

/// Actions that match the typed letters.
fn found_for(app: &App) -> Vec<Action> {
    let mut found = search::matching(app, &app.palette.query);
    if app.palette.query.is_empty() {
        // Actions that are possible now stand first.
        found.sort_by_key(|action| action.why_not(app).is_some());
    }
    found
}

/// One action; true when it was clicked.
fn line(ui: &mut Ui, app: &mut App, action: &Action, index: usize) -> bool {
    let p = palette(ui);
    let why = action.why_not(app);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), LINE), Sense::click());
    let title = action.title();
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, why.is_none(), &title));
    let chosen = index == app.palette.chosen;
    if chosen && std::mem::take(&mut app.palette.follow) {
        ui.scroll_to_rect(rect, None);
    }
    if chosen || response.hovered() {
        ui.painter().rect_filled(rect, 5, if chosen { theme::mix(p.card, p.accent, 0.22) } else { p.raised });
    }
    let ink = if why.is_none() { p.text } else { p.faint };
    let mut ui = ui.new_child(egui::UiBuilder::new().max_rect(rect.shrink2(vec2(10.0, 0.0))));
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        let right = why.map_or_else(|| search::key_text(ui, action), str::to_owned);
        ui.label(RichText::new(right).size(11.0).color(p.secondary));
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let (place, _) = ui.allocate_exact_size(vec2(icons::SIZE, icons::SIZE), Sense::hover());
            if let Some(icon) = action.icon() {
                icon.paint(
                    ui.painter(),
                    place.center(),
                    icons::SIZE,
                    if why.is_none() { p.secondary } else { p.faint },
                );
            }
            let group = RichText::new(action.group().title()).size(11.0).color(p.faint);
            // Names stand below each other.
            let column = vec2(GROUP, ui.available_height());
            ui.allocate_ui_with_layout(column, Layout::left_to_right(Align::Center), |ui| {
                ui.set_min_width(GROUP);
                ui.label(group);
            });
            let on = if action.is_on(app) == Some(true) { " · on" } else { "" };
            ui.add(egui::Label::new(RichText::new(title + on).color(ink)).truncate());
        });
    });
    response.clicked()
}
