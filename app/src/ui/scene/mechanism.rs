//! A recording without a place in space: one coordinate, drawn as a carriage on a rail or as a dial.

use crate::ui::format;
use crate::ui::prepare::Prepared;
use crate::ui::session::Session;
use crate::ui::theme::{self, palette};
use egui::{Align2, FontId, Pos2, Rect, Stroke, Vec2, vec2};
use render::ColorRole;

/// Draws the mechanism at the cursor.
pub fn mechanism_view(ui: &mut egui::Ui, session: &Session, prepared: &Prepared) {
    let (rect, _) = ui.allocate_exact_size(ui.available_size(), egui::Sense::hover());
    let p = palette(ui);
    ui.painter().rect_filled(rect.shrink(1.0), theme::CARD_RADIUS, p.sunken);
    let sample = prepared.sample_at(session.cursor_s);
    let recording = &prepared.recording;
    let force = recording.channel("f_N").or_else(|| recording.channel("tau_Nm"));
    let force = force.map(|f| (f[sample], f.iter().fold(0.0_f64, |m, v| m.max(v.abs()))));
    if let Some(q) = recording.channel("q_m") {
        rail(ui, rect, q, sample, force);
    } else if let Some(q) = recording.channel("q_rad") {
        dial(ui, rect, q[sample], force);
    } else {
        let text = "This recording has no path: there is nothing to place in space.";
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, FontId::proportional(13.0), p.secondary);
    }
}

fn rail(ui: &egui::Ui, rect: Rect, q: &[f64], sample: usize, force: Option<(f64, f64)>) {
    let (p, dark, painter) = (palette(ui), ui.visuals().dark_mode, ui.painter());
    let (low, high) = q.iter().fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(*v), b.max(*v)));
    let span = (high - low).max(1e-9);
    let inset = rect.shrink2(vec2(rect.width() * 0.12, 0.0));
    let y = rect.center().y + 10.0;
    let x_of = |value: f64| inset.left() + ((value - low) / span) as f32 * inset.width();
    painter.line_segment(
        [Pos2::new(inset.left() - 30.0, y), Pos2::new(inset.right() + 30.0, y)],
        Stroke::new(4.0, p.border),
    );
    for tick in 0..=10 {
        let value = low + span * f64::from(tick) / 10.0;
        let x = x_of(value);
        let long = if tick % 5 == 0 { 12.0 } else { 7.0 };
        painter.line_segment([Pos2::new(x, y + 26.0), Pos2::new(x, y + 26.0 + long)], Stroke::new(1.0, p.faint));
        if tick % 5 == 0 {
            let text = format!("{} mm", format::number(value * 1e3, 0));
            let at = Pos2::new(x, y + 44.0);
            painter.text(at, Align2::CENTER_TOP, text, FontId::proportional(11.5), p.secondary);
        }
    }
    let body = Rect::from_center_size(Pos2::new(x_of(q[sample]), y - 2.0), vec2(64.0, 40.0));
    painter.rect_filled(body, 5, theme::role(dark, ColorRole::Block(0)));
    if let Some((now, most)) = force {
        arrow(painter, body.center_top() + vec2(0.0, -24.0), vec2((now / most.max(1e-9)) as f32 * 120.0, 0.0), dark);
        label(ui, rect, &format!("{} N", format::number(now, 2)));
    }
}

fn dial(ui: &egui::Ui, rect: Rect, q: f64, force: Option<(f64, f64)>) {
    let (p, dark, painter) = (palette(ui), ui.visuals().dark_mode, ui.painter());
    let radius = 0.3 * rect.height().min(rect.width());
    let center = rect.center();
    painter.circle(center, radius, p.card, Stroke::new(2.0, p.border));
    for tick in 0..12 {
        let along = Vec2::angled(-f32::from(tick as u8) * std::f32::consts::TAU / 12.0);
        painter.line_segment([center + along * (radius - 8.0), center + along * radius], Stroke::new(1.0, p.faint));
    }
    let arm = Vec2::angled(-q as f32) * radius * 0.92;
    let color = theme::role(dark, ColorRole::Block(0));
    painter.line_segment([center, center + arm], Stroke::new(7.0, color));
    painter.circle_filled(center, 8.0, p.text);
    painter.circle_filled(center + arm, 9.0, color);
    if let Some((now, most)) = force {
        let push = arm.rot90() * (-(now / most.max(1e-9)) as f32 * 0.6);
        arrow(painter, center + arm, push, dark);
        label(ui, rect, &format!("{} N·m", format::number(now, 3)));
    }
}

fn arrow(painter: &egui::Painter, from: Pos2, along: Vec2, dark: bool) {
    if along.length() > 2.0 {
        painter.arrow(from, along, Stroke::new(3.0, theme::role(dark, ColorRole::Measured)));
    }
}

fn label(ui: &egui::Ui, rect: Rect, text: &str) {
    let at = rect.center_top() + vec2(0.0, 24.0);
    ui.painter().text(at, Align2::CENTER_TOP, text, FontId::new(18.0, theme::semibold()), palette(ui).text);
}
