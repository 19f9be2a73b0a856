//! Guidance over the trainer's picture while a person performs an experiment: the current instruction, the remaining
//! time, and a ghost of the fingers to follow.

use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::diagnose::experiment_state::Experiments;
use crate::ui::diagnose::guidance;
use crate::ui::diagnose::guided_experiment::{Guided, Phase};
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{primary_button, remark};
use crate::ui::scene::view::SceneResponse;
use crate::ui::session::Session;
use crate::ui::train::lessons::ghost::Wait;
use crate::ui::train::lessons::state;
use crate::ui::train::lessons::state::Lessons;
use crate::ui::train::lessons::trace::Point;
use crate::ui::train::trainer::live::Trainer;
use egui::{Frame, Margin, Pos2, ProgressBar, Shape, Stroke, Ui, vec2};
use haptics::Vec2;
use haptics::device::HandGoal;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const EXPERIMENT: &str = "Experiment";
    pub const THE_RECORDING_GETS: &str = "The recording gets its end …";
    pub const LEAVE_THE_EXPERIMENT: &str = "Leave the experiment";
    pub const BEGIN: &str = "Begin";
    pub const RECORDED: &str = "Recorded.";
    pub const ADD_TO_THE_DIAGNOSIS: &str = "Add to the diagnosis";
    pub const ONCE_MORE: &str = "Once more";
    pub const EXPERT_WAITS_COME_HERE: &str = "expert waits: come here";
    pub const EXPERT_WAITS_PRESS: &str = "expert waits: press";
    pub const EXPERT_WAITS_LET_GO: &str = "expert waits: let go";
    pub const EXPERT_PRESSES: &str = "expert presses";
}

/// Width of the card, points.
const WIDTH: f32 = 300.0;
/// Radius of a ghost finger, points.
const GHOST: f32 = 12.0;
/// Distance of the text above the fingers, clear of the held object, points.
const WORD_ABOVE: f32 = 52.0;
/// Length of the previewed path, s, and its number of steps.
const AHEAD_S: f64 = 1.5;
const AHEAD_STEPS: u32 = 30;

/// Draws the card of the experiment; also while nothing runs.
pub fn card(ui: &mut Ui, view: &SceneResponse, session: &mut Session) {
    if session.experiments.guided.is_none() {
        return;
    }
    let p = palette(ui);
    let corner = view.rect.left_top() + vec2(space::M, space::M);
    let (mut begin, mut add, mut leave) = (false, false, false);
    egui::Area::new(egui::Id::unique("experiment")).fixed_pos(corner).constrain_to(view.rect).show(ui.ctx(), |ui| {
        let frame = Frame::new().fill(p.card).stroke(Stroke::new(1.0, p.border)).corner_radius(10);
        frame.inner_margin(Margin::same(space::M as i8)).show(ui, |ui| {
            ui.set_width(WIDTH.min(view.rect.width() - 4.0 * space::M));
            let Some(guided) = &session.experiments.guided else { return };
            ui.label(theme::caption(ui, words::EXPERIMENT));
            match &guided.phase {
                Phase::Ready => ready(ui, guided, &mut begin),
                Phase::Going(_) => going(ui, guided, &session.training.trainer),
                Phase::Ending => drop(ui.label(words::THE_RECORDING_GETS)),
                Phase::Recorded(_) => recorded(ui, guided, &mut add, &mut begin),
            }
            ui.add_space(space::XS);
            leave = ui.link(words::LEAVE_THE_EXPERIMENT).clicked();
        });
    });
    let ctx = ui.ctx().clone();
    if begin {
        guidance::begin_experiment(&mut session.experiments, &mut session.training.trainer, &mut session.messages);
    } else if add {
        guidance::add_followed(session, &ctx);
    } else if leave {
        guidance::leave_experiment(&mut session.experiments, &mut session.training.trainer);
    }
}

fn ready(ui: &mut Ui, guided: &Guided, begin: &mut bool) {
    let longest = guided.table.steps.iter().max_by_key(|s| s.words.len());
    if let Some(step) = longest {
        ui.add(egui::Label::new(theme::strong(sentence(&step.words))).wrap());
    }
    let seconds = format::number(guided.table.duration_s(), 0);
    let hung = format::number(guided.hung_n(), 2);
    let hung = if guided.hung_n() > 0.0 { format!(" A weight of {hung} N hangs on it.") } else { String::new() };
    let text = format!("Follow the two rings for {seconds} s; all of it is recorded.{hung}");
    ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
    simulated(ui, guided);
    ui.add_space(space::XS);
    *begin = primary_button(ui, true, (Icon::Play, words::BEGIN)).clicked();
}

/// Names the object of a simulated recording.
fn simulated(ui: &mut Ui, guided: &Guided) {
    if let Some(about) = &guided.about {
        let text = format!("A SIMULATED object, {about}: the recording will say so.");
        remark(ui, Icon::Doubt, text);
    }
}

fn going(ui: &mut Ui, guided: &Guided, trainer: &Trainer) {
    let Some((step, left_s, _)) = guided.now(trainer) else { return };
    ui.add(egui::Label::new(theme::strong(sentence(&step.words))).wrap());
    let place = guided.table.steps.iter().position(|s| s == step).unwrap_or_default() + 1;
    let text = format!("{} s left · {place} of {}", format::number(left_s, 0), guided.table.steps.len());
    ui.label(theme::caption(ui, text));
    let done = guided.time_s(trainer).unwrap_or_default() / guided.table.duration_s();
    ui.add(ProgressBar::new(done as f32).desired_height(6.0).fill(palette(ui).accent));
}

