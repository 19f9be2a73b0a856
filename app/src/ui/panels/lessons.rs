//! Lessons beside the trainer's picture: the list, what one is about, and how far an attempt is.

use super::debrief;
use crate::ui::dock::Pane;
use crate::ui::icons::{self, Icon};
use crate::ui::lessons::{Open, Phase};
use crate::ui::session::Session;
use crate::ui::theme::{self, palette, space};
use crate::ui::widgets::{bar, card, compact, plain_card, primary_button, recording_light, remark};
use crate::ui::{format, markdown};
use egui::{Align, Color32, Layout, RichText, Ui, vec2};
use estimator::training::lesson::{Lesson, Standing};
use std::sync::Arc;

/// What a click asks for.
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

/// All of it.
pub fn side(ui: &mut Ui, session: &mut Session) {
    session.lessons.load();
    let wish = if session.lessons.open.is_some() { open(ui, session) } else { list(ui, session) };
    let ctx = ui.ctx().clone();
    match wish {
        Some(Wish::Open(lesson)) => session.open_lesson(&ctx, &lesson),
        Some(Wish::Close) => session.close_lesson(),
        Some(Wish::Watch) => session.watch_lesson(),
        Some(Wish::Practise) => session.practise_lesson(),
        Some(Wish::Test) => session.test_lesson(),
        Some(Wish::Back) => session.back_to_brief(),
        Some(Wish::End(answer)) => session.end_lesson(&ctx, answer),
        Some(Wish::OpenLog(path)) => session.open(&ctx, &path),
        Some(Wish::Progress) => session.wanted_pane = Some(Pane::Progress),
        None => {}
    }
}

fn list(ui: &mut Ui, session: &Session) -> Option<Wish> {
    let mut wish = None;
    plain_card(ui, "Lessons", |ui| {
        ui.label(theme::caption(ui, "From the first touch to the real task. Each is shown, practised and tested."));
        ui.add_space(space::XS);
        for (place, lesson) in session.lessons.all.iter().enumerate() {
            if row(ui, place + 1, lesson) {
                wish = Some(Wish::Open(Arc::clone(lesson)));
            }
        }
        for problem in &session.lessons.problems {
            remark(ui, Icon::Wrong, problem);
        }
    });
    wish
}

/// A lesson in the list; true when it was chosen.
fn row(ui: &mut Ui, number: usize, lesson: &Lesson) -> bool {
    let mut chosen = false;
    compact(ui, |ui| {
        ui.add_sized(vec2(20.0, 18.0), egui::Label::new(theme::caption(ui, number.to_string())));
        chosen = ui.link(&lesson.title).on_hover_text(&lesson.goal).clicked();
    });
    chosen
}

fn open(ui: &mut Ui, session: &mut Session) -> Option<Wish> {
    let mut wish = None;
    let open = session.lessons.open.as_deref()?;
    let (trainer, mut ghost_off) = (&session.trainer, session.lessons.ghost_off);
    let all = |ui: &mut Ui| {
        if ui.link("All lessons").clicked() {
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
                    ui.label("Looking at the recording …");
                });
                None
            }
            Phase::Debrief(debrief) => {
                debrief::show(ui, debrief, open.expert.as_deref());
                ui.add_space(space::S);
                debriefed(ui, debrief, session.learning.trainee.as_deref())
            }
        };
    });
    session.lessons.ghost_off = ghost_off;
    wish.or(asked)
}

fn brief(ui: &mut Ui, open: &Open) -> Option<Wish> {
    markdown::show(ui, &open.lesson.text);
    ui.add_space(space::XS);
    goals(ui, open, false);
    ui.add_space(space::S);
    buttons(
        ui,
        &[("Watch", "The expert shows it", Wish::Watch), ("Practise", "Try it; nothing is recorded", Wish::Practise)],
        Some(((Icon::Check, "Take the test"), Wish::Test)),
    )
}

fn watching(ui: &mut Ui, open: &Open, step: Option<usize>, over: bool) -> Option<Wish> {
    ui.label(theme::caption(ui, if over { "That was all." } else { "An expert shows it:" }));
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
        &[("Again", "Watch it once more", Wish::Watch), ("Back", "What the lesson is about", Wish::Back)],
        Some(((Icon::Touch, "Practise"), Wish::Practise)),
    )
}

