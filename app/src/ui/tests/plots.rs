//! The plots of the log, used as a person does: transforms, what is left over, XY, recordings over each other.

use super::diagnose::{RIPPLED, diagnosed};
use super::{CRANK, STACK, cart, clockless_path, count_near, harness, keep, no_driver, session, until};
use crate::ui::calibrate::panels::log::LogPanel;
use crate::ui::calibrate::refits::{analyse, replay_all, replay_forces};
use crate::ui::diagnose::state::extend;
use crate::ui::document::overlays;
use crate::ui::document::overlays::ALIGN;
use crate::ui::document::prepared::Prepared;
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::plots::choices::{LogView, XyAxis, XyColor};
use crate::ui::session::Session;
use crate::ui::shell::dispatch;
use crate::ui::shell::panel::Panel as _;
use crate::ui::shell::workspace::Workspace;
use crate::ui::tests::picture;
use egui::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use estimator::signal::transform::Transform;
use haptics::recording::{Channel, Recording};
use std::sync::Arc;

/// The log panel alone, with the window's jobs.
pub fn log<'a>(session: Session) -> Harness<'a, Session> {
    let mut panel = LogPanel::default();
    harness(session, [1000.0, 640.0], move |ui, session: &mut Session| {
        let ctx = ui.ctx().clone();
        dispatch::poll(session, &ctx);
        panel.ui(ui, session);
    })
}

fn press(harness: &mut Harness<'_, Session>, role: Role, label: &str) {
    harness.get_by_role_and_label(role, label).click();
    harness.run_steps(4);
}

/// A turned crank in which a ripple is hidden, with the model without and with it.
fn extended() -> Session {
    let mut session = diagnosed(RIPPLED.clone());
    session.workspace = Workspace::Calibrate;
    let answer = session.diagnosing.answer.clone().expect("an answer");
    let from = session.diagnosing.from;
    let worlds = extend(&session.document.recordings, &session.calibration.choice, from, &answer).expect("extended");
    session.diagnosing.replays = replay_forces(&worlds.after, &session.document.recordings);
    session.diagnosing.worlds = Some(Arc::new(worlds));
    session
}

/// The same motion recorded again: later, and with another zero.
pub fn again(recording: &Recording, name: &str, later_s: f64, skip: usize) -> Recording {
    let mut other = recording.clone();
    other.name = name.to_owned();
    let times = other.time_s.as_mut().expect("a clock");
    times.drain(..skip);
    for time in times.iter_mut() {
        *time += later_s;
    }
    for channel in &mut other.channels {
        channel.values.drain(..skip);
        for value in channel.values.iter_mut().filter(|_| channel.unit == "N") {
            *value = 0.9 * *value + 0.05;
        }
    }
    other.labels = None;
    other
}

pub fn two(first: &Recording, second: Recording) -> Session {
    let mut session = Session::new();
    session.workspace = Workspace::Calibrate;
    session.show(vec![Arc::new(Prepared::new(first.clone())), Arc::new(Prepared::new(second))]);
    let analysis = analyse(&session.document.recordings, &session.calibration.choice).expect("fitted");
    session.calibration.replays = replay_all(&analysis.world, &session.document.recordings);
    session.calibration.analysis = Some(Arc::new(analysis));
    session
}

#[test]
fn a_transform_is_chosen_at_the_title_and_the_unit_follows() {
    let mut harness = log(session(cart()));
    press(&mut harness, Role::Button, "Position menu");
    press(&mut harness, Role::RadioButton, "Derivative");
    assert_eq!(harness.state().plots.groups["Position/mm"].transform, Transform::Derivative);
    assert_eq!(harness.state().plots.groups["Position/mm"].drawn, Transform::Derivative, "short: at once");
    assert!(harness.query_by_label("mm/s").is_some());
    // The value at the cursor is the speed that the motion was made with.
    harness.state_mut().document.seek(2.0);
    harness.run_steps(2);
    let speed = 1e3 * (0.13 * 2.6_f64.cos() + 0.124 * 6.2_f64.cos());
    let text = crate::text::format::number(speed, 1);
    assert!(harness.query_by_label(&text).is_some(), "{text} mm/s");
    press(&mut harness, Role::RadioButton, "Low-pass");
    let Transform::LowPass(cutoff_hz) = harness.state().plots.groups["Position/mm"].transform else {
        panic!("a low-pass")
    };
    assert_eq!(cutoff_hz, 10.0, "a fiftieth of 500 Hz");
    assert!(harness.query_by_label("< 10 Hz").is_some() && harness.query_by_label("mm").is_some());
}

#[test]
fn without_a_clock_a_derivative_is_per_sample() {
    let mut harness = log(session(clockless_path()));
    press(&mut harness, Role::Button, "Position menu");
    press(&mut harness, Role::RadioButton, "Derivative");
    assert!(harness.query_by_label("mm/sample").is_some());
}

