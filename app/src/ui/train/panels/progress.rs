//! *Progress*: the trainee, the learning curve at a lesson, and the attempts.

use crate::history::attempt::Attempt;
use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::document::files;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{Palette, palette, space};
use crate::ui::kit::widgets::{call, compact, empty_state, plain_card};
use crate::ui::plots::axes::{decimals, marks};
use crate::ui::plots::residual_plot::inks;
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::panel::{Framing, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::learning::{Learned, Learning, Practised};
use egui::{
    Align, Align2, ComboBox, FontId, Grid, Key, Layout, Mesh, Pos2, Rect, RichText, ScrollArea, Sense, Shape, Stroke,
    TextEdit, Ui, pos2, vec2,
};
use egui_tiles::ContainerKind;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const WHO_PRACTISES: &str = "Who practises";
    pub const CHOOSE_WHO_PRACTISES: &str =
        "Choose who practises, or add them: their attempts at lessons are kept and shown here.";
    pub const NO_ATTEMPTS_YET: &str = "No attempts yet";
    pub const LEARNING: &str = "Learning";
    pub const ATTEMPTS: &str = "Attempts";
    pub const NOBODY_YET: &str = "Nobody yet";
    pub const TRAINEE: &str = "Trainee";
    pub const NEW_TRAINEE_HINT: &str = "Name of a new one";
    pub const NEW_TRAINEE: &str = "Name of a new trainee";
    pub const ADD: &str = "Add";
    pub const NOTHING_IS_KEPT: &str = "Nothing is kept: the system names no folder for data. Set HOME or \
        XDG_DATA_HOME, then start the program again.";
    pub const NONE_OF_THESE: &str = "None of these attempts has a score.";
    pub const LESSON: &str = "Lesson";
    pub const CRITERION_MET: &str = "criterion met";
    pub const MEAN_OF_A_SESSION: &str = "mean of a session";
    pub const ONE_ATTEMPT: &str = "one attempt";
    pub const THE_SCORES_DO: &str = "The scores do not change by more than chance would make them.";
    pub const SIX_SCORES_OR_MORE: &str = "Six scores or more show a curve.";
    pub const NOT_PROFICIENT_YET: &str = "Not proficient yet: that is the criterion met twice in a row.";
    pub const SCORE: &str = "Score";
    pub const NUMBER_OF_THE_ATTEMPT: &str = "Number of the attempt";
    pub const ONE_ATTEMPT_ALONE: &str = "One attempt.";
    pub const SAVE_AS_A_TABLE_MORE: &str = "All attempts of this trainee at every lesson, every measure a column";
    pub const SAVE_AS_A_TABLE: &str = "Save as a table …";
    pub const BEGUN: &str = "Begun";
    pub const TOOK: &str = "Took";
    pub const CRITERION: &str = "Criterion";
    pub const RECORDING: &str = "Recording";
    pub const NOT_COMPLETED: &str = "not completed";
    pub const NOT_MET: &str = "not met";
}

/// Format of an attempt's time.
const DATE_FORMAT: &str = "%Y-%m-%d %H:%M UTC";

/// Height of the curve, points, and the space for its numbers.
const CURVE: f32 = 240.0;
const NUMBERS: [f32; 2] = [40.0, 36.0];
/// Height of the axis title above the plot, points.
const NAME: f32 = 20.0;
/// Radius of an attempt's mark, points.
const MARK: f32 = 3.5;
/// Height of a row of the table, points.
const ROW: f32 = 18.0;
/// Maximum number of attempts in the table: the last ones.
const MOST_ROWS: usize = 200;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Train, 2)],
    neighbours: &[(PanelId::TRAINER, ContainerKind::Tabs, false)],
    pictures: &[&PROGRESS_PICTURE],
    ..Registration::new(PanelId::PROGRESS, "Progress", Icon::Progress, || Box::new(ProgressPanel))
};

/// Picture of a trainee's progress, from a made-up history.
pub static PROGRESS_PICTURE: Picture = Picture {
    name: "progress",
    place: 210,
    help: "How a trainee gets better, from a made-up history",
    line: "Progress: a trainee's learning curve at a lesson (a made-up history)",
    size: [720, 760],
    sample: Sample::World("stack"),
    session: stage::progress,
    framing: Framing::Panel(|| Box::new(ProgressPanel)),
};

/// Panel of the trainee's progress.
#[derive(Default)]
pub struct ProgressPanel;

