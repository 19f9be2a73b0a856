//! Result of an attempt: the score, every judged measure beside the expert reference, the path of the hand beside an
//! expert's.

use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, role, space};
use crate::ui::kit::widgets::{compact, remark};
use crate::ui::train::lessons::state::Debrief;
use crate::ui::train::lessons::trace::Trace;
use egui::{Align, Layout, Pos2, Rect, RichText, Sense, Shape, Stroke, Ui, vec2};
use estimator::training::definitions::Definition;
use estimator::training::lesson::advice::shown;
use estimator::training::lesson::{Figure, Grade};
use haptics::Vec2;
use render::ColorRole;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const NOT_COMPLETED: &str = "Not completed";
    pub const SCALE_MORE: &str =
        "100 is the experts' average; half of it for every five of their spreads that you are worse";
    pub const OF_100: &str = "of 100, the experts' average";
    pub const YOUR_WAY: &str = "your way";
    pub const AN_EXPERTS: &str = "an expert's";
}

/// Height of the picture of both paths, points.
const WAYS: f32 = 120.0;
/// Position of the experts' mean on a scale (share of its length), and the scale's length in units.
const MEAN_AT: f32 = 0.25;
const UNITS: f64 = 8.0;

/// Draws the whole result.
pub fn show(ui: &mut Ui, debrief: &Debrief, expert: Option<&Trace>) {
    let grade = &debrief.grade;
    score(ui, grade);
    ui.add_space(space::XS);
    ui.add(egui::Label::new(grade.advice.as_str()).wrap());
    ui.add_space(space::S);
    for missed in grade.goals.iter().chain(&grade.rules).filter(|goal| !goal.reached) {
        remark(ui, Icon::Wrong, &missed.says);
    }
    for figure in &grade.figures {
        measure(ui, figure);
    }
    ways(ui, &debrief.trace, expert);
}

fn score(ui: &mut Ui, grade: &Grade) {
    let p = palette(ui);
    ui.horizontal(|ui| {
        let Some(score) = grade.score else {
            ui.label(theme::title(words::NOT_COMPLETED));
            return;
        };
        let color = if grade.meets_criterion { p.good } else { p.text };
        ui.label(RichText::new(format!("{score:.0}")).font(egui::FontId::new(38.0, theme::semibold())).color(color))
            .on_hover_text(words::SCALE_MORE);
        ui.vertical(|ui| {
            ui.add_space(space::XS);
            ui.label(theme::caption(ui, words::OF_100));
            let criterion = grade.score_criterion;
            let text = if grade.meets_criterion {
                format!("Proficient: {criterion:.0} or more. Twice in a row counts.")
            } else {
                format!("Proficient from {criterion:.0} on.")
            };
            ui.label(RichText::new(text).size(11.5).color(if grade.meets_criterion { p.good } else { p.secondary }));
        });
    });
}

/// Draws one measure: its value, and its position relative to the experts.
fn measure(ui: &mut Ui, figure: &Figure) {
    let Some(definition) = Definition::of(&figure.measure) else { return };
    let p = palette(ui);
    let hint = format!(
        "{}\nExperts: {} ± {}.",
        definition.text,
        shown(figure.expert_mean, definition.unit),
        shown(figure.expert_sd, definition.unit)
    );
    compact(ui, |ui| {
        ui.label(theme::caption(ui, definition.name)).on_hover_text(&hint);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let value = RichText::new(shown(figure.value, definition.unit)).size(12.0);
            ui.label(if figure.meets_criterion { value.color(p.good) } else { value });
        });
    });
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 8.0), Sense::hover());
    response.on_hover_text(hint);
    let x = |units: f64| {
        let share = MEAN_AT + (1.0 - MEAN_AT) * (units / UNITS) as f32;
        rect.left() + rect.width() * share.clamp(0.0, 1.0)
    };
    ui.painter().rect_filled(
        Rect::from_min_max(rect.left_top(), rect.right_bottom()).shrink2(vec2(0.0, 2.0)),
        2,
        p.sunken,
    );
    // The experts: their mean ± one unit.
    let band = Rect::from_x_y_ranges(x(-1.0)..=x(1.0), rect.y_range().shrink(2.0));
    ui.painter().rect_filled(band, 2, p.good.gamma_multiply(0.35));
    ui.painter().vline(x(0.0), rect.y_range(), Stroke::new(1.0, p.secondary));
    let color = if figure.meets_criterion { p.good } else { p.accent };
    ui.painter().circle_filled(Pos2::new(x(figure.worse_by), rect.center().y), 4.0, color);
    ui.add_space(2.0);
}

/// Draws the path of the midpoint between the fingers, and an expert's below it.
fn ways(ui: &mut Ui, own: &Trace, expert: Option<&Trace>) {
    let p = palette(ui);
    let dark = ui.visuals().dark_mode;
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), WAYS), Sense::hover());
    ui.painter().rect_filled(rect, 4, p.sunken);
    let all: Vec<Vec2> = own.middles().chain(expert.into_iter().flat_map(Trace::middles)).collect();
    let bounds = |of: fn(&Vec2) -> f64| {
        all.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let ((left, right), (low, high)) = (bounds(|v| v.x), bounds(|v| v.y));
    let inner = rect.shrink(space::S);
    // The same scale on both axes, so that shapes are true.
    let scale =
        (f64::from(inner.width()) / (right - left).max(1e-3)).min(f64::from(inner.height()) / (high - low).max(1e-3));
    let middle = Vec2::new(0.5 * (left + right), 0.5 * (low + high));
    let at = |point: Vec2| {
        let away = (point - middle) * scale;
        inner.center() + vec2(away.x as f32, -away.y as f32)
    };
    let color = role(dark, ColorRole::Finger(0));
    let lines = [(expert, p.secondary.gamma_multiply(0.8), 1.5), (Some(own), color, 1.8)];
    for (trace, color, width) in lines.into_iter().filter_map(|(t, c, w)| Some((t?, c, w))) {
        let points: Vec<Pos2> = trace.middles().map(at).collect();
        ui.painter().with_clip_rect(rect).add(Shape::line(points, Stroke::new(width, color)));
    }
    compact(ui, |ui| {
        crate::ui::kit::widgets::swatch(ui, color);
        ui.label(theme::caption(ui, words::YOUR_WAY));
        if expert.is_some() {
            crate::ui::kit::widgets::swatch(ui, p.secondary.gamma_multiply(0.8));
            ui.label(theme::caption(ui, words::AN_EXPERTS));
        }
    });
}
