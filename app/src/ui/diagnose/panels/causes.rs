//! Answer of a diagnosis, beside its curves: the verdict, the causes, the extended model, the next experiment.

use crate::text::diagnosis_words::{compared_unit, headline, residual_unit, title};
use crate::text::format;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::actions;
use crate::ui::diagnose::panels::{cause_card, false_alarms, next_experiment, residuals, validation, why_not};
use crate::ui::diagnose::state::{Answer, DIAGNOSE, Diagnosing, EXTEND};
use crate::ui::document::files;
use crate::ui::document::state::Document;
use crate::ui::headless::gallery::sample::Sample;
use crate::ui::headless::stage;
use crate::ui::kit::icons;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{bar, card, compact, plain_card, primary_button, remark};
use crate::ui::plots::residual_plot::inks;
use crate::ui::session::Session;
use crate::ui::shell::dialogs;
use crate::ui::shell::panel::{COLUMN, Framing, Panel, Picture, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use egui::{Align, Color32, Layout, RichText, ScrollArea, Ui, vec2};
use estimator::diagnose::{Findings, Residual};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const DIAGNOSIS: &str = "Diagnosis";
    pub const AGAIN: &str = "Again";
    pub const DIAGNOSE_ONCE_MORE: &str = "Diagnose once more";
    pub const MODEL: &str = "Model";
    pub const WITH_WHAT_WAS_FOUND: &str = "With what was found";
    pub const NOISE: &str = "Noise";
    pub const FORCE_LEFT_OVER: &str = "Force left over on data that chose and fitted nothing, RMS.";
    pub const LEFT_OVER_BY_STATE: &str = "Left over, state by state";
    pub const FOUND: &str = "Found";
    pub const EXTENDED_MODEL: &str = "Extended model";
    pub const A_WORLD_WITH_THE_FOUND: &str = "A world with the found laws in it, beside one with the model alone.";
    pub const EXTEND_THE_MODEL: &str = "Extend the model";
    pub const FEEL_IT_IN_TRAIN: &str = "Feel it in Train";
    pub const FEEL_IT_IN_TRAIN_MORE: &str = "Switch between both worlds while you hold the object";
    pub const SAVE_WORLD: &str = "Save world …";
    pub const SAVE_WORLD_MORE: &str = "Writes the extended world as a file";
    pub const COULD_NOT_HAVE: &str = "Could not have been seen here";
    pub const THEY_ARE_NOT: &str = "They are not excluded: this motion does not show them.";
    pub const WARNINGS: &str = "Warnings";
}

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Diagnose, 1)],
    has_contents: |session| session.diagnosing.answer.is_some(),
    pictures: &[&EXPERIMENT],
    ..Registration::new(PanelId::DIAGNOSIS, "Diagnosis", Icon::Diagnose, || Box::new(DiagnosisPanel))
};

/// Picture of a diagnosis with the next experiment, rehearsed.
pub static EXPERIMENT: Picture = Picture {
    name: "experiment",
    place: 190,
    help: "What a diagnosis answers, with what to record next, rehearsed",
    line: "What to record next, rehearsed on simulated objects",
    size: COLUMN,
    sample: Sample::Askew,
    session: stage::rehearsed,
    framing: Framing::LargePanel(|| Box::new(DiagnosisPanel)),
};

/// The right column of the diagnosis.
#[derive(Default)]
pub struct DiagnosisPanel;

impl Panel for DiagnosisPanel {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        let Some(answer) = session.diagnosing.answer.clone() else { return };
        ScrollArea::vertical().id_salt("diagnosis").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            verdict(ui, &session.document, &session.calibration, &mut session.diagnosing, &mut session.jobs, &answer);
            next_experiment::settled(ui, &session.document, &answer.diagnosis);
            next_experiment::card(ui, session, &answer.diagnosis);
            extension(ui, session, &answer);
            for (k, cause) in answer.diagnosis.causes.iter().enumerate() {
                cause_card::cause(ui, k + 1, cause, &answer.diagnosis);
            }
            by_state(ui, &answer.diagnosis);
            false_alarms::card(
                ui,
                &session.document,
                &session.calibration,
                &session.diagnosing,
                &mut session.jobs,
                &answer.diagnosis,
            );
            validation::card(
                ui,
                &session.document,
                &session.calibration,
                &mut session.diagnosing,
                &mut session.jobs,
                &answer.diagnosis,
            );
            why_not::card(ui, &mut session.diagnosing, &answer.diagnosis);
            hidden(ui, &answer.diagnosis);
            warnings(ui, &answer.diagnosis);
        });
    }
}