#[test]
fn a_long_log_is_transformed_in_the_background_and_shown_when_it_is_there() {
    let n = 400_000;
    let values = (0..n).map(|i| 1e-3 * (f64::from(i) * 1e-3).sin()).collect();
    let channel = Channel { name: "q_m".to_owned(), unit: "m".to_owned(), values };
    let time_s = Some((0..n).map(|i| f64::from(i) * 1e-3).collect());
    let mut session = Session::new();
    session.show(vec![Arc::new(Prepared::new(Recording { time_s, channels: vec![channel], ..Recording::default() }))]);
    session.plots.groups.entry("Position/mm".to_owned()).or_default().transform = Transform::Derivative;
    let mut harness = log(session);
    // Until it is there the plot stays what it was, unit and all.
    until(&mut harness, "the derivative", |s| s.plots.groups["Position/mm"].drawn == Transform::Derivative);
    assert!(harness.query_by_label("mm/s").is_some());
    assert_eq!(harness.state().plots.derived.len(), 1);
    // Not wanted any more, it is let go.
    harness.state_mut().plots.groups.get_mut("Position/mm").expect("chosen").transform = Transform::None;
    harness.run_steps(3);
    assert!(harness.state().plots.derived.is_empty() && harness.query_by_label("mm/s").is_none());
}

#[test]
fn what_the_models_leave_has_a_plot_of_its_own() {
    let mut harness = log(extended());
    assert!(harness.query_by_label("Left over").is_none());
    assert!(harness.query_by_label("extended").is_some() && harness.query_by_label("noise ±2σ").is_some());
    press(&mut harness, Role::Button, "Force menu");
    press(&mut harness, Role::CheckBox, "Show what is left over");
    assert!(harness.query_by_label("Left over").is_some());
    for label in ["x − simulated", "x − extended", "y − extended"] {
        assert!(harness.query_by_label(label).is_some(), "{label}");
    }
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    press(&mut harness, Role::CheckBox, "extended");
    assert!(!harness.state().plots.groups["Force/N"].shows("layer: extended"));
    assert!(harness.query_by_label("x − extended").is_none(), "hidden in both plots");
    assert!(harness.query_by_label("x − simulated").is_some());
}

#[test]
fn positions_have_nothing_to_be_compared_with() {
    let mut harness = log(extended());
    press(&mut harness, Role::Button, "Angle menu");
    press(&mut harness, Role::CheckBox, "Show what is left over");
    assert!(harness.query_by_label("Left over").is_none());
}

#[test]
fn the_extended_curve_and_what_is_left_stand_in_the_picture() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let draw = |shown: bool| {
            let mut session = extended();
            let choice = session.plots.groups.entry("Force/N".to_owned()).or_default();
            choice.left_over = true;
            if !shown {
                choice.toggle("layer: extended");
            }
            session.document.seek(6.0);
            let picture = screenshot::draw(session, picture("log"), [1100, 760], dark).expect("drawn");
            keep(&format!("left-over-{shown}-{dark}"), &picture);
            picture
        };
        let (with, without) = (draw(true), draw(false));
        // Both plots of the force; not the column left of them.
        let differing = |top: u32, height: u32| {
            let part = |picture| image::imageops::crop_imm(picture, 265, top, 810, height).to_image();
            part(&with).pixels().zip(part(&without).pixels()).filter(|(a, b)| a != b).count()
        };
        assert!(differing(275, 200) > 200 && differing(485, 125) > 1_000, "dark {dark}");
        assert_eq!(differing(70, 195), 0, "the angles stay as they were, dark {dark}");
    }
}

#[test]
fn one_signal_is_drawn_against_another_and_a_click_moves_the_cursor() {
    let mut harness = log(session(cart()));
    press(&mut harness, Role::RadioButton, "XY");
    assert_eq!(harness.state().plots.view, LogView::Xy);
    let chosen = harness.state().plots.xy.clone();
    let name = |axis: &Option<XyAxis>| axis.as_ref().map(|a| a.name.clone()).unwrap_or_default();
    assert_eq!((name(&chosen.x), name(&chosen.y)), ("q_m".to_owned(), "f_N".to_owned()));
    // To the far right of the plot lies the largest position.
    let before = harness.state().document.cursor_s;
    harness.drag_at(egui::pos2(980.0, 300.0));
    harness.run_steps(1);
    harness.drop_at(egui::pos2(980.0, 300.0));
    harness.run_steps(2);
    let at = harness.state().document.cursor_s;
    let recording = cart();
    let (q, times) = (recording.channel("q_m").expect("q"), recording.time_s.as_ref().expect("a clock"));
    let largest = q.iter().copied().fold(f64::MIN, f64::max);
    let here = q[times.partition_point(|t| *t <= at).saturating_sub(1)];
    assert!(at != before && here > 0.8 * largest, "{at} s: {here} of {largest}");
    // A phase portrait.
    let signal = XyAxis { group: "Position/mm".to_owned(), name: "q_m".to_owned(), transform: Transform::Derivative };
    harness.state_mut().plots.xy.y = Some(signal);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("mm/s at the cursor").is_some());
    press(&mut harness, Role::RadioButton, "By time");
    assert_eq!(harness.state().plots.xy.color, XyColor::Time);
}

