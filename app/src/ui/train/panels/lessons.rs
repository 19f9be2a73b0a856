//! Lessons beside the trainer's picture: the list, the description of a lesson, and the progress of an attempt.

use crate::text::format;
use crate::ui::document::opening;
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::markdown;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{bar, card, compact, plain_card, primary_button, recording_light, remark};
use crate::ui::session::Session;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::train::lessons::practising;
use crate::ui::train::lessons::state::{Lessons, Open, Phase};
use crate::ui::train::panels::debrief;
use crate::ui::train::state::Training;
use egui::{Align, Color32, Layout, RichText, Ui, vec2};
use estimator::training::lesson::{Lesson, Standing};
use std::sync::Arc;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const LESSONS: &str = "Lessons";
    pub const LESSONS_MORE: &str = "From the first touch to the real task. Each is shown, practised and tested.";
    pub const ALL_LESSONS: &str = "All lessons";
    pub const LOOKING_AT_THE_RECORDING: &str = "Looking at the recording …";
    pub const WATCH: &str = "Watch";
    pub const WATCH_MORE: &str = "The expert shows it";
    pub const PRACTISE: &str = "Practise";
    pub const PRACTISE_MORE: &str = "Try it; nothing is recorded";
    pub const TAKE_THE_TEST: &str = "Take the test";
    pub const THAT_WAS_ALL: &str = "That was all.";
    pub const AN_EXPERT_SHOWS_IT: &str = "An expert shows it:";
    pub const AGAIN: &str = "Again";
    pub const AGAIN_MORE: &str = "Watch it once more";
    pub const BACK: &str = "Back";
    pub const BACK_MORE: &str = "What the lesson is about";
    pub const GHOST_OF_THE_EXPERTS: &str = "Ghost of the expert's fingers";
    pub const GHOST_OF_THE_EXPERTS_MORE: &str = "Rings that go where an expert's fingers go";
    pub const START_OVER: &str = "Start over";
    pub const START_OVER_MORE: &str = "Everything back to its place";
    pub const GIVE_UP: &str = "Give up";
    pub const GIVE_UP_MORE: &str = "What was done until now is looked at";
    pub const ONCE_MORE: &str = "Once more";
    pub const OPEN_ITS_RECORDING: &str = "Open its recording in Calibrate";
    pub const WHO_PRACTISES_ATTEMPTS: &str = "Who practises? Attempts are kept by name …";
    pub const THE_PANEL_PROGRESS: &str = "The panel Progress: who practises, all attempts, the learning curve";
    pub const PRACTICE_NOT_RECORDED: &str = "practice, not recorded";
    pub const ALL_GOALS_REACHED: &str = "All goals reached.";
    pub const ANSWER_THE_QUESTION: &str = "Answer the question on the right.";
}

/// Request of a click.
#[derive(Clone)]
enum Wish {
    Open(Arc<Lesson>),
    Close,
    Watch,
    Practise,
    Test,
    Back,
    End(Option<usize>),
    OpenLog(std::path::PathBuf),
    Progress,
}

/// Draws the whole column.
pub fn side(ui: &mut Ui, session: &mut Session) {
    session.training.lessons.load();
    let wish = if session.training.lessons.open.is_some() {
        open(ui, &mut session.training)
    } else {
        list(ui, &session.training.lessons)
    };
    let ctx = ui.ctx().clone();
    match wish {
        Some(Wish::Open(lesson)) => {
            practising::open_lesson(&mut session.training, &mut session.messages, &mut session.jobs, &ctx, &lesson);
        }
        Some(Wish::Close) => practising::close_lesson(&mut session.training, &mut session.messages),
        Some(Wish::Watch) => practising::watch_lesson(&mut session.training, &mut session.messages),
        Some(Wish::Practise) => practising::practise_lesson(&mut session.training, &mut session.messages),
        Some(Wish::Test) => practising::test_lesson(&mut session.training, &mut session.messages),
        Some(Wish::Back) => practising::back_to_brief(&mut session.training, &mut session.messages),
        Some(Wish::End(answer)) => practising::end_lesson(&mut session.training, &mut session.jobs, &ctx, answer),
        Some(Wish::OpenLog(path)) => opening::open(&mut session.document, &mut session.jobs, &ctx, &path),
        Some(Wish::Progress) => session.wanted_pane = Some(PanelId::PROGRESS),
        None => {}
    }
}

fn list(ui: &mut Ui, lessons: &Lessons) -> Option<Wish> {
    let mut wish = None;
    plain_card(ui, words::LESSONS, |ui| {
        ui.label(theme::caption(ui, words::LESSONS_MORE));
        ui.add_space(space::XS);
        for (place, lesson) in lessons.all.iter().enumerate() {
            if row(ui, place + 1, lesson) {
                wish = Some(Wish::Open(Arc::clone(lesson)));
            }
        }
        for problem in &lessons.problems {
            remark(ui, Icon::Wrong, problem);
        }
    });
    wish
}