fn verdict(
    ui: &mut Ui,
    document: &Document,
    calibration: &Calibration,
    diagnosing: &mut Diagnosing,
    jobs: &mut Jobs<Session>,
    answer: &Answer,
) {
    let d = &answer.diagnosis;
    let (mut again, mut changed) = (false, false);
    let busy = jobs.is_running(DIAGNOSE);
    card(
        ui,
        words::DIAGNOSIS,
        |ui| {
            if busy {
                ui.add(egui::Spinner::new().size(14.0));
            } else {
                again = ui.link(words::AGAIN).on_hover_text(words::DIAGNOSE_ONCE_MORE).clicked();
            }
        },
        |ui| {
            ui.add(egui::Label::new(theme::strong(headline(d))).wrap());
            ui.add_space(space::XS);
            changed = residuals::start_from(ui, document, calibration, diagnosing);
            let (inks, most) = (inks(ui), d.baseline.heldout_rms_n.max(d.noise_floor_n).max(1e-12));
            let unit = &compared_unit(d);
            level(ui, words::MODEL, d.baseline.heldout_rms_n, most, unit, inks.model);
            if !d.causes.is_empty() {
                level(ui, words::WITH_WHAT_WAS_FOUND, d.end.heldout_rms_n, most, unit, inks.extended);
            }
            level(ui, words::NOISE, d.noise_floor_n, most, unit, palette(ui).faint);
            ui.label(theme::caption(ui, words::FORCE_LEFT_OVER));
        },
    );
    if again || changed {
        let ctx = ui.ctx().clone();
        actions::diagnose(document, calibration, diagnosing, jobs, &ctx);
    }
}

/// Draws the residual RMS of every channel and state, beside the noise.
fn by_state(ui: &mut Ui, diagnosis: &Findings) {
    let all = &diagnosis.residuals;
    if all.len() < 2 {
        return;
    }
    let found = !diagnosis.causes.is_empty();
    let mut channels: Vec<&str> = all.iter().map(|left| left.channel.as_str()).collect();
    channels.dedup();
    plain_card(ui, words::LEFT_OVER_BY_STATE, |ui| {
        for (k, channel) in channels.into_iter().enumerate() {
            let own: Vec<&Residual> = all.iter().filter(|left| left.channel == channel).collect();
            let (unit, factor) = residual_unit(&own);
            if k == 0 {
                let heads = [words::MODEL, if found { words::FOUND } else { "" }, words::NOISE];
                figures(ui, RichText::new(""), heads.map(|head| theme::caption(ui, head)));
            }
            // A channel's name may be wider than the space beside the numbers.
            let name = theme::caption(ui, format!("{}, {unit}", format::capitalised(channel)));
            ui.add(egui::Label::new(name).wrap());
            for left in own {
                let shown = |rms: f64| RichText::new(format::significant(rms * factor, 3)).size(12.0);
                let after = if found { shown(left.rms_after) } else { RichText::new("") };
                let noise = left.noise_floor.map_or_else(|| RichText::new("–"), shown);
                figures(
                    ui,
                    RichText::new(crate::text::states::state_name(left.state)).size(12.0),
                    [shown(left.rms_before), after, noise],
                );
            }
        }
    });
}

/// Draws a name and three aligned numbers in one line.
fn figures(ui: &mut Ui, name: RichText, numbers: [RichText; 3]) {
    const NUMBER: f32 = 46.0;
    compact(ui, |ui| {
        ui.label(name);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            for number in numbers.into_iter().rev() {
                ui.allocate_ui_with_layout(vec2(NUMBER, 16.0), Layout::right_to_left(Align::Center), |ui| {
                    ui.set_min_width(NUMBER);
                    ui.label(number);
                });
            }
        });
    });
}

/// Draws a name, a bar and a number in one line.
fn level(ui: &mut Ui, label: &str, value: f64, most: f64, unit: &str, color: Color32) {
    compact(ui, |ui| {
        let column = |ui: &mut Ui, width: f32, layout: Layout, text: RichText| {
            ui.allocate_ui_with_layout(vec2(width, 16.0), layout, |ui| {
                ui.set_min_width(width);
                ui.label(text);
            });
        };
        column(ui, 122.0, Layout::left_to_right(Align::Center), theme::caption(ui, label));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let text = RichText::new(format!("{} {unit}", format::significant(value, 3))).size(12.0);
            column(ui, 76.0, Layout::right_to_left(Align::Center), text);
            bar(ui, value, most, None, color);
        });
    });
}

