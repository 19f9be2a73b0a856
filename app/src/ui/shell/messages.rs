//! Messages above the workspace.

use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::palette;
use crate::ui::shell::message_list::{Messages, Tone};
use egui::{Align, Align2, Area, Frame, Id, Layout, Margin, Order, Panel as Side, RichText, Stroke, Ui};
use std::time::Instant;

/// Draws the messages. Errors stay above the workspace until they are dismissed. Other messages float over its lower
/// edge and vanish by themselves, so that nothing moves under the pointer.
pub fn banners(ui: &mut Ui, messages: &mut Messages) {
    let now = Instant::now();
    messages.banners.retain(|banner| banner.until.is_none_or(|until| now < until));
    if let Some(first) = messages.banners.iter().filter_map(|banner| banner.until).min() {
        ui.ctx().request_repaint_after(first - now);
    }
    let mut closed = None;
    let wrong = messages.banners.iter().filter(|b| b.tone == Tone::Error).count();
    strip(ui, "messages", wrong, |ui| {
        for (index, banner) in messages.banners.iter().enumerate().filter(|(_, b)| b.tone == Tone::Error) {
            message(ui, banner.tone, &banner.text, |ui| {
                if ui.small_button("Dismiss").clicked() {
                    closed = Some(index);
                }
            });
        }
    });
    toasts(ui, messages);
    if let Some(index) = closed {
        messages.banners.remove(index);
    }
}

/// The newest at the bottom.
fn toasts(ui: &Ui, messages: &Messages) {
    let done: Vec<_> = messages.banners.iter().filter(|b| b.tone == Tone::Done).collect();
    if done.is_empty() {
        return;
    }
    let area = Area::new(Id::unique("toasts")).order(Order::Foreground).anchor(Align2::RIGHT_BOTTOM, [-20.0, -20.0]);
    area.show(ui.ctx(), |ui| {
        let p = palette(ui);
        ui.with_layout(Layout::top_down(Align::Max), |ui| {
            for banner in done {
                let fill = theme::mix(p.card, p.good, 0.16);
                let frame = Frame::popup(ui.style()).fill(fill).stroke(Stroke::new(1.0, p.good)).corner_radius(8);
                let shown = frame.inner_margin(Margin::symmetric(14, 8)).show(ui, |ui| {
                    ui.horizontal(|ui| {
                        // In a column along the right edge lines go from right to left.
                        ui.add(egui::Label::new(RichText::new(&banner.text).color(p.text)).extend());
                        Icon::Good.show(ui, icons::SIZE, p.good);
                    });
                });
                if !banner.hint.is_empty() {
                    shown.response.on_hover_text(&banner.hint);
                }
            }
        });
    });
}

/// Room above the workspace for `count` messages.
pub fn strip(ui: &mut Ui, name: &str, count: usize, contents: impl FnOnce(&mut Ui)) {
    // The bar takes its height from the picture before: when there is more or less to say, another one is due at once.
    let before = ui.data_mut(|data| std::mem::replace(data.get_temp_mut_or_default(Id::unique(name)), count));
    if before != count {
        ui.ctx().request_repaint();
    }
    if count == 0 {
        return;
    }
    let frame = Frame::new().inner_margin(Margin { left: 12, right: 12, top: 10, bottom: 0 });
    Side::top(name.to_owned()).frame(frame).show_separator_line(false).show(ui, contents);
}

/// One message; `buttons` come from the right.
pub fn message(ui: &mut Ui, tone: Tone, text: &str, buttons: impl FnOnce(&mut Ui)) {
    let p = palette(ui);
    let (mark, color) = if tone == Tone::Error { (Icon::Wrong, p.danger) } else { (Icon::Told, p.good) };
    let fill = theme::mix(p.card, color, 0.10);
    let frame = Frame::new().fill(fill).stroke(Stroke::new(1.0, color)).corner_radius(6);
    frame.inner_margin(Margin::symmetric(12, 6)).show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                buttons(ui);
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    mark.show(ui, icons::SIZE, color);
                    ui.add(egui::Label::new(RichText::new(text).color(p.text)).wrap());
                });
            });
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::session::Session;
    use egui_kittest::Harness;
    use std::time::Duration;

    #[test]
    fn what_was_done_goes_by_itself_and_what_went_wrong_stays() {
        let mut session = Session::new();
        session.messages.fail("It did not work.");
        session.messages.say(Tone::Done, "Saved.".to_owned());
        let builder = Harness::builder().with_context_setup(theme::install);
        let mut harness =
            builder.build_ui_state(|ui, session: &mut Session| banners(ui, &mut session.messages), session);
        harness.run_steps(2);
        assert_eq!(harness.state().messages.banners.len(), 2);
        let done = harness.state_mut().messages.banners.iter_mut().find(|b| b.tone == Tone::Done).expect("said");
        let until = done.until.expect("it ends");
        assert!(until > Instant::now() + Duration::from_secs(2), "there is time to read it");
        // Its time is up.
        done.until = Some(Instant::now());
        harness.run_steps(2);
        let left: Vec<Tone> = harness.state().messages.banners.iter().map(|b| b.tone).collect();
        assert_eq!(left, [Tone::Error]);
        // Said again it has its time again, and stands there once.
        for _ in 0..2 {
            harness.state_mut().messages.say(Tone::Done, "Saved.".to_owned());
        }
        harness.run_steps(2);
        assert_eq!(harness.state().messages.banners.len(), 2);
    }
}