fn practising(ui: &mut Ui, open: &Open, ghost_off: &mut bool) -> Option<Wish> {
    clock(ui, open, None);
    goals(ui, open, true);
    let mut ghost = !*ghost_off;
    ui.checkbox(&mut ghost, "Ghost of the expert's fingers")
        .on_hover_text("Rings that go where an expert's fingers go");
    *ghost_off = !ghost;
    ui.add_space(space::S);
    buttons(
        ui,
        &[
            ("Start over", "Everything back to its place", Wish::Practise),
            ("Back", "What the lesson is about", Wish::Back),
        ],
        Some(((Icon::Check, "Take the test"), Wish::Test)),
    )
}

fn testing(ui: &mut Ui, open: &Open) -> Option<Wish> {
    clock(ui, open, Some(open.lesson.at_most_s));
    goals(ui, open, true);
    ui.add_space(space::S);
    buttons(ui, &[("Give up", "What was done until now is looked at", Wish::End(None))], None)
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

fn debriefed(ui: &mut Ui, shown: &crate::ui::lessons::Debrief, trainee: Option<&str>) -> Option<Wish> {
    let mut wish = buttons(
        ui,
        &[("Practise", "Try it; nothing is recorded", Wish::Practise), ("Watch", "The expert shows it", Wish::Watch)],
        Some(((Icon::Reset, "Once more"), Wish::Test)),
    );
    let link = ui.link("Open its recording in Calibrate").on_hover_text(shown.path.display().to_string());
    if link.clicked() {
        wish = Some(Wish::OpenLog(shown.path.clone()));
    }
    let kept = trainee.map_or("Who practises? Attempts are kept by name …".to_owned(), |name| {
        format!("Kept for {name}: see the progress …")
    });
    if ui.link(kept).on_hover_text("The panel Progress: who practises, all attempts, the learning curve").clicked() {
        wish = Some(Wish::Progress);
    }
    wish
}

/// The time since the hand began, and what is left of it.
fn clock(ui: &mut Ui, open: &Open, at_most_s: Option<f64>) {
    compact(ui, |ui| {
        if at_most_s.is_some() {
            recording_light(ui);
        }
        ui.label(theme::strong(format!("{} s", format::number(open.progress.running_s(), 1))));
        let what = at_most_s.map_or("practice, not recorded".to_owned(), |most| {
            format!("recorded · {} s at the most", format::number(most, 0))
        });
        ui.label(theme::caption(ui, what));
    });
    if open.progress.is_completed() {
        ui.label(RichText::new("All goals reached.").color(palette(ui).good));
    }
}

/// Goals and rules, with how far they are.
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

/// A line with a round mark before it: ticked once it is reached.
fn mark(ui: &mut Ui, ticked: bool, color: Color32, says: &str) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 8.0;
        if ticked { Icon::Good } else { Icon::Pending }.show(ui, icons::SIZE, color);
        ui.add(egui::Label::new(RichText::new(says).size(12.5)).wrap());
    });
}

/// The usual buttons, and the one thing to do on the right.
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

/// What to do now, for the line over the picture; nothing outside of lessons.
pub fn hint(session: &Session) -> Option<String> {
    let open = session.lessons.open.as_deref()?;
    match &open.phase {
        Phase::Watching => {
            let step = open.step(&session.trainer)?;
            Some(open.lesson.demonstration.get(step)?.says.clone())
        }
        Phase::Practising | Phase::Testing => {
            if let Some(broken) = open.progress.broken() {
                return Some(format!("That went wrong: {}", broken.says));
            }
            let next = open.progress.standings().find(|(_, s)| !s.reached);
            Some(next.map_or("All goals reached.".to_owned(), |(goal, _)| goal.says.clone()))
        }
        Phase::Asking => Some("Answer the question on the right.".to_owned()),
        Phase::Grading => Some("Looking at the recording …".to_owned()),
        Phase::Brief | Phase::Debrief(_) => Some(open.lesson.goal.clone()),
    }
}
