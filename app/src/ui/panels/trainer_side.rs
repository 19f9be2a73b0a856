//! Beside the trainer's picture: world, operator, recording, forces, timing.

use super::{Panel, legend};
use crate::ui::files;
use crate::ui::format;
use crate::ui::jobs::Purpose;
use crate::ui::recorder;
use crate::ui::session::{Session, Workspace};
use crate::ui::theme::{self, palette, role, space};
use crate::ui::trainer::{HandDevice, History, Operator, Trainer, WorldChoice};
use crate::ui::widgets::{card, card_with_head, compact, gauge, light, plain_card, segmented};
use egui::{Align, Layout, Pos2, Rect, RichText, ScrollArea, Sense, Shape, Stroke, Ui, vec2};
use render::ColorRole;

/// Seconds that the running curve shows.
const STRIP_S: f64 = 8.0;

/// The right column of the trainer.
#[derive(Default)]
pub struct TrainerSide;

impl Panel for TrainerSide {
    fn title(&self) -> &'static str {
        "Trainer controls"
    }

    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        // Commands name them, wherever one is.
        session.lessons.load();
        ScrollArea::vertical().id_salt("trainer side").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            let choices = [
                (false, "Free practice", "Any world, any operator"),
                (true, "Lessons", "Tasks that are shown, practised and tested"),
            ];
            ui.vertical_centered(|ui| segmented(ui, &mut session.lessons.shown, &choices));
            if session.lessons.shown {
                super::lessons::side(ui, session);
            } else {
                super::compare::compare(ui, session);
                world(ui, session);
                operator(ui, session);
                plain_card(ui, "Recording", |ui| recorder::controls(ui, session));
            }
            forces(ui, &session.trainer);
            super::assistant::assistant(ui, session);
            if !session.lessons.shown {
                super::measured::beside(ui, &mut session.trainer);
            }
            super::delay::delay(ui, session);
            super::comfort::card(ui, session);
            if session.lessons.shown {
                return;
            }
            super::passivity::passivity(ui, session);
            super::trainer_timing::timing(ui, &session.trainer);
        });
    }
}

fn world(ui: &mut Ui, session: &mut Session) {
    let calibrated = session.analysis.as_ref().filter(|a| !a.world.blocks.is_empty() || a.world.crank.is_some());
    session.trainer.calibrated = calibrated.map(|a| a.world.clone());
    let (has_calibrated, has_file) = (session.trainer.calibrated.is_some(), session.trainer.file.is_some());
    let (mut chosen, mut again) = (None, false);
    let start_over = |ui: &mut Ui| {
        again = ui.link("Start over").on_hover_text("Puts everything back where it started (N)").clicked();
    };
    let without_log = (!has_calibrated).then_some("Fit a recording in Calibrate first");
    let without_file = (!has_file).then_some("Open a world file first");
    let choices = [
        (WorldChoice::Blocks, "Two blocks", "The two wooden blocks of the thesis", None),
        (WorldChoice::Crank, "Crank", "A handle on an arm", None),
        (WorldChoice::Needle, "Needle", "Push it through the bottom of a paper cup, gently", None),
        (WorldChoice::Barrel, "Barrel", "Heavy and on a cable; squeezed too hard, its wall breaks", None),
        (WorldChoice::Switch, "Switch", "Push its knob over and back", None),
        (WorldChoice::Table, "Empty table", "Somewhere to try the fingers", None),
        (WorldChoice::Calibrated, "Calibrated", "The object that was measured from the log", without_log),
        (WorldChoice::File, "From a file", "A world file", without_file),
    ];
    card(ui, "World", start_over, |ui| {
        for pair in choices.chunks(2) {
            ui.columns(pair.len(), |columns| {
                for (ui, (choice, label, hint, missing)) in columns.iter_mut().zip(pair) {
                    chosen = chosen.or(world_choice(ui, session, *choice, (label, hint), *missing));
                }
            });
        }
    });
    if again {
        chosen = Some(session.trainer.choice);
    }
    if let Some(choice) = chosen
        && let Err(problem) = session.trainer.choose(choice)
    {
        session.fail(problem);
    }
}

/// One place of the list, with what is `missing` for it; the choice when it was clicked.
fn world_choice(
    ui: &mut Ui,
    session: &mut Session,
    choice: WorldChoice,
    (label, hint): (&str, &str),
    missing: Option<&str>,
) -> Option<WorldChoice> {
    compact(ui, |ui| {
        let on = session.trainer.choice == choice;
        let response = ui.add_enabled(missing.is_none(), egui::RadioButton::new(on, label));
        let response = response.on_hover_text(hint).on_disabled_hover_text(missing.unwrap_or(hint));
        if choice == WorldChoice::File {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.link("Open …").clicked() {
                    files::ask(ui.ctx(), &mut session.jobs, Purpose::OpenWorld);
                }
            });
        }
        response.clicked().then_some(choice)
    })
}

