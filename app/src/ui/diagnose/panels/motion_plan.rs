//! The motion that an experiment requires of a mechanism: a curve to follow on the real machine, and a file of it.

use crate::experiment::motion_plan::MotionPlan;
use crate::text::format;
use crate::ui::diagnose::experiment;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::palette;
use crate::ui::plots::axes::{decimals, marks};
use crate::ui::session::Session;
use egui::{Align2, FontId, Pos2, Rect, Sense, Stroke, Ui, pos2, vec2};
use estimator::diagnose::Experiment;
use haptics::law::Coordinate;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const SAVE_TOOL_MORE: &str =
        "Writes time and the tool's place as a CSV into the folder of recordings, for a machine that can follow it";
    pub const SAVE_COORDINATE_MORE: &str =
        "Writes time and coordinate as a CSV into the folder of recordings, for a machine that can follow it";
    pub const SAVE_THE_PLAN: &str = "Save the plan";
}

/// Height of the curve, and space for numbers left of it and below, points.
const HEIGHT: f32 = 132.0;
const NUMBERS: [f32; 2] = [40.0, 18.0];
/// Number of curve points per point of width.
const FINENESS: f32 = 2.0;

/// Draws the curve, and the button that saves it.
pub fn show(ui: &mut Ui, session: &mut Session, asked: &Experiment, coordinate: Coordinate) {
    let plan = match MotionPlan::new(asked) {
        Ok(plan) => plan,
        Err(problem) => {
            ui.add(egui::Label::new(theme::caption(ui, problem)).wrap());
            return;
        }
    };
    let (unit, factor) = shown(coordinate);
    let text = format!("Move the real one like this: its coordinate in {unit} over seconds.");
    ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
    curve(ui, &plan, factor);
    let ctx = ui.ctx().clone();
    let hint = if experiment::path_of_tool(&session.document, &session.calibration).is_some() {
        words::SAVE_TOOL_MORE
    } else {
        words::SAVE_COORDINATE_MORE
    };
    if ui.button((Icon::Save, words::SAVE_THE_PLAN)).on_hover_text(hint).clicked() {
        experiment::save_motion_plan(session, &ctx, &plan, coordinate);
    }
}

fn shown(coordinate: Coordinate) -> (&'static str, f64) {
    let si: &'static str = match coordinate {
        Coordinate::Linear => "m",
        Coordinate::Angular => "rad",
    };
    format::channel_unit(si)
}

fn curve(ui: &mut Ui, plan: &MotionPlan, factor: f64) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    let seconds = format::number(plan.duration_s(), 0);
    response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, format!("Plan of the motion, {seconds} s")));
    if !ui.is_rect_visible(rect) {
        return;
    }
    let plot = Rect::from_min_max(rect.min + vec2(NUMBERS[0], 6.0), rect.max - vec2(6.0, NUMBERS[1]));
    let (low, high) = plan.range();
    let spare = 0.06 * (high - low);
    let (low, high) = (factor * (low - spare), factor * (high + spare));
    let duration_s = plan.duration_s();
    let at = |time_s: f64, q: f64| -> Pos2 {
        let x = plot.left() + plot.width() * (time_s / duration_s) as f32;
        pos2(x, plot.bottom() - plot.height() * ((q - low) / (high - low)) as f32)
    };
    let (p, painter) = (palette(ui), ui.painter());
    let font = FontId::proportional(10.5);
    painter.rect_filled(plot, 4.0, p.sunken);
    for mark in marks((low, high), f64::from(plot.height() / 26.0)) {
        let y = at(0.0, mark.value).y;
        painter.hline(plot.x_range(), y, Stroke::new(1.0, p.border));
        let text = format::number(mark.value, decimals(mark.step_size));
        painter.text(pos2(plot.left() - 5.0, y), Align2::RIGHT_CENTER, text, font.clone(), p.secondary);
    }
    for mark in marks((0.0, duration_s), f64::from(plot.width() / 60.0)) {
        let x = at(mark.value, low).x;
        let text = format!("{} s", format::number(mark.value, decimals(mark.step_size)));
        let inside = x.min(plot.right() - 14.0);
        painter.text(pos2(inside, plot.bottom() + 3.0), Align2::CENTER_TOP, text, font.clone(), p.secondary);
    }
    let count = (FINENESS * plot.width()).max(2.0) as u32;
    let points = (0..=count).map(|k| {
        let time_s = duration_s * f64::from(k) / f64::from(count);
        at(time_s, factor * plan.at(time_s))
    });
    painter.line(points.collect(), Stroke::new(1.5, p.accent));
}
