//! Small pieces that every panel is made of.

use crate::ui::kit::icons;
use crate::ui::kit::icons::{Face, Icon};
use crate::ui::kit::theme;
use crate::ui::kit::theme::{CARD_RADIUS, palette, space};
use egui::{Align, Color32, CornerRadius, Frame, Layout, Margin, Response, RichText, Sense, Stroke, Ui, vec2};

/// Side of the icon of an empty place, points.
const LARGE_ICON: f32 = 30.0;

/// A card: heading on the left, whatever `trailing` adds on the right, contents below.
pub fn card<R>(ui: &mut Ui, heading: &str, trailing: impl FnOnce(&mut Ui), contents: impl FnOnce(&mut Ui) -> R) -> R {
    card_with_head(ui, heading, 16.0, trailing, contents)
}

/// A card whose heading line is `height` points high, for controls beside the heading.
pub fn card_with_head<R>(
    ui: &mut Ui,
    heading: &str,
    height: f32,
    trailing: impl FnOnce(&mut Ui),
    contents: impl FnOnce(&mut Ui) -> R,
) -> R {
    let p = palette(ui);
    Frame::new()
        .fill(p.card)
        .stroke(Stroke::new(1.0, p.border))
        .corner_radius(CornerRadius::same(CARD_RADIUS))
        .inner_margin(Margin::same(space::M as i8))
        .show(ui, |ui| {
            ui.set_width(ui.available_width());
            compact(ui, |ui| {
                ui.set_min_height(height);
                ui.label(theme::heading(heading));
                ui.with_layout(Layout::right_to_left(Align::Center), trailing);
            });
            ui.add_space(space::XS);
            contents(ui)
        })
        .inner
}

/// A card without anything beside its heading.
pub fn plain_card<R>(ui: &mut Ui, heading: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    card(ui, heading, |_| {}, contents)
}

/// A frame for panels that fill their place to the edge (pictures, plots).
pub fn sheet(ui: &Ui) -> Frame {
    let p = palette(ui);
    Frame::new().fill(p.card).stroke(Stroke::new(1.0, p.border)).corner_radius(CornerRadius::same(CARD_RADIUS))
}

/// Sets the name that a screen reader reads for a widget without words of its own.
pub fn call(response: &Response, name: &str) {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name));
}

/// One of several, side by side.
pub fn segmented<'a, T: PartialEq + Copy, F: Into<Face<'a>> + Copy>(
    ui: &mut Ui,
    value: &mut T,
    choices: &[(T, F, &str)],
) -> bool {
    let p = palette(ui);
    let mut changed = false;
    Frame::new().fill(p.sunken).stroke(Stroke::new(1.0, p.border)).corner_radius(7).inner_margin(2).show(ui, |ui| {
        ui.spacing_mut().item_spacing.x = 2.0;
        // In a layout from right to left the last choice comes first.
        let reversed = ui.layout().prefer_right_to_left();
        ui.horizontal(|ui| {
            for index in 0..choices.len() {
                let (choice, face, hint) = &choices[if reversed { choices.len() - 1 - index } else { index }];
                let on = *value == *choice;
                if segment(ui, (*face).into(), hint, on).clicked() && !on {
                    *value = *choice;
                    changed = true;
                }
            }
        });
    });
    changed
}

/// One of them.
fn segment(ui: &mut Ui, face: Face<'_>, hint: &str, on: bool) -> Response {
    let p = palette(ui);
    let text = if on { theme::strong(face.words) } else { RichText::new(face.words).color(p.secondary) };
    let fill = if on { p.raised } else { Color32::TRANSPARENT };
    let edge = if on { Stroke::new(1.0, p.border) } else { Stroke::NONE };
    let button = match face.icon {
        Some(icon) => {
            let color = if on { p.accent } else { p.secondary };
            egui::Button::new((icon.atom(icons::SIZE, Some(color)), text)).gap(6.0)
        }
        None => egui::Button::new(text),
    };
    let response = ui.add(button.fill(fill).stroke(edge).corner_radius(5).min_size(vec2(64.0, 24.0)));
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::RadioButton, true, on, face.words));
    if hint.is_empty() { response } else { response.on_hover_text(hint) }
}

/// The one thing to do.
pub fn primary_button<'a>(ui: &mut Ui, enabled: bool, face: impl Into<Face<'a>>) -> Response {
    let (p, face) = (palette(ui), face.into());
    let label = RichText::new(face.words).font(egui::FontId::new(13.0, theme::semibold())).color(p.on_accent);
    let button = match face.icon {
        Some(icon) => egui::Button::new((icon.atom(icons::SIZE, Some(p.on_accent)), label)).gap(6.0),
        None => egui::Button::new(label),
    };
    ui.add_enabled(enabled, button.fill(p.accent).min_size(vec2(0.0, 28.0)))
}

/// A button with its icon alone; `name` is what screen readers say and what stands under the pointer.
pub fn icon_button(ui: &mut Ui, icon: Icon, enabled: bool, name: &str) -> Response {
    framed_icon(ui, icon, enabled, name, true)
}

/// The same where there are many: its frame comes with the pointer.
pub fn quiet_icon_button(ui: &mut Ui, icon: Icon, enabled: bool, name: &str) -> Response {
    framed_icon(ui, icon, enabled, name, false)
}