impl Panel for ProgressPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        ScrollArea::vertical().id_salt("progress").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            plain_card(ui, words::WHO_PRACTISES, |ui| who(ui, &mut session.training.learning));
            if session.training.learning.attempts.is_empty() {
                let text = match &session.training.learning.trainee {
                    Some(name) => {
                        format!("{name} has not attempted a lesson yet. What they do is kept and shown here.")
                    }
                    None => words::CHOOSE_WHO_PRACTISES.to_owned(),
                };
                empty_state(ui, (Icon::Progress, words::NO_ATTEMPTS_YET), &text, |_| {});
                return;
            }
            plain_card(ui, words::LEARNING, |ui| learning(ui, &mut session.training.learning));
            plain_card(ui, words::ATTEMPTS, |ui| attempts(ui, &session.training.learning, &mut session.jobs));
        });
    }
}

fn who(ui: &mut Ui, learning: &mut Learning) {
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        let shown = learning.trainee.clone().unwrap_or_else(|| words::NOBODY_YET.to_owned());
        let list = ComboBox::from_id_salt("trainee").selected_text(shown).width(180.0).truncate();
        let list = list.show_ui(ui, |ui| {
            for name in &learning.trainees {
                if ui.selectable_label(learning.trainee.as_ref() == Some(name), name).clicked() {
                    chosen = Some(name.clone());
                }
            }
        });
        call(&list.response, words::TRAINEE);
        ui.add_space(space::S);
        let is_kept = learning.is_kept();
        let field = TextEdit::singleline(&mut learning.name_field).hint_text(words::NEW_TRAINEE_HINT);
        let response = ui.add_enabled(is_kept, field.desired_width(150.0));
        call(&response, words::NEW_TRAINEE);
        let entered = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Enter));
        let named = is_kept && !learning.name_field.trim().is_empty();
        if ui.add_enabled(named, egui::Button::new((Icon::Add, words::ADD))).clicked() || (entered && named) {
            learning.add_trainee();
        }
    });
    if let Some(name) = chosen {
        learning.choose(&name);
    }
    if !learning.is_kept() {
        let text = words::NOTHING_IS_KEPT;
        ui.add(egui::Label::new(theme::caption(ui, text)).wrap());
    }
}

fn learning(ui: &mut Ui, learning: &mut Learning) {
    lessons(ui, learning);
    let learned = learning.learned.clone();
    let expert = learning.shown().and_then(|p| learning.experts.get(&p.lesson).copied());
    if learned.tries.is_empty() {
        ui.label(theme::caption(ui, words::NONE_OF_THESE));
        return;
    }
    ui.add_space(space::XS);
    curve(ui, &learned, expert);
    ui.add(egui::Label::new(theme::caption(ui, in_words(&learned))).wrap());
}

/// Draws the chooser of the lesson.
fn lessons(ui: &mut Ui, learning: &mut Learning) {
    let (practised, shown) = (learning.practised(), learning.shown());
    let mut chosen: Option<Practised> = None;
    ui.horizontal(|ui| {
        let words = shown.as_ref().map(Practised::words).unwrap_or_default();
        let list =
            ComboBox::from_id_salt("lesson").selected_text(words).width(ui.available_width().min(260.0)).truncate();
        let list = list.show_ui(ui, |ui| {
            for one in &practised {
                if ui.selectable_label(shown.as_ref() == Some(one), one.words()).clicked() {
                    chosen = Some(one.clone());
                }
            }
        });
        call(&list.response, words::LESSON);
    });
    if chosen.is_some() {
        learning.look_at(chosen);
    }
    let (p, model) = (palette(ui), inks(ui).model);
    ui.horizontal_wrapped(|ui| {
        for (words, color) in [("attempt", model), (words::CRITERION_MET, p.good)] {
            key(ui, words, |ui, rect| {
                ui.painter().circle_filled(rect.center(), MARK, color);
            });
        }
        key(ui, words::MEAN_OF_A_SESSION, |ui, rect| {
            ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(1.5, p.secondary));
        });
    });
}

/// Draws a legend entry: a mark and its meaning.
fn key(ui: &mut Ui, words: &str, mark: impl FnOnce(&Ui, Rect)) {
    let (rect, _) = ui.allocate_exact_size(vec2(10.0, ROW), Sense::hover());
    mark(ui, rect);
    ui.label(theme::caption(ui, words));
    ui.add_space(space::S);
}

/// Text about the learning curve.
fn in_words(learned: &Learned) -> String {
    let number = |value: f64| format::significant(value, 3);
    let mut words = Vec::new();
    if let Some((first, last, mean, half)) = learned.sessions.last() {
        let half = half.map_or(String::new(), |half| format!(" ± {}", format::significant(half, 2)));
        let count = last + 1 - first;
        let of = if count == 1 { words::ONE_ATTEMPT.to_owned() } else { format!("{count} attempts") };
        words.push(format!("Last session: {}{half} in {of} (mean, 95 % interval).", number(*mean)));
    }
    match &learned.curve {
        Some(curve) if curve.is_seen => words.push(format!(
            "Power law of practice (band: 95 % interval): it goes to {}, with an exponent of {} [{}, {}].",
            number(curve.level),
            format::significant(curve.exponent, 2),
            format::significant(curve.exponent_interval[0], 2),
            format::significant(curve.exponent_interval[1], 2)
        )),
        Some(_) => words.push(words::THE_SCORES_DO.to_owned()),
        None => words.push(words::SIX_SCORES_OR_MORE.to_owned()),
    }
    words.push(match learned.proficient_at {
        Some(attempt) => format!("Proficient after attempt {attempt}: the criterion was met twice in a row."),
        None => words::NOT_PROFICIENT_YET.to_owned(),
    });
    words.join(" ")
}

