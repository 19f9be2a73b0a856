//! The column beside the trainer's picture: world, operator, recording, forces, timing.

use crate::text::format;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::files;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, role, space};
use crate::ui::kit::widgets::{card, card_with_head, compact, gauge, light, plain_card, segmented};
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel::{Panel, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::panels::legend;
use crate::ui::train::recorder;
use crate::ui::train::trainer::hand::HandDevice;
use crate::ui::train::trainer::history::History;
use crate::ui::train::trainer::live::{Operator, Trainer};
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui::{Align, Layout, Pos2, Rect, RichText, ScrollArea, Sense, Shape, Stroke, Ui, vec2};
use render::ColorRole;

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const FREE: &str = "Free practice";
    pub const FREE_MORE: &str = "Any world, any operator";
    pub const LESSONS: &str = "Lessons";
    pub const LESSONS_MORE: &str = "Tasks that are shown, practised and tested";
    pub const START_OVER: &str = "Start over";
    pub const START_OVER_MORE: &str = "Puts everything back where it started (N)";
    pub const NO_FIT: &str = "Fit a recording in Calibrate first";
    pub const NO_FILE: &str = "Open a world file first";
    pub const BLOCKS: &str = "Two blocks";
    pub const BLOCKS_MORE: &str = "The two wooden blocks of the thesis";
    pub const CRANK: &str = "Crank";
    pub const CRANK_MORE: &str = "A handle on an arm";
    pub const NEEDLE: &str = "Needle";
    pub const NEEDLE_MORE: &str = "Push it through the bottom of a paper cup, gently";
    pub const BARREL: &str = "Barrel";
    pub const BARREL_MORE: &str = "Heavy and on a cable; squeezed too hard, its wall breaks";
    pub const SWITCH: &str = "Switch";
    pub const SWITCH_MORE: &str = "Push its knob over and back";
    pub const TABLE: &str = "Empty table";
    pub const TABLE_MORE: &str = "Somewhere to try the fingers";
    pub const CALIBRATED: &str = "Calibrated";
    pub const CALIBRATED_MORE: &str = "The object that was measured from the log";
    pub const FILE: &str = "From a file";
    pub const FILE_MORE: &str = "A world file";
    pub const OPEN: &str = "Open …";
    pub const YOU: &str = "You";
    pub const YOU_MORE: &str = "The device that is chosen on the Devices page";
    pub const SCRIPTED: &str = "Scripted";
    pub const SCRIPTED_MORE: &str = "Watch the task done by a scripted operator";
    pub const DEVICES: &str = "Devices …";
    pub const DEVICES_MORE: &str = "Choose and try what moves the fingers (Ctrl+4)";
    pub const SATURATED: &str = "Saturated";
    pub const SATURATED_MORE: &str = "A force was clamped to the maximum";
    pub const SLEW: &str = "Slew";
    pub const SLEW_MORE: &str = "A force was slowed down: it changed too fast";
    pub const STALE: &str = "Stale";
    pub const STALE_MORE: &str = "No fresh sample from the device: the force is zero";
    pub const INVALID: &str = "Invalid";
    pub const INVALID_MORE: &str = "A value was not a number and was refused";
    pub const RECORDING: &str = "Recording";
    pub const WORLD: &str = "World";
    pub const OPERATOR: &str = "Operator";
    pub const FORCES: &str = "Forces";
    pub const LEFT_FINGER: &str = "Left finger";
    pub const RIGHT_FINGER: &str = "Right finger";
    pub const GRIP: &str = "Grip";
    pub const NET_FORCE_UP: &str = "Net force, up";
}

/// Length of the live curve, s.
const STRIP_S: f64 = 8.0;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Train, 1)],
    ..Registration::new(PanelId::TRAINER_SIDE, "Trainer", Icon::Panel, || Box::new(TrainerSide))
};

/// The right column of the trainer.
#[derive(Default)]
pub struct TrainerSide;