fn framed_icon(ui: &mut Ui, icon: Icon, enabled: bool, name: &str, frame: bool) -> Response {
    let side = ui.spacing().interact_size.y;
    let inside = icons::SIZE.min(side - 4.0);
    ui.scope(|ui| {
        ui.spacing_mut().button_padding = vec2(0.5 * (side - inside), 0.0);
        let response = ui.add_enabled(enabled, egui::Button::new(icon.atom(inside, None)).frame_when_inactive(frame));
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, enabled, name));
        response
    })
    .inner
}

/// A small mark with what it is about: a doubt, a mistake, something that is well.
pub fn remark(ui: &mut Ui, mark: Icon, text: impl Into<String>) -> Response {
    let p = palette(ui);
    let color = match mark {
        Icon::Wrong => p.danger,
        Icon::Doubt => p.caution,
        Icon::Good => p.good,
        _ => p.secondary,
    };
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        mark.show(ui, icons::SMALL, color);
        ui.add(egui::Label::new(RichText::new(text.into()).size(12.0)).wrap())
    })
    .inner
}

/// Notice for a panel that is still empty, with the action that fills it.
pub fn empty_state<'a>(ui: &mut Ui, face: impl Into<Face<'a>>, text: &str, action: impl FnOnce(&mut Ui)) {
    let height = ui.available_height();
    let Face { icon, words: title } = face.into();
    ui.vertical_centered(|ui| {
        ui.add_space((0.5 * height - if icon.is_some() { 84.0 } else { 60.0 }).max(space::M));
        if let Some(icon) = icon {
            icon.show(ui, LARGE_ICON, palette(ui).faint);
            ui.add_space(space::XS);
        }
        ui.label(theme::title(title));
        ui.add_space(space::XS);
        ui.scope(|ui| {
            ui.set_max_width(ui.available_width().min(420.0));
            ui.label(RichText::new(text).color(palette(ui).secondary));
        });
        ui.add_space(space::M);
        action(ui);
    });
}

/// A round light with its name; grey when off.
pub fn light(ui: &mut Ui, on: bool, color: Color32, label: &str, hint: &str) -> Response {
    let p = palette(ui);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let (rect, _) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
        if on {
            ui.painter().circle_filled(rect.center(), 7.0, color.gamma_multiply(0.25));
            ui.painter().circle_filled(rect.center(), 4.5, color);
        } else {
            ui.painter().circle_stroke(rect.center(), 4.0, Stroke::new(1.2, p.faint));
        }
        ui.label(RichText::new(label).size(11.5).color(if on { p.text } else { p.faint }));
    })
    .response
    .on_hover_text(hint)
}

/// The red light of what is being recorded.
pub fn recording_light(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
    ui.painter().circle_filled(rect.center(), 5.0, palette(ui).danger);
}

/// A key as it is printed on the keyboard, and what it does.
pub fn key_hint(ui: &mut Ui, key: &str, what: &str) {
    let p = palette(ui);
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        Frame::new()
            .fill(p.sunken)
            .stroke(Stroke::new(1.0, p.border))
            .corner_radius(4)
            .inner_margin(Margin::symmetric(5, 1))
            .show(ui, |ui| ui.label(RichText::new(key).size(11.0).color(p.text)));
        ui.label(theme::caption(ui, what));
    });
}

/// A label on the left and a value on the right of one line.
pub fn fact(ui: &mut Ui, label: &str, value: impl Into<String>) -> Response {
    compact(ui, |ui| {
        ui.label(theme::caption(ui, label));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add(egui::Label::new(RichText::new(value.into()).size(12.0)).truncate())
        })
        .inner
    })
}

/// A line that is no higher than its words.
pub fn compact<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 16.0;
        ui.horizontal(contents).inner
    })
    .inner
}

/// A labelled bar with its value, N, in one line.
pub fn gauge(ui: &mut Ui, label: &str, newtons: f64, most: f64, limit: f64, color: Color32) {
    compact(ui, |ui| {
        ui.allocate_ui_with_layout(vec2(70.0, 16.0), Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(70.0);
            ui.label(theme::caption(ui, label));
        });
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.allocate_ui_with_layout(vec2(46.0, 16.0), Layout::right_to_left(Align::Center), |ui| {
                ui.set_min_width(46.0);
                ui.label(RichText::new(format!("{} N", crate::text::format::number(newtons, 2))).size(12.0));
            });
            bar(ui, newtons, most, Some(limit), color);
        });
    });
}

/// A horizontal bar of a value out of `most`, with a tick where it is limited.
pub fn bar(ui: &mut Ui, value: f64, most: f64, limit: Option<f64>, color: Color32) {
    let p = palette(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 8.0), Sense::hover());
    let x_of = |v: f64| rect.left() + rect.width() * (v / most.max(1e-9)).clamp(0.0, 1.0) as f32;
    ui.painter().rect_filled(rect, 3, p.sunken);
    if value > 0.0 {
        let mut filled = rect;
        filled.set_right(x_of(value).max(rect.left() + 2.0));
        ui.painter().rect_filled(filled, 3, color);
    }
    if let Some(limit) = limit {
        let x = x_of(limit);
        ui.painter().line_segment(
            [egui::pos2(x, rect.top() - 2.0), egui::pos2(x, rect.bottom() + 2.0)],
            Stroke::new(1.5, p.secondary),
        );
    }
}

/// A small coloured square.
pub fn swatch(ui: &mut Ui, color: Color32) -> Response {
    let (rect, response) = ui.allocate_exact_size(vec2(10.0, 10.0), Sense::hover());
    ui.painter().rect_filled(rect, 2, color);
    response
}
