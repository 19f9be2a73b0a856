//! The devices page, right column: capabilities of the running device, its live values, and a gentle push to try it.

use crate::text::format::{number, short_time};
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::theme::{palette, space};
use crate::ui::kit::widgets::{empty_state, fact, light, plain_card, primary_button, segmented};
use crate::ui::session::Session;
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel::{Panel, Registration};
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::panels::trainer_timing;
use crate::ui::train::trainer::force_test::Direction;
use crate::ui::train::trainer::hand::{HandDevice, spec_sentences};
use crate::ui::train::trainer::live::{Operator, Trainer};
use egui::{RichText, ScrollArea, Slider, Ui, vec2};
use haptics::Vec2;
use haptics::device::DeviceSpec;
use haptics::servo::force_test::MOST_N;
use haptics::servo::{Snapshot, passivity};

/// Texts of this panel; a sentence with numbers is in the code that computes them.
mod words {
    pub const NO_DEVICE_IS_RUNNING: &str = "No device is running";
    pub const NO_DEVICE_IS_RUNNING_MORE: &str = "Choose one on the left.";
    pub const SCRIPT_MORE: &str = "Does the task of the world like a person.";
    pub const WHAT_IT_CAN_RENDER: &str = "What it can render";
    pub const FORCE_NOT_FELT: &str =
        "The force is shown and not felt: nothing can become unstable in the operator's hand, so no limit applies.";
    pub const B_HALF_A_PERIOD: &str = "b / (half a period + delay)";
    pub const TWO_B_A_PERIOD: &str = "2 b / period";
    pub const STEPS_OF_THE_POSITION: &str = "; steps of the position allow 2 × friction / step";
    pub const IT_RENDERS_THIS_WORLD: &str = "It renders this world directly.";
    pub const THE_DEVICE_STATES: &str =
        "The device states no damping of its own, so no wall and no damper is surely passive.";
    pub const STIFFEST_PASSIVE_WALL: &str = "Stiffest passive wall";
    pub const STRONGEST_PASSIVE_DAMPER: &str = "Strongest passive damper";
    pub const STRONGEST_PASSIVE_DAMPER_MORE: &str =
        "A virtual damper may take no more than the device's own damping b, nor more than friction × period / step.";
    pub const WAVE_VARIABLES_KEEP: &str = "Wave variables keep the line stable behind its delay, and make it \
        soft: it lies like a spring of b / delay one way between your fingers and everything you touch. b is the \
        impedance of the waves, not the device's own damping.";
    pub const STIFFEST_THAT_IS_FELT: &str = "Stiffest that is felt";
    pub const NOW: &str = "Now";
    pub const LEFT_FINGER: &str = "Left finger";
    pub const RIGHT_FINGER: &str = "Right finger";
    pub const POSITION: &str = "Position";
    pub const VELOCITY: &str = "Velocity";
    pub const FORCE_ON_YOU: &str = "Force on you";
    pub const AGE_OF_THE_NEWEST: &str = "Age of the newest sample";
    pub const SATURATED: &str = "Saturated";
    pub const SATURATED_MORE: &str = "A force was clamped to the maximum";
    pub const SLEW: &str = "Slew";
    pub const SLEW_MORE: &str = "A force was slowed down: it changed too fast";
    pub const STALE: &str = "Stale";
    pub const STALE_MORE: &str = "No fresh sample from the device: the force is zero";
    pub const INVALID: &str = "Invalid";
    pub const INVALID_MORE: &str = "An impossible value was refused";
    pub const FORCE_TEST: &str = "Force test";
    pub const THIS_DEVICE_GIVES: &str = "This device gives nobody a force, so there is none to try.";
    pub const OVER_A_SLOW: &str =
        "Over a slow line a push would not be the device's own: choose no delay in Train first.";
    pub const STOP: &str = "Stop";
    pub const HOLD_THE_DEVICE: &str = "Hold the device loosely. It pushes both fingers softly in one direction \
        for five seconds, in place of the world.";
    pub const PUSH: &str = "Push";
}