/// Map from numbers to positions in the picture.
struct Axes {
    plot: Rect,
    last: f64,
    heights: (f64, f64),
}

impl Axes {
    fn of(plot: Rect, learned: &Learned, expert: Option<f64>) -> Self {
        let scores = learned.tries.iter().map(|(_, t)| t.value).chain(expert);
        let sessions = learned
            .sessions
            .iter()
            .flat_map(|(.., mean, half)| [mean - half.unwrap_or(0.0), mean + half.unwrap_or(0.0)]);
        let curve = learned.points.iter().map(|p| p.value);
        let (low, high) =
            scores.chain(sessions).chain(curve).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
        let room = 0.08 * (high - low).max(1e-6 + 0.01 * high.abs());
        let last = learned.points.last().map_or(0.0, |p| p.attempt).max(learned.attempts.len() as f64);
        Self { plot, last: last + 0.5, heights: (low - room, high + room) }
    }

    fn at(&self, attempt: f64, value: f64) -> Pos2 {
        let right = ((attempt - 0.5) / (self.last - 0.5)) as f32;
        let up = ((value - self.heights.0) / (self.heights.1 - self.heights.0)) as f32;
        pos2(self.plot.left() + right * self.plot.width(), self.plot.bottom() - up * self.plot.height())
    }

    /// Draws a quiet grid with its numbers.
    fn draw(&self, ui: &Ui) {
        let (p, font) = (palette(ui), FontId::proportional(11.0));
        let painter = ui.painter();
        painter.rect_filled(self.plot, 4, p.sunken);
        let grid = Stroke::new(0.5, p.border);
        for mark in marks((1.0, self.last), 8.0).into_iter().filter(|m| m.value >= 1.0 && m.step_size >= 1.0) {
            let at = self.at(mark.value, self.heights.0);
            painter.vline(at.x, self.plot.y_range(), grid);
            let text = format::number(mark.value, 0);
            painter.text(pos2(at.x, at.y + 4.0), Align2::CENTER_TOP, text, font.clone(), p.secondary);
        }
        let inside = |m: &f64| (self.heights.0..=self.heights.1).contains(m);
        for mark in marks(self.heights, 5.0).into_iter().filter(|m| inside(&m.value)) {
            let at = self.at(0.5, mark.value);
            painter.hline(self.plot.x_range(), at.y, grid);
            let text = format::number(mark.value, decimals(mark.step_size));
            painter.text(pos2(at.x - 6.0, at.y), Align2::RIGHT_CENTER, text, font.clone(), p.secondary);
        }
        let above = self.plot.left_top() - vec2(0.0, 5.0);
        painter.text(above, Align2::LEFT_BOTTOM, words::SCORE, font.clone(), p.secondary);
        let below = self.plot.center_bottom() + vec2(0.0, NUMBERS[1]);
        painter.text(below, Align2::CENTER_BOTTOM, words::NUMBER_OF_THE_ATTEMPT, font, p.secondary);
    }
}

/// Draws attempts, session means, the power law with its confidence band, and the expert level.
fn curve(ui: &mut Ui, learned: &Learned, expert: Option<f64>) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), CURVE), Sense::hover());
    let spoken = format!("Scores of {} attempts, in their order", learned.tries.len());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, &spoken));
    let plot = Rect::from_min_max(rect.min + vec2(NUMBERS[0], NAME), rect.max - vec2(4.0, NUMBERS[1]));
    let axes = Axes::of(plot, learned, expert);
    axes.draw(ui);
    let (p, inks) = (palette(ui), inks(ui));
    let painter = ui.painter().with_clip_rect(plot);
    if learned.curve.as_ref().is_some_and(|curve| curve.is_seen) {
        painter.add(Shape::mesh(band(learned, &axes, inks.noise)));
        let line = learned.points.iter().map(|point| axes.at(point.attempt, point.value)).collect();
        painter.add(Shape::line(line, Stroke::new(2.0, p.accent)));
    }
    for (first, last, mean, half) in &learned.sessions {
        let (left, right) = (axes.at(*first as f64 - 0.35, *mean), axes.at(*last as f64 + 0.35, *mean));
        let stroke = Stroke::new(1.5, p.secondary);
        painter.line_segment([left, right], stroke);
        if let Some(half) = half {
            let middle = 0.5 * (*first + *last) as f64;
            painter.line_segment([axes.at(middle, mean - half), axes.at(middle, mean + half)], stroke);
        }
    }
    for (number, t) in &learned.tries {
        let color = if t.meets_criterion { p.good } else { inks.model };
        painter.circle_filled(axes.at(*number as f64, t.value), MARK, color);
    }
    if let Some(expert) = expert {
        let ends = [axes.at(0.5, expert), axes.at(axes.last, expert)];
        painter.extend(Shape::dashed_line(&ends, Stroke::new(2.0, p.good), 6.0, 4.0));
        let at = ends[1] - vec2(6.0, 3.0);
        painter.text(at, Align2::RIGHT_BOTTOM, "expert", FontId::proportional(11.0), p.good);
    }
    hints(&response, learned, &axes);
}