fn extension(ui: &mut Ui, session: &mut Session, answer: &Answer) {
    let plant = answer.diagnosis.causes.iter().any(cause_card::changes_the_world);
    if !plant {
        return;
    }
    let busy = session.jobs.is_running(EXTEND);
    let extended = session.diagnosing.worlds.is_some();
    plain_card(ui, words::EXTENDED_MODEL, |ui| {
        if let Some(problem) = session.diagnosing.worlds_problem.clone() {
            remark(ui, Icon::Doubt, problem);
        }
        if !extended {
            ui.label(theme::caption(ui, words::A_WORLD_WITH_THE_FOUND));
            ui.add_space(space::XS);
            ui.horizontal(|ui| {
                if primary_button(ui, !busy, (Icon::Extend, words::EXTEND_THE_MODEL)).clicked() {
                    let ctx = ui.ctx().clone();
                    actions::extend_model(
                        &session.document,
                        &session.calibration,
                        &session.diagnosing,
                        &mut session.jobs,
                        &ctx,
                    );
                }
                if busy {
                    ui.add(egui::Spinner::new().size(16.0));
                }
            });
            return;
        }
        before_after(ui, &answer.diagnosis);
        ui.add_space(space::XS);
        feel(ui, session);
    });
}

/// Draws the improvement by the whole extension.
fn before_after(ui: &mut Ui, d: &Findings) {
    let unit = compared_unit(d);
    let number = |value: f64| format::significant(value, 3);
    let (before, after) = (d.baseline.heldout_rms_n, d.end.heldout_rms_n);
    ui.horizontal(|ui| {
        let inks = inks(ui);
        ui.spacing_mut().item_spacing.x = space::S;
        ui.label(theme::title(format!("{} {unit}", number(before))).color(inks.model));
        Icon::Next.show(ui, icons::SIZE, palette(ui).secondary);
        ui.label(theme::title(format!("{} {unit}", number(after))).color(inks.extended));
    });
    let gone = 100.0 * (1.0 - (after / before.max(1e-12)).powi(2)).max(0.0);
    let text =
        format!("The world now has what was found: {}\u{a0}% of the left-over power is gone.", format::number(gone, 0));
    ui.label(theme::caption(ui, text));
}

fn feel(ui: &mut Ui, session: &mut Session) {
    let comparison = actions::comparison(&session.diagnosing);
    ui.horizontal(|ui| {
        if primary_button(ui, comparison.is_ok(), (Icon::Feel, words::FEEL_IT_IN_TRAIN))
            .on_hover_text(words::FEEL_IT_IN_TRAIN_MORE)
            .clicked()
        {
            actions::feel(
                &mut session.workspace,
                &session.diagnosing,
                &mut session.training.trainer,
                &mut session.messages,
            );
        }
        if ui.button((Icon::Save, words::SAVE_WORLD)).on_hover_text(words::SAVE_WORLD_MORE).clicked() {
            files::ask(ui.ctx(), &mut session.jobs, dialogs::SAVE_EXTENDED);
        }
    });
    if let Err(problem) = comparison {
        ui.label(theme::caption(ui, problem));
    }
}

/// Draws the causes that are not testable with the recording, each with the reason in a tooltip.
fn hidden(ui: &mut Ui, diagnosis: &Findings) {
    if diagnosis.not_excited.is_empty() {
        return;
    }
    let count = diagnosis.not_excited.len();
    card(
        ui,
        words::COULD_NOT_HAVE,
        |ui| drop(ui.label(theme::caption(ui, count.to_string()))),
        |ui| {
            ui.horizontal_wrapped(|ui| {
                ui.spacing_mut().item_spacing = vec2(space::XS, space::XS);
                for hidden in &diagnosis.not_excited {
                    cause_card::chip(ui, &title(&hidden.id), palette(ui).secondary)
                        .on_hover_text(sentence(&hidden.why));
                }
            });
            ui.label(theme::caption(ui, words::THEY_ARE_NOT));
        },
    );
}

fn warnings(ui: &mut Ui, diagnosis: &Findings) {
    if diagnosis.warnings.is_empty() {
        return;
    }
    plain_card(ui, words::WARNINGS, |ui| {
        for warning in &diagnosis.warnings {
            remark(ui, Icon::Doubt, sentence(warning));
        }
    });
}
