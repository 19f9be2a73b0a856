//! The whole window: keys, messages, from the trainer to the calibration.

use super::{STACK, empty, harness, session};
use crate::ui::app::App;
use crate::ui::session::Workspace;
use crate::ui::trainer::{Clock, Operator};
use egui_kittest::kittest::Queryable;
use std::time::{Duration, Instant};

#[test]
fn keys_play_scrub_and_switch() {
    let mut app = App::new(session(STACK.clone()));
    app.session.trainer.clock = Clock::Manual;
    let mut harness = harness(app, [1200.0, 800.0], |ui, app: &mut App| app.show(ui));
    harness.key_press(egui::Key::Space);
    harness.run_steps(3);
    assert!(harness.state().session.playing && harness.state().session.cursor_s > 0.0);
    harness.key_press(egui::Key::Space);
    harness.key_press(egui::Key::End);
    harness.run_steps(2);
    let (_, last) = harness.state().session.prepared().expect("shown").span();
    assert_eq!(harness.state().session.cursor_s, last);
    harness.key_press(egui::Key::ArrowLeft);
    harness.run_steps(1);
    assert!(harness.state().session.cursor_s < last);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Num1);
    harness.run_steps(2);
    assert_eq!(harness.state().session.workspace, Workspace::Train);
}

#[test]
fn a_recording_made_in_the_trainer_is_calibrated_from() {
    let mut app = App::new(empty());
    app.session.trainer.operator = Operator::Scripted;
    let mut harness = harness(app, [1200.0, 1000.0], |ui, app: &mut App| app.show(ui));
    harness.get_by_label("Record").click();
    harness.run_steps(2);
    assert!(harness.state().session.trainer.is_recording());
    while !harness.state().session.trainer.performance_over() {
        harness.state_mut().session.trainer.advance(1.0);
    }
    harness.run_steps(1);
    harness.get_by_label("Stop and calibrate").click();
    let begun = Instant::now();
    while harness.state().session.analysis.is_none() && begun.elapsed() < Duration::from_mins(1) {
        std::thread::sleep(Duration::from_millis(5));
        harness.run_steps(1);
    }
    let session = &harness.state().session;
    assert_eq!(session.workspace, Workspace::Calibrate);
    assert!(session.analysis.as_ref().is_some_and(|a| a.fit.value("block-2", "weight_N").is_some()));
}

#[test]
fn a_missing_file_is_a_banner_that_can_be_dismissed() {
    let mut harness = harness(App::new(empty()), [1200.0, 800.0], |ui, app: &mut App| app.show(ui));
    let ctx = harness.ctx.clone();
    harness.state_mut().session.open(&ctx, std::path::Path::new("/nowhere/none.csv"));
    let begun = Instant::now();
    while harness.state().session.banners.is_empty() && begun.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(5));
        harness.run_steps(1);
    }
    assert!(harness.state().session.banners[0].text.contains("none.csv"));
    harness.run_steps(2);
    harness.get_by_label("Dismiss").click();
    harness.run_steps(2);
    assert!(harness.state().session.banners.is_empty());
}