/// Draws a lesson of the list; true when it was chosen.
fn row(ui: &mut Ui, number: usize, lesson: &Lesson) -> bool {
    let mut chosen = false;
    compact(ui, |ui| {
        ui.add_sized(vec2(20.0, 18.0), egui::Label::new(theme::caption(ui, number.to_string())));
        chosen = ui.link(&lesson.title).on_hover_text(&lesson.goal).clicked();
    });
    chosen
}

fn open(ui: &mut Ui, training: &mut Training) -> Option<Wish> {
    let mut wish = None;
    let open = training.lessons.open.as_deref()?;
    let (trainer, mut ghost_off) = (&training.trainer, training.lessons.ghost_off);
    let all = |ui: &mut Ui| {
        if ui.link(words::ALL_LESSONS).clicked() {
            wish = Some(Wish::Close);
        }
    };
    let mut asked = None;
    card(ui, &open.lesson.title, all, |ui| {
        asked = match &open.phase {
            Phase::Brief => brief(ui, open),
            Phase::Watching => watching(ui, open, open.step(trainer), trainer.performance_over()),
            Phase::Practising => practising(ui, open, &mut ghost_off),
            Phase::Testing => testing(ui, open),
            Phase::Asking => asking(ui, open),
            Phase::Grading => {
                ui.horizontal(|ui| {
                    ui.spinner();
                    ui.label(words::LOOKING_AT_THE_RECORDING);
                });
                None
            }
            Phase::Debrief(debrief) => {
                debrief::show(ui, debrief, open.expert.as_deref());
                ui.add_space(space::S);
                debriefed(ui, debrief, training.learning.trainee.as_deref())
            }
        };
    });
    training.lessons.ghost_off = ghost_off;
    wish.or(asked)
}

fn brief(ui: &mut Ui, open: &Open) -> Option<Wish> {
    markdown::show(ui, &open.lesson.text);
    ui.add_space(space::XS);
    goals(ui, open, false);
    ui.add_space(space::S);
    buttons(
        ui,
        &[(words::WATCH, words::WATCH_MORE, Wish::Watch), (words::PRACTISE, words::PRACTISE_MORE, Wish::Practise)],
        Some(((Icon::Check, words::TAKE_THE_TEST), Wish::Test)),
    )
}

fn watching(ui: &mut Ui, open: &Open, step: Option<usize>, over: bool) -> Option<Wish> {
    ui.label(theme::caption(ui, if over { words::THAT_WAS_ALL } else { words::AN_EXPERT_SHOWS_IT }));
    for (place, shown) in open.lesson.demonstration.iter().enumerate() {
        let now = step == Some(place) && !over;
        let text = RichText::new(format!("{}  {}", place + 1, shown.says));
        let p = palette(ui);
        let text = if now { text.color(p.accent).strong() } else { text.color(p.secondary) };
        ui.add(egui::Label::new(text).wrap());
    }
    ui.add_space(space::S);
    buttons(
        ui,
        &[(words::AGAIN, words::AGAIN_MORE, Wish::Watch), (words::BACK, words::BACK_MORE, Wish::Back)],
        Some(((Icon::Touch, words::PRACTISE), Wish::Practise)),
    )
}

fn practising(ui: &mut Ui, open: &Open, ghost_off: &mut bool) -> Option<Wish> {
    clock(ui, open, None);
    goals(ui, open, true);
    let mut ghost = !*ghost_off;
    ui.checkbox(&mut ghost, words::GHOST_OF_THE_EXPERTS).on_hover_text(words::GHOST_OF_THE_EXPERTS_MORE);
    *ghost_off = !ghost;
    ui.add_space(space::S);
    buttons(
        ui,
        &[(words::START_OVER, words::START_OVER_MORE, Wish::Practise), (words::BACK, words::BACK_MORE, Wish::Back)],
        Some(((Icon::Check, words::TAKE_THE_TEST), Wish::Test)),
    )
}

fn testing(ui: &mut Ui, open: &Open) -> Option<Wish> {
    clock(ui, open, Some(open.lesson.at_most_s));
    goals(ui, open, true);
    ui.add_space(space::S);
    buttons(ui, &[(words::GIVE_UP, words::GIVE_UP_MORE, Wish::End(None))], None)
}