fn operator(ui: &mut Ui, session: &mut Session) {
    let mut operator = session.trainer.operator;
    let choices = [
        (Operator::You, "You", "The device that is chosen on the Devices page"),
        (Operator::Scripted, "Scripted", "Watch the task done by a scripted operator"),
    ];
    let mut changed = false;
    card_with_head(
        ui,
        "Operator",
        30.0,
        |ui| changed = segmented(ui, &mut operator, &choices),
        |ui| operator_state(ui, session),
    );
    if changed && let Err(problem) = session.trainer.hand_to(operator) {
        session.fail(problem);
    }
}

fn operator_state(ui: &mut Ui, session: &mut Session) {
    match session.trainer.operator {
        Operator::You => {
            let text = match session.trainer.hand {
                HandDevice::Mouse => {
                    format!("Mouse · pinch strength {} N", format::number(session.trainer.pinch.strength_n(), 1))
                }
                _ => session.trainer.hand.title(),
            };
            compact(ui, |ui| {
                ui.label(theme::caption(ui, text));
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    if ui.link("Devices …").on_hover_text("Choose and try what moves the fingers (Ctrl+4)").clicked()
                    {
                        session.workspace = Workspace::Devices;
                    }
                });
            });
        }
        Operator::Scripted => {
            super::script::script(ui, session);
        }
    }
}

fn forces(ui: &mut Ui, trainer: &Trainer) {
    let dark = ui.visuals().dark_mode;
    let p = palette(ui);
    let Some(tick) = trainer.seen_tick() else { return };
    let limit = trainer.config().limits.max_force_n;
    plain_card(ui, "Forces", |ui| {
        let grip = tick.tip_force_n[0].x.min(-tick.tip_force_n[1].x).max(0.0);
        let lift = tick.tip_force_n[0].y + tick.tip_force_n[1].y;
        for (label, value, color) in [
            ("Left finger", tick.tip_force_n[0].norm(), role(dark, ColorRole::Finger(0))),
            ("Right finger", tick.tip_force_n[1].norm(), role(dark, ColorRole::Finger(1))),
            ("Grip", grip, role(dark, ColorRole::Measured)),
        ] {
            let over = value > limit;
            gauge(ui, label, value, 1.25 * limit, limit, if over { p.danger } else { color });
        }
        measure(ui, "Net force, up", lift);
        legend::gauges(ui, limit);
        strip(ui, &trainer.history, limit);
        ui.add_space(space::XS);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = space::M;
            light(ui, tick.flags.saturated, p.danger, "Saturated", "A force was clamped to the maximum");
            light(ui, tick.flags.slewing, p.caution, "Slew", "A force was slowed down: it changed too fast");
            light(ui, tick.flags.stale, p.danger, "Stale", "No fresh sample from the device: the force is zero");
            light(ui, tick.flags.not_finite, p.danger, "Invalid", "A value was not a number and was refused");
        });
    });
}

fn measure(ui: &mut Ui, label: &str, newtons: f64) {
    compact(ui, |ui| {
        ui.label(theme::caption(ui, label));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.label(RichText::new(format!("{} N", format::number(newtons, 2))).size(12.0));
        });
    });
}

/// Grip and net force of the last seconds, and what its lines are.
fn strip(ui: &mut Ui, history: &History, limit: f64) {
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 64.0), Sense::hover());
    ui.painter().rect_filled(rect, 4, palette(ui).sunken);
    if let Some(newest) = history.newest() {
        curves(ui, rect, history, newest.time_s, limit);
    }
    legend::strip(ui, STRIP_S);
}

fn curves(ui: &Ui, rect: Rect, history: &History, now_s: f64, limit: f64) {
    let (dark, p) = (ui.visuals().dark_mode, palette(ui));
    let (low, high) = (-0.3 * limit, 1.1 * limit);
    let at = |time_s: f64, newtons: f64| {
        let x = rect.right() - ((now_s - time_s) / STRIP_S) as f32 * rect.width();
        let y = rect.bottom() - ((newtons - low) / (high - low)).clamp(0.0, 1.0) as f32 * rect.height();
        Pos2::new(x, y)
    };
    ui.painter().hline(rect.x_range(), at(now_s, 0.0).y, Stroke::new(1.0, p.border));
    let limit_line = [at(now_s - STRIP_S, limit), at(now_s, limit)];
    ui.painter().extend(Shape::dashed_line(&limit_line, Stroke::new(1.0, p.danger.gamma_multiply(0.6)), 4.0, 4.0));
    let curves = [
        (ColorRole::Measured, history.moments().map(|m| at(m.time_s, m.grip_n)).collect::<Vec<_>>()),
        (ColorRole::Block(0), history.moments().map(|m| at(m.time_s, m.lift_n)).collect()),
    ];
    for (color, points) in curves {
        ui.painter().with_clip_rect(rect).add(Shape::line(points, Stroke::new(1.6, role(dark, color))));
    }
}