fn band(learned: &Learned, axes: &Axes, color: egui::Color32) -> Mesh {
    let mut mesh = Mesh::default();
    for point in &learned.points {
        for value in point.interval {
            mesh.colored_vertex(axes.at(point.attempt, value.clamp(axes.heights.0, axes.heights.1)), color);
        }
    }
    for k in 1..learned.points.len() as u32 {
        let (a, b) = (2 * k - 2, 2 * k);
        mesh.add_triangle(a, a + 1, b);
        mesh.add_triangle(a + 1, b, b + 1);
    }
    mesh
}

/// Shows a tooltip for the attempt under the pointer.
fn hints(response: &egui::Response, learned: &Learned, axes: &Axes) {
    let Some(pointer) = response.hover_pos() else { return };
    let near = |(number, t): &&(usize, estimator::training::progress::Try)| {
        axes.at(*number as f64, t.value).distance(pointer) < 2.5 * MARK
    };
    if let Some((number, t)) = learned.tries.iter().find(near)
        && let Some(attempt) = learned.attempts.get(number - 1)
    {
        let text = format!("Attempt {number}: {}, {}", format::significant(t.value, 3), when(attempt));
        response.clone().on_hover_text_at_pointer(text);
    }
}

/// Time of an attempt, as `2026-11-22 19:05 UTC`.
fn when(attempt: &Attempt) -> String {
    attempt.began.strftime(DATE_FORMAT).to_string()
}

fn attempts(ui: &mut Ui, learning: &Learning, jobs: &mut Jobs<Session>) {
    compact(ui, |ui| {
        let all = learning.learned.attempts.len();
        ui.label(theme::caption(
            ui,
            if all == 1 { words::ONE_ATTEMPT_ALONE.to_owned() } else { format!("{all} attempts.") },
        ));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let hint = words::SAVE_AS_A_TABLE_MORE;
            if ui.link(words::SAVE_AS_A_TABLE).on_hover_text(hint).clicked() {
                files::ask(ui.ctx(), jobs, dialogs::SAVE_HISTORY);
            }
        });
    });
    ui.add_space(space::XS);
    let p = palette(ui);
    ui.spacing_mut().interact_size.y = ROW;
    let rows = &learning.learned.attempts;
    // In a narrow panel the table is wider than its card.
    ScrollArea::horizontal().id_salt("table").show(ui, |ui| table(ui, rows, p));
}

fn table(ui: &mut Ui, rows: &[Attempt], p: &Palette) {
    Grid::new("attempts").num_columns(6).striped(true).spacing(vec2(space::L, space::XS)).show(ui, |ui| {
        for name in ["", words::BEGUN, words::TOOK, words::SCORE, words::CRITERION, words::RECORDING] {
            ui.label(theme::caption(ui, name));
        }
        ui.end_row();
        for (k, attempt) in rows.iter().enumerate().rev().take(MOST_ROWS) {
            ui.label(theme::caption(ui, (k + 1).to_string()));
            ui.label(RichText::new(when(attempt)).size(12.0));
            ui.label(RichText::new(format!("{} s", format::number(attempt.duration_s, 1))).size(12.0));
            let score = attempt.score.map_or_else(|| "–".to_owned(), |score| format::significant(score, 3));
            ui.label(RichText::new(score).size(12.0).strong());
            let (criterion, color) = match (attempt.completed, attempt.meets_criterion) {
                (false, _) => (words::NOT_COMPLETED, p.caution),
                (true, true) => ("met", p.good),
                (true, false) => (words::NOT_MET, p.secondary),
            };
            ui.label(RichText::new(criterion).size(12.0).color(color));
            let file = attempt.recording.as_ref().map(|path| (crate::text::file_name::name_of(path), path));
            match file {
                Some((name, path)) => {
                    ui.add(egui::Label::new(RichText::new(name).size(12.0)).truncate())
                        .on_hover_text(path.display().to_string());
                }
                None => {
                    ui.label("");
                }
            }
            ui.end_row();
        }
    });
}