fn asking(ui: &mut Ui, open: &Open) -> Option<Wish> {
    let question = open.lesson.question.as_ref()?;
    ui.add(egui::Label::new(theme::strong(question.asks.as_str())).wrap());
    ui.add_space(space::XS);
    let mut wish = None;
    for (index, answer) in question.answers.iter().enumerate() {
        let button = egui::Button::new(answer.as_str()).wrap().min_size(vec2(ui.available_width(), 30.0));
        if ui.add(button).clicked() {
            wish = Some(Wish::End(Some(index)));
        }
    }
    wish
}

fn debriefed(ui: &mut Ui, shown: &crate::ui::train::lessons::state::Debrief, trainee: Option<&str>) -> Option<Wish> {
    let mut wish = buttons(
        ui,
        &[(words::PRACTISE, words::PRACTISE_MORE, Wish::Practise), (words::WATCH, words::WATCH_MORE, Wish::Watch)],
        Some(((Icon::Reset, words::ONCE_MORE), Wish::Test)),
    );
    let link = ui.link(words::OPEN_ITS_RECORDING).on_hover_text(shown.path.display().to_string());
    if link.clicked() {
        wish = Some(Wish::OpenLog(shown.path.clone()));
    }
    let kept =
        trainee.map_or(words::WHO_PRACTISES_ATTEMPTS.to_owned(), |name| format!("Kept for {name}: see the progress …"));
    if ui.link(kept).on_hover_text(words::THE_PANEL_PROGRESS).clicked() {
        wish = Some(Wish::Progress);
    }
    wish
}

/// Draws the time since the hand's first motion, and the remaining time.
fn clock(ui: &mut Ui, open: &Open, at_most_s: Option<f64>) {
    compact(ui, |ui| {
        if at_most_s.is_some() {
            recording_light(ui);
        }
        ui.label(theme::strong(format!("{} s", format::number(open.progress.running_s(), 1))));
        let what = at_most_s.map_or(words::PRACTICE_NOT_RECORDED.to_owned(), |most| {
            format!("recorded · {} s at the most", format::number(most, 0))
        });
        ui.label(theme::caption(ui, what));
    });
    if open.progress.is_completed() {
        ui.label(RichText::new(words::ALL_GOALS_REACHED).color(palette(ui).good));
    }
}

/// Draws goals and rules with their progress.
fn goals(ui: &mut Ui, open: &Open, running: bool) {
    let p = palette(ui);
    for (goal, standing) in open.progress.standings() {
        let Standing { reached, share } = standing;
        let color = if reached && running { p.good } else { p.secondary };
        mark(ui, reached && running, color, &goal.says);
        if running && !reached && share > 0.0 {
            ui.horizontal(|ui| {
                ui.add_space(20.0);
                bar(ui, share, 1.0, None, p.accent);
            });
        }
    }
    for (rule, kept) in open.progress.rules() {
        mark(ui, false, if kept { p.secondary } else { p.danger }, &rule.says);
    }
}

/// Draws a line with a round mark, ticked once the goal is reached.
fn mark(ui: &mut Ui, ticked: bool, color: Color32, says: &str) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 8.0;
        if ticked { Icon::Good } else { Icon::Pending }.show(ui, icons::SIZE, color);
        ui.add(egui::Label::new(RichText::new(says).size(12.5)).wrap());
    });
}

/// Draws the secondary buttons, and the main button on the right.
fn buttons(ui: &mut Ui, usual: &[(&str, &str, Wish)], main: Option<((Icon, &str), Wish)>) -> Option<Wish> {
    let mut wish = None;
    ui.horizontal(|ui| {
        for (label, hint, what) in usual {
            if ui.button(*label).on_hover_text(*hint).clicked() {
                wish = Some(what.clone());
            }
        }
        if let Some((label, what)) = main {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if primary_button(ui, true, label).clicked() {
                    wish = Some(what);
                }
            });
        }
    });
    wish
}

/// Current instruction for the line over the picture; `None` outside of lessons.
pub fn hint(training: &Training) -> Option<String> {
    let open = training.lessons.open.as_deref()?;
    match &open.phase {
        Phase::Watching => {
            let step = open.step(&training.trainer)?;
            Some(open.lesson.demonstration.get(step)?.says.clone())
        }
        Phase::Practising | Phase::Testing => {
            if let Some(broken) = open.progress.broken() {
                return Some(format!("That went wrong: {}", broken.says));
            }
            let next = open.progress.standings().find(|(_, s)| !s.reached);
            Some(next.map_or(words::ALL_GOALS_REACHED.to_owned(), |(goal, _)| goal.says.clone()))
        }
        Phase::Asking => Some(words::ANSWER_THE_QUESTION.to_owned()),
        Phase::Grading => Some(words::LOOKING_AT_THE_RECORDING.to_owned()),
        Phase::Brief | Phase::Debrief(_) => Some(open.lesson.goal.clone()),
    }
}