/// Minimum width for two columns, points: the live values need half of it.
const TWO_COLUMNS: f32 = 780.0;

/// The registration of this panel.
pub static REGISTRATION: Registration = Registration {
    workspaces: &[(Workspace::Devices, 1)],
    ..Registration::new(PanelId::DEVICE_DETAIL, "Device", Icon::Device, || Box::new(DeviceDetail))
};

/// Panel of the running device.
#[derive(Default)]
pub struct DeviceDetail;

impl Panel for DeviceDetail {
    fn ui(&mut self, ui: &mut Ui, session: &mut Session) {
        if let Err(problem) = session.training.trainer.ensure_running() {
            session.messages.fail(problem);
        }
        session.training.trainer.update(f64::from(ui.input(|i| i.stable_dt)));
        // Live values: the page repaints continuously while it is open.
        ui.ctx().request_repaint_after(std::time::Duration::from_millis(33));
        let Some(spec) = session.training.trainer.spec().cloned() else {
            empty_state(ui, (Icon::Device, words::NO_DEVICE_IS_RUNNING), words::NO_DEVICE_IS_RUNNING_MORE, |_| {});
            return;
        };
        if let Some(fault) = session.training.trainer.scene().and_then(|(snapshot, _)| snapshot.fault) {
            session.messages.fail(fault);
        }
        ScrollArea::vertical().id_salt("device detail").auto_shrink(false).show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = space::S;
            if ui.available_width() < TWO_COLUMNS {
                abilities(ui, &mut session.training.trainer, &mut session.messages, &spec);
                values(ui, &session.training.trainer);
                return;
            }
            let half = 0.5 * (ui.available_width() - space::M);
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = space::M;
                column(ui, half, |ui| abilities(ui, &mut session.training.trainer, &mut session.messages, &spec));
                column(ui, half, |ui| values(ui, &session.training.trainer));
            });
        });
    }
}

/// Draws the device's description, its capabilities, and the force test.
fn abilities(ui: &mut Ui, trainer: &mut Trainer, messages: &mut Messages, spec: &DeviceSpec) {
    about(ui, trainer, spec);
    limits(ui, trainer, spec);
    force_test(ui, trainer, spec);
    crate::ui::train::panels::passivity::passivity(ui, trainer, messages);
}

/// Draws the live values of the device and its timing.
fn values(ui: &mut Ui, trainer: &Trainer) {
    live(ui, trainer);
    crate::ui::devices::panels::device_log::answers(ui, trainer);
    trainer_timing::timing(ui, trainer);
}

fn column(ui: &mut Ui, width: f32, contents: impl FnOnce(&mut Ui)) {
    ui.allocate_ui_with_layout(vec2(width, 0.0), egui::Layout::top_down(egui::Align::Min), |ui| {
        ui.set_width(width);
        ui.spacing_mut().item_spacing.y = space::S;
        contents(ui);
    });
}

fn about(ui: &mut Ui, trainer: &Trainer, spec: &DeviceSpec) {
    plain_card(ui, &spec.name, |ui| {
        let what = match trainer.operator {
            Operator::You => trainer.hand.sentence(),
            Operator::Scripted => words::SCRIPT_MORE,
        };
        ui.label(theme::caption(ui, what));
        ui.add_space(space::XS);
        let waves = trainer.scene().is_some_and(|(snapshot, _)| snapshot.line_n_m.is_some());
        for (label, value) in spec_sentences(spec, waves) {
            fact(ui, label, value);
        }
    });
}

fn limits(ui: &mut Ui, trainer: &Trainer, spec: &DeviceSpec) {
    let Some((snapshot, _)) = trainer.scene() else { return };
    plain_card(ui, words::WHAT_IT_CAN_RENDER, |ui| {
        for (value, sentence) in limit_sentences(spec, snapshot) {
            if let Some((label, value)) = value {
                fact(ui, label, value);
            }
            ui.label(theme::caption(ui, sentence));
        }
    });
}