fn recorded(ui: &mut Ui, guided: &Guided, add: &mut bool, begin: &mut bool) {
    ui.label(theme::strong(words::RECORDED));
    simulated(ui, guided);
    ui.add_space(space::XS);
    ui.horizontal(|ui| {
        *add = primary_button(ui, true, (Icon::Add, words::ADD_TO_THE_DIAGNOSIS)).clicked();
        *begin = ui.button((Icon::Reset, words::ONCE_MORE)).clicked();
    });
}

/// Draws two rings at the desired fingertip positions, filled while they should hold, and their future path.
pub fn ghost(ui: &Ui, view: &SceneResponse, experiments: &Experiments, trainer: &Trainer) {
    let Some(guided) = &experiments.guided else { return };
    let Some((step, _, goal)) = guided.now(trainer) else { return };
    let now_s = guided.time_s(trainer).unwrap_or_default();
    let ahead = (0..=AHEAD_STEPS).map(|k| {
        let later_s = now_s + AHEAD_S * f64::from(k) / f64::from(AHEAD_STEPS);
        guided.table.route.at(later_s).0.center_m
    });
    let word = if step.holds { "pinch" } else { "open" };
    rings(ui, view, tips(&goal), &Rings { ahead: ahead.collect(), holds: step.holds, word });
}

/// The same for an expert's fingers in a lesson during practice.
pub fn expert(ui: &Ui, view: &SceneResponse, lessons: &Lessons) {
    let Some(open) = lessons.open.as_deref().filter(|open| open.phase == state::Phase::Practising) else { return };
    let Some(trace) = open.expert.as_deref().filter(|_| !lessons.ghost_off) else { return };
    let now_s = open.ghost.time_s;
    let Some(point) = trace.at(now_s).filter(|_| now_s < trace.duration_s()) else { return };
    let middle = |later_s: f64| trace.at(later_s).map(Point::middle_m);
    let ahead = (0..=AHEAD_STEPS).filter_map(|k| middle(now_s + AHEAD_S * f64::from(k) / f64::from(AHEAD_STEPS)));
    let holds = point.touches();
    let word = match open.ghost.waits {
        Some(Wait::Far) => words::EXPERT_WAITS_COME_HERE,
        Some(Wait::Touch) => words::EXPERT_WAITS_PRESS,
        Some(Wait::LetGo) => words::EXPERT_WAITS_LET_GO,
        None if holds => words::EXPERT_PRESSES,
        None => "expert",
    };
    rings(ui, view, point.tips_in_world, &Rings { ahead: ahead.collect(), holds, word });
}

/// Two rings with their text and path.
struct Rings {
    /// Path of their midpoint, m in the world.
    ahead: Vec<Vec2>,
    holds: bool,
    word: &'static str,
}

fn rings(ui: &Ui, view: &SceneResponse, tips: [Vec2; 2], shown: &Rings) {
    let painter = ui.painter().with_clip_rect(view.rect);
    let (color, halo) = (palette(ui).accent, palette(ui).card);
    let at = |point: Vec2| on_screen(ui, view, point);
    let ahead: Vec<Pos2> = shown.ahead.iter().map(|point| at(*point)).collect();
    let places = beside(tips.map(at));
    // Legible on both bright metal and dark ground.
    for (width, color) in [(6.0, halo), (2.5, color)] {
        painter.add(Shape::line(ahead.clone(), Stroke::new(width, color)));
        for place in places {
            painter.circle_stroke(place, GHOST, Stroke::new(width, color));
        }
    }
    for place in places.into_iter().filter(|_| shown.holds) {
        painter.circle_filled(place, 0.45 * GHOST, color);
    }
    let text = painter.layout_no_wrap(shown.word.to_owned(), egui::FontId::new(12.0, theme::semibold()), color);
    let middle = 0.5 * (tips[0] + tips[1]);
    let corner = at(middle) - vec2(0.5 * text.size().x, WORD_ABOVE + 0.5 * text.size().y);
    painter.rect_filled(egui::Rect::from_min_size(corner, text.size()).expand2(vec2(7.0, 3.0)), 9, halo);
    painter.galley(corner, text, color);
    ui.ctx().request_repaint();
}

/// Screen positions of the rings of two tips. A tip is the inner face of its pad, so its ring is outside of it and does
/// not cover the held object.
fn beside(tips: [Pos2; 2]) -> [Pos2; 2] {
    let apart = tips[1] - tips[0];
    let out = if apart.length() > 1.0 { apart.normalized() } else { egui::Vec2::X };
    [tips[0] - GHOST * out, tips[1] + GHOST * out]
}

fn tips(goal: &HandGoal) -> [Vec2; 2] {
    let half = Vec2::new(0.5 * goal.aperture_m, 0.0);
    [goal.center_m - half, goal.center_m + half]
}

fn on_screen(ui: &Ui, view: &SceneResponse, point_in_world: Vec2) -> Pos2 {
    let pixel = view.camera.pixel_of(point_in_world, view.size);
    view.rect.min + vec2(pixel.x, pixel.y) / ui.pixels_per_point()
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    #[test]
    fn rings_touch_what_is_held_from_both_sides_and_never_each_other() {
        for (left, right) in [(pos2(100.0, 50.0), pos2(127.0, 50.0)), (pos2(10.0, 10.0), pos2(10.0, 10.0))] {
            let rings = beside([left, right]);
            assert!(rings[0].distance(rings[1]) >= 2.0 * GHOST, "{rings:?}");
            assert!((rings[0].distance(left) - GHOST).abs() < 1e-4 && (rings[1].distance(right) - GHOST).abs() < 1e-4);
        }
        // Seen from behind, the left finger is on the right.
        let behind = beside([pos2(60.0, 0.0), pos2(20.0, 0.0)]);
        assert!(behind[0].x > 60.0 && behind[1].x < 20.0, "{behind:?}");
    }
}