impl Panel for TrainerSide {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        // The command palette lists them in every workspace.
        session.training.lessons.load();
        ScrollArea::vertical().id_salt("trainer side").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            let choices = [(false, words::FREE, words::FREE_MORE), (true, words::LESSONS, words::LESSONS_MORE)];
            ui.vertical_centered(|ui| segmented(ui, &mut session.training.lessons.shown, &choices));
            if session.training.lessons.shown {
                crate::ui::train::panels::lessons::side(ui, session);
            } else {
                crate::ui::train::panels::before_after::compare(
                    ui,
                    &mut session.training.trainer,
                    &mut session.messages,
                );
                world(
                    ui,
                    &session.calibration,
                    &mut session.training.trainer,
                    &mut session.messages,
                    &mut session.jobs,
                );
                operator(ui, &mut session.workspace, &mut session.training.trainer, &mut session.messages);
                plain_card(ui, words::RECORDING, |ui| {
                    recorder::controls(
                        ui,
                        &mut session.document,
                        &mut session.training.trainer,
                        &mut session.messages,
                        &mut session.jobs,
                    );
                });
            }
            forces(ui, &session.training.trainer);
            crate::ui::train::panels::assistant::assistant(ui, &mut session.training);
            if !session.training.lessons.shown {
                crate::ui::calibrate::panels::measured::beside(ui, &mut session.training.trainer);
            }
            crate::ui::train::panels::delay::delay(ui, &mut session.training.trainer, &mut session.messages);
            crate::ui::train::panels::comfort::card(ui, &mut session.training.comfort);
            if session.training.lessons.shown {
                return;
            }
            crate::ui::train::panels::passivity::passivity(ui, &mut session.training.trainer, &mut session.messages);
            crate::ui::train::panels::trainer_timing::timing(ui, &session.training.trainer);
        });
    }
}

fn world(
    ui: &mut Ui,
    calibration: &Calibration,
    trainer: &mut Trainer,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
) {
    let calibrated = calibration.analysis.as_ref().filter(|a| !a.world.blocks.is_empty() || a.world.crank.is_some());
    trainer.calibrated = calibrated.map(|a| a.world.clone());
    let (has_calibrated, has_file) = (trainer.calibrated.is_some(), trainer.file.is_some());
    let (mut chosen, mut again) = (None, false);
    let start_over = |ui: &mut Ui| {
        again = ui.link(words::START_OVER).on_hover_text(words::START_OVER_MORE).clicked();
    };
    let without_log = (!has_calibrated).then_some(words::NO_FIT);
    let without_file = (!has_file).then_some(words::NO_FILE);
    let choices = [
        (WorldChoice::Blocks, words::BLOCKS, words::BLOCKS_MORE, None),
        (WorldChoice::Crank, words::CRANK, words::CRANK_MORE, None),
        (WorldChoice::Needle, words::NEEDLE, words::NEEDLE_MORE, None),
        (WorldChoice::Barrel, words::BARREL, words::BARREL_MORE, None),
        (WorldChoice::Switch, words::SWITCH, words::SWITCH_MORE, None),
        (WorldChoice::Table, words::TABLE, words::TABLE_MORE, None),
        (WorldChoice::Calibrated, words::CALIBRATED, words::CALIBRATED_MORE, without_log),
        (WorldChoice::File, words::FILE, words::FILE_MORE, without_file),
    ];
    card(ui, words::WORLD, start_over, |ui| {
        for pair in choices.chunks(2) {
            ui.columns(pair.len(), |columns| {
                for (ui, (choice, label, hint, missing)) in columns.iter_mut().zip(pair) {
                    chosen = chosen.or(world_choice(ui, trainer, jobs, *choice, (label, hint), *missing));
                }
            });
        }
    });
    if again {
        chosen = Some(trainer.choice);
    }
    if let Some(choice) = chosen
        && let Err(problem) = trainer.choose(choice)
    {
        messages.fail(problem);
    }
}

