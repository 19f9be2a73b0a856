//! The whole window: keys, messages, from the trainer to the calibration.

use super::{STACK, empty, harness, session, until, until_quiet};
use crate::recorder::folder;
use crate::ui::document::opening;
use crate::ui::shell::app::App;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::recorder;
use crate::ui::train::trainer::live::{Clock, Operator};
use egui_kittest::kittest::Queryable;
use haptics::recording::Meta;

#[test]
fn keys_play_scrub_and_switch() {
    let mut app = App::new(session(STACK.clone()));
    app.session.training.trainer.clock = Clock::Manual;
    let mut harness = harness(app, [1200.0, 800.0], |ui, app: &mut App| app.show(ui));
    harness.key_press(egui::Key::Space);
    harness.run_steps(3);
    assert!(harness.state().session.document.playing && harness.state().session.document.cursor_s > 0.0);
    harness.key_press(egui::Key::Space);
    harness.key_press(egui::Key::End);
    harness.run_steps(2);
    let (_, last) = harness.state().session.document.prepared().expect("shown").span();
    assert_eq!(harness.state().session.document.cursor_s, last);
    harness.key_press(egui::Key::ArrowLeft);
    harness.run_steps(1);
    assert!(harness.state().session.document.cursor_s < last);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::Num1);
    harness.run_steps(2);
    assert_eq!(harness.state().session.workspace, Workspace::Train);
}

#[test]
fn a_recording_made_in_the_trainer_is_calibrated_from() {
    let mut app = App::new(empty());
    app.session.training.trainer.operator = Operator::Scripted;
    let folder = tempfile::tempdir().expect("a temporary folder");
    app.session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    let mut harness = harness(app, [1200.0, 1000.0], |ui, app: &mut App| app.show(ui));
    harness.get_by_label("Record").click();
    harness.run_steps(2);
    assert!(harness.state().session.training.trainer.is_recording());
    while !harness.state().session.training.trainer.performance_over() {
        harness.state_mut().session.training.trainer.advance(1.0);
    }
    harness.run_steps(1);
    harness.get_by_label("Stop and calibrate").click();
    until(&mut harness, "the fit", |app| app.session.calibration.analysis.is_some());
    let session = &harness.state().session;
    assert_eq!(session.workspace, Workspace::Calibrate);
    assert!(session.calibration.analysis.as_ref().is_some_and(|a| a.fit.value("block-2", "weight_N").is_some()));
    let path = session.document.path.as_ref().expect("it is a file");
    assert!(path.starts_with(folder.path()) && path.is_file(), "{}", path.display());
}

#[test]
fn a_recording_that_a_killed_program_left_behind_is_offered_and_opened() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (path, marker) = folder::reserve(folder.path(), "cart").expect("reserves");
    let columns = ["q_m", "f_N"].map(str::to_owned);
    let mut stream = estimator::log::McapStream::create(&path, &columns, &Meta::default(), &[]).expect("creates");
    for i in 0..2_000 {
        let t = 2e-3 * f64::from(i);
        stream.push(t, &[0.1 * (1.3 * t).sin(), (3.1 * t).cos()]).expect("pushes");
    }
    stream.flush().expect("flushes");
    let without_end = std::fs::read(&path).expect("reads");
    stream.finish().expect("ends");
    drop(marker);
    let mut app = App::new(empty());
    app.session.training.trainer.recordings_folder = Some(folder.path().to_path_buf());
    let mut harness = harness(app, [1200.0, 800.0], |ui, app: &mut App| app.show(ui));
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    recorder::look_for_unfinished(&ctx, &session.training.trainer, &mut session.jobs);
    until_quiet(&mut harness);
    assert!(harness.query_by_label("Dismiss").is_none(), "it has its end");
    let (cut, marker) = folder::reserve(folder.path(), "cart").expect("reserves");
    std::fs::write(&cut, &without_end).expect("writes");
    drop(marker);
    let session = &mut harness.state_mut().session;
    recorder::look_for_unfinished(&ctx, &session.training.trainer, &mut session.jobs);
    until_quiet(&mut harness);
    assert_eq!(harness.state().session.document.unfinished, std::slice::from_ref(&cut));
    harness.get_by_label("Open").click();
    harness.run_steps(2);
    until_quiet(&mut harness);
    assert!(
        harness.state().session.document.unfinished.is_empty() && folder::unfinished(folder.path()).is_empty(),
        "said once"
    );
    let session = &harness.state().session;
    assert_eq!(session.document.path.as_ref(), Some(&cut), "{:?}", session.messages.banners);
    assert_eq!(session.document.prepared().map(|p| p.recording.len()), Some(2_000));
}

#[test]
fn a_missing_file_is_a_banner_that_can_be_dismissed() {
    let mut harness = harness(App::new(empty()), [1200.0, 800.0], |ui, app: &mut App| app.show(ui));
    let ctx = harness.ctx.clone();
    let session = &mut harness.state_mut().session;
    opening::open(&mut session.document, &mut session.jobs, &ctx, std::path::Path::new("/nowhere/none.csv"));
    until(&mut harness, "the message", |app| !app.session.messages.banners.is_empty());
    assert!(harness.state().session.messages.banners[0].text.contains("none.csv"));
    harness.run_steps(2);
    harness.get_by_label("Dismiss").click();
    harness.run_steps(2);
    assert!(harness.state().session.messages.banners.is_empty());
}