#[test]
fn xy_pictures_have_the_states_colours_or_those_of_time() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let draw = |color: XyColor| {
            let mut session = session(STACK.clone());
            session.plots.view = LogView::Xy;
            session.plots.xy.color = color;
            session.document.seek(6.0);
            let picture = screenshot::draw(session, picture("log"), [1000, 640], dark).expect("drawn");
            keep(&format!("xy-{color:?}-{dark}"), &picture);
            // Without the band below.
            image::imageops::crop_imm(&picture, 260, 50, 730, 440).to_image()
        };
        let air = theme::state_color(dark, estimator::segment::SystemState::HoldAboveGround);
        let (by_state, by_time) = (draw(XyColor::State), draw(XyColor::Time));
        let (states, times) = (count_near(&by_state, air), count_near(&by_time, air));
        assert!(states > times + 60, "dark {dark}: {states} and {times} pixels");
        let late = theme::time_color(dark, 1.0);
        assert!(count_near(&by_time, late) > count_near(&by_state, late), "dark {dark}");
    }
}

#[test]
fn another_recording_is_laid_over_and_aligned() {
    let (later_s, skip) = (3.0, 700);
    let other = again(&STACK, "stack again", later_s, skip);
    let mut harness = log(two(&STACK, other));
    press(&mut harness, Role::Button, "Overlay");
    press(&mut harness, Role::CheckBox, "stack again");
    assert_eq!(harness.state().plots.overlaid.len(), 1);
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label("stack again").is_some(), "in the legend");
    press(&mut harness, Role::Button, "Align");
    until(&mut harness, "the place", |s| !s.jobs.is_running(ALIGN));
    let offset_s = harness.state().plots.overlaid[0].offset_s;
    assert!((offset_s + later_s).abs() < 2e-3, "{offset_s} s");
    harness.state_mut().plots.overlaid[0].offset_s = 0.0;
    harness.run_steps(1);
    press(&mut harness, Role::Button, "First contact");
    let offset_s = harness.state().plots.overlaid[0].offset_s;
    assert!((offset_s + later_s).abs() < 0.05, "{offset_s} s by the first contact");
    press(&mut harness, Role::Button, "Take it away");
    assert!(harness.state().plots.overlaid.is_empty());
}

#[test]
fn an_overlay_is_shifted_by_dragging_its_number() {
    let other = again(&CRANK, "crank again", 0.0, 100);
    let mut session = two(&CRANK, other);
    overlays::toggle_overlay(&mut session.plots, 1);
    let mut harness = log(session);
    let number = harness.get_by_role(Role::SpinButton).rect().center();
    harness.drag_at(number);
    harness.run_steps(1);
    harness.hover_at(number + egui::vec2(60.0, 0.0));
    harness.run_steps(1);
    harness.drop_at(number + egui::vec2(60.0, 0.0));
    harness.run_steps(2);
    assert!(harness.state().plots.overlaid[0].offset_s > 0.1, "{:?}", harness.state().plots.overlaid);
}

#[test]
fn recordings_that_lie_over_each_other_have_their_own_colours() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let draw = |overlay: bool| {
            let mut session = two(&CRANK, again(&CRANK, "crank, second try", 0.0, 300));
            if overlay {
                overlays::toggle_overlay(&mut session.plots, 1);
                overlays::shift_overlay(&mut session.plots, 1, 0.4);
            }
            let picture = screenshot::draw(session, picture("log"), [1100, 720], dark).expect("drawn");
            keep(&format!("overlay-{overlay}-{dark}"), &picture);
            picture
        };
        let color = theme::recording(dark, 0);
        let (with, without) = (count_near(&draw(true), color), count_near(&draw(false), color));
        assert!(with > without + 60, "dark {dark}: {with} and {without} pixels");
    }
}

#[test]
fn nothing_of_the_log_is_cut_where_there_is_little_room() {
    let make = || {
        let mut session = two(&STACK, again(&STACK, "stack, the second of a long series", 0.5, 300));
        overlays::toggle_overlay(&mut session.plots, 1);
        session.plots.groups.entry("Force/N".to_owned()).or_default().left_over = true;
        session
    };
    for width in [480.0, 640.0, 1_000.0] {
        let mut harness = log(make());
        harness.set_size(egui::vec2(width, 520.0));
        harness.run_steps(4);
        for label in ["Position", "Task signals", "Overlay", "Align", "First contact", "Take it away", "Position menu"]
        {
            let rect = harness.get_by_role_and_label(Role::Button, label).rect();
            assert!(rect.left() >= 0.0 && rect.right() <= width, "{label} at {width}: {rect:?}");
        }
    }
    if !no_driver() {
        let picture = screenshot::draw(make(), picture("log"), [640, 520], false).expect("drawn");
        keep("little-room", &picture);
    }
}
