//! Shown around: what is where, in a few cards, the first time and whenever it is asked for.

use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::primary_button;
use crate::ui::shell::app::App;
use crate::ui::shell::tour_progress::{STEPS, WIDTH, beside, shade};
use egui::{Align2, Area, Frame, Key, Order, RichText, Stroke, Ui};

/// Draws the card of the step, and a frame about what it is about.
pub fn show(ui: &Ui, app: &mut App) {
    let Some(index) = app.tour.step else { return };
    let step = &STEPS[index];
    app.tour.before.get_or_insert(app.session.workspace);
    let about = step.at.and_then(|(workspace, pane)| {
        app.session.workspace = workspace;
        app.dock.rect(workspace, pane)
    });
    let ctx = ui.ctx().clone();
    shade(&ctx, about);
    let (mut next, mut back, mut leave) = (false, false, false);
    let area = Area::new(egui::Id::unique("tour")).order(Order::Foreground);
    let area = match about {
        Some(rect) => area.fixed_pos(beside(rect, ctx.content_rect())),
        None => area.anchor(Align2::CENTER_CENTER, [0.0, 0.0]),
    };
    area.show(&ctx, |ui| {
        let p = palette(ui);
        let frame = Frame::popup(ui.style()).inner_margin(space::L).stroke(Stroke::new(1.0, p.accent));
        frame.show(ui, |ui| {
            ui.set_width(WIDTH);
            ui.label(theme::title(step.title));
            ui.add_space(space::XS);
            ui.label(RichText::new(step.text).color(p.secondary));
            ui.add_space(space::M);
            ui.horizontal(|ui| {
                let last = index + 1 == STEPS.len();
                next =
                    primary_button(ui, true, if last { (Icon::Good, "Done") } else { (Icon::Next, "Next") }).clicked();
                back = index > 0 && ui.button((Icon::Back, "Back")).clicked();
                leave = !last && ui.link("Leave").clicked();
                ui.label(theme::caption(ui, format!("{} of {}", index + 1, STEPS.len())));
            });
        });
    });
    ctx.input(|i| {
        next |= i.key_pressed(Key::Enter) || i.key_pressed(Key::ArrowRight);
        back |= i.key_pressed(Key::ArrowLeft);
        leave |= i.key_pressed(Key::Escape);
    });
    let to = if next {
        Some(index + 1)
    } else if back {
        Some(index.saturating_sub(1))
    } else {
        Some(index)
    };
    app.tour.step = to.filter(|to| *to < STEPS.len() && !leave);
    if app.tour.step.is_none() {
        app.tour.seen = true;
        app.session.workspace = app.tour.before.take().unwrap_or_default();
    }
}