/// Label with its value, if there is one, and the sentence that explains it.
type Limit = (Option<(&'static str, String)>, String);

/// Limits at the actual rate, computed from the device's specification.
fn limit_sentences(spec: &DeviceSpec, snapshot: &Snapshot) -> Vec<Limit> {
    if !spec.force_feedback {
        let text = words::FORCE_NOT_FELT;
        return vec![(None, text.to_owned())];
    }
    let period_s = snapshot.timing.period_s;
    let hertz = number(snapshot.timing.rate.rate_hz, 0);
    let delay_s = snapshot.delay_s;
    let stiffness = passivity::passive_stiffness(spec, 0.0, period_s, delay_s);
    let formula = if delay_s > 0.0 { words::B_HALF_A_PERIOD } else { words::TWO_B_A_PERIOD };
    let behind = if delay_s > 0.0 { format!(" and behind {} of delay", short_time(delay_s)) } else { String::new() };
    let steps = if spec.resolution_m > 0.0 { words::STEPS_OF_THE_POSITION } else { "" };
    let damper = passivity::passive_damping(spec, period_s);
    if let Some(line_n_m) = snapshot.line_n_m {
        return line_sentences(line_n_m, snapshot);
    }
    let felt = snapshot
        .coupling
        .as_ref()
        .map_or_else(|| words::IT_RENDERS_THIS_WORLD.to_owned(), trainer_timing::coupling_sentence);
    if spec.damping_n_s_m <= 0.0 {
        let unknown = words::THE_DEVICE_STATES;
        return vec![(None, unknown.to_owned()), (None, felt)];
    }
    vec![
        (
            Some((words::STIFFEST_PASSIVE_WALL, format!("{} N/m", number(stiffness, 0)))),
            format!("At {hertz} Hz{behind} nothing can draw energy out of a softer wall: {formula}{steps}."),
        ),
        (
            Some((words::STRONGEST_PASSIVE_DAMPER, format!("{} N s/m", number(damper, 2)))),
            words::STRONGEST_PASSIVE_DAMPER_MORE.to_owned(),
        ),
        (None, felt),
    ]
}

/// Limits of a link with wave variables: b/d is in series with everything, however stiff the world at its end.
fn line_sentences(line_n_m: f64, snapshot: &Snapshot) -> Vec<Limit> {
    let text = words::WAVE_VARIABLES_KEEP;
    let mut said =
        vec![(Some((words::STIFFEST_THAT_IS_FELT, format!("{} N/m", number(line_n_m, 0)))), text.to_owned())];
    said.extend(snapshot.coupling.as_ref().map(|coupling| (None, trainer_timing::coupling_sentence(coupling))));
    said
}

fn live(ui: &mut Ui, trainer: &Trainer) {
    let p = palette(ui);
    let Some((snapshot, _)) = trainer.scene() else { return };
    let tick = snapshot.tick;
    plain_card(ui, words::NOW, |ui| {
        ui.spacing_mut().interact_size.y = 16.0;
        egui::Grid::new("live").num_columns(3).min_col_width(116.0).spacing(vec2(8.0, 4.0)).show(ui, |ui| {
            for text in ["", words::LEFT_FINGER, words::RIGHT_FINGER] {
                ui.label(theme::caption(ui, text));
            }
            ui.end_row();
            pair(ui, words::POSITION, tick.device_in_world.map(|v| v * 1e3), 1, "mm");
            pair(ui, words::VELOCITY, tick.input.tip_velocity.map(|v| v * 1e3), 0, "mm/s");
            pair(ui, words::FORCE_ON_YOU, tick.sent_force_n, 2, "N");
        });
        ui.add_space(space::XS);
        fact(ui, words::AGE_OF_THE_NEWEST, trainer_timing::sample_age(snapshot.timing.sample_age_s));
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = space::M;
            light(ui, tick.flags.saturated, p.danger, words::SATURATED, words::SATURATED_MORE);
            light(ui, tick.flags.slewing, p.caution, words::SLEW, words::SLEW_MORE);
            light(ui, tick.flags.stale, p.danger, words::STALE, words::STALE_MORE);
            light(ui, tick.flags.not_finite, p.danger, words::INVALID, words::INVALID_MORE);
        });
    });
}