/// Draws one entry of the list, with its `missing` requirement. Returns the choice when it was clicked.
fn world_choice(
    ui: &mut Ui,
    trainer: &Trainer,
    jobs: &mut Jobs<Session>,
    choice: WorldChoice,
    (label, hint): (&str, &str),
    missing: Option<&str>,
) -> Option<WorldChoice> {
    compact(ui, |ui| {
        let on = trainer.choice == choice;
        let response = ui.add_enabled(missing.is_none(), egui::RadioButton::new(on, label));
        let response = response.on_hover_text(hint).on_disabled_hover_text(missing.unwrap_or(hint));
        if choice == WorldChoice::File {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.link(words::OPEN).clicked() {
                    files::ask(ui.ctx(), jobs, dialogs::OPEN_WORLD);
                }
            });
        }
        response.clicked().then_some(choice)
    })
}

fn operator(ui: &mut Ui, workspace: &mut Workspace, trainer: &mut Trainer, messages: &mut Messages) {
    let mut operator = trainer.operator;
    let choices =
        [(Operator::You, words::YOU, words::YOU_MORE), (Operator::Scripted, words::SCRIPTED, words::SCRIPTED_MORE)];
    let mut changed = false;
    card_with_head(
        ui,
        words::OPERATOR,
        30.0,
        |ui| changed = segmented(ui, &mut operator, &choices),
        |ui| operator_state(ui, workspace, trainer, messages),
    );
    if changed && let Err(problem) = trainer.hand_to(operator) {
        messages.fail(problem);
    }
}

fn operator_state(ui: &mut Ui, workspace: &mut Workspace, trainer: &mut Trainer, messages: &mut Messages) {
    match trainer.operator {
        Operator::You => {
            let text = match trainer.hand {
                HandDevice::Mouse => {
                    format!("Mouse · pinch strength {} N", format::number(trainer.pinch.strength_n(), 1))
                }
                _ => trainer.hand.title(),
            };
            compact(ui, |ui| {
                ui.label(theme::caption(ui, text));
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    if ui.link(words::DEVICES).on_hover_text(words::DEVICES_MORE).clicked() {
                        *workspace = Workspace::Devices;
                    }
                });
            });
        }
        Operator::Scripted => {
            crate::ui::train::panels::scripted_operator::script(ui, trainer, messages);
        }
    }
}

fn forces(ui: &mut Ui, trainer: &Trainer) {
    let dark = ui.visuals().dark_mode;
    let p = palette(ui);
    let Some(tick) = trainer.seen_tick() else { return };
    let limit = trainer.config().limits.max_force_n;
    plain_card(ui, words::FORCES, |ui| {
        let grip = tick.tip_force_n[0].x.min(-tick.tip_force_n[1].x).max(0.0);
        let lift = tick.tip_force_n[0].y + tick.tip_force_n[1].y;
        for (label, value, color) in [
            (words::LEFT_FINGER, tick.tip_force_n[0].norm(), role(dark, ColorRole::Finger(0))),
            (words::RIGHT_FINGER, tick.tip_force_n[1].norm(), role(dark, ColorRole::Finger(1))),
            (words::GRIP, grip, role(dark, ColorRole::Measured)),
        ] {
            let over = value > limit;
            gauge(ui, label, value, 1.25 * limit, limit, if over { p.danger } else { color });
        }
        measure(ui, words::NET_FORCE_UP, lift);
        legend::gauges(ui, limit);
        strip(ui, &trainer.history, limit);
        ui.add_space(space::XS);
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = space::M;
            light(ui, tick.flags.saturated, p.danger, words::SATURATED, words::SATURATED_MORE);
            light(ui, tick.flags.slewing, p.caution, words::SLEW, words::SLEW_MORE);
            light(ui, tick.flags.stale, p.danger, words::STALE, words::STALE_MORE);
            light(ui, tick.flags.not_finite, p.danger, words::INVALID, words::INVALID_MORE);
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

/// Draws grip and net force of the last seconds, with a legend.
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