fn pair(ui: &mut Ui, label: &str, values: [Vec2; 2], decimals: usize, unit: &str) {
    ui.label(theme::caption(ui, label));
    for value in values {
        let text = format!("{}, {} {unit}", number(value.x, decimals), number(value.y, decimals));
        ui.label(RichText::new(text).size(12.0));
    }
    ui.end_row();
}

fn force_test(ui: &mut Ui, trainer: &mut Trainer, spec: &DeviceSpec) {
    plain_card(ui, words::FORCE_TEST, |ui| {
        let somebody_feels = trainer.operator == Operator::You
            && matches!(trainer.hand, HandDevice::Haply(..) | HandDevice::Udp)
            && spec.force_feedback;
        if !somebody_feels {
            ui.label(theme::caption(ui, words::THIS_DEVICE_GIVES));
            return;
        }
        if !trainer.delay().is_none() {
            let text = words::OVER_A_SLOW;
            ui.label(theme::caption(ui, text));
            return;
        }
        if trainer.trial.is_running() {
            let left = number(trainer.trial.left_s(), 1);
            ui.label(theme::caption(ui, format!("It pushes; {left} s are left. Let go or press Esc when in doubt.")));
            if primary_button(ui, true, (Icon::Stop, words::STOP)).clicked()
                || ui.input(|i| i.key_pressed(egui::Key::Escape))
            {
                trainer.trial.abort();
            }
            return;
        }
        let text = words::HOLD_THE_DEVICE;
        ui.label(theme::caption(ui, text));
        segmented(ui, &mut trainer.trial.direction, &Direction::ALL);
        let most = MOST_N.min(spec.max_force_n);
        ui.add(Slider::new(&mut trainer.trial.newtons, 0.1..=most).suffix(" N").fixed_decimals(1));
        if primary_button(ui, true, words::PUSH).clicked() {
            trainer.trial.start();
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::servo::Swap;
    use haptics::servo::rate::RateReport;
    use haptics::world::presets;

    #[test]
    fn limits_are_computed_at_the_actual_rate() {
        let spec = DeviceSpec {
            name: "x".to_owned(),
            force_feedback: true,
            max_force_n: 3.0,
            damping_n_s_m: 0.5,
            coulomb_n: 0.0,
            resolution_m: 0.0,
        };
        let swap = Swap::new(presets::table());
        for (rate_hz, expected) in [(1000.0, "1000 N/m"), (4000.0, "4000 N/m")] {
            let snapshot = Snapshot::starting(&swap, RateReport { rate_hz, ..RateReport::default() });
            let limits = limit_sentences(&spec, &snapshot);
            let (_, value) = limits[0].0.clone().expect("a value");
            assert_eq!(value, expected);
        }
        let snapshot = Snapshot {
            line_n_m: Some(20.0),
            ..Snapshot::starting(&swap, RateReport { rate_hz: 1000.0, ..RateReport::default() })
        };
        let waved = limit_sentences(&spec, &snapshot);
        assert_eq!(waved[0].0, Some(("Stiffest that is felt", "20 N/m".to_owned())));
        assert!(waved.iter().all(|(_, text)| !text.contains("renders this world directly")));
        let shown = DeviceSpec { force_feedback: false, ..spec };
        let snapshot = Snapshot::starting(&swap, RateReport { rate_hz: 1000.0, ..RateReport::default() });
        assert!(limit_sentences(&shown, &snapshot)[0].1.contains("no limit applies"));
    }
}
