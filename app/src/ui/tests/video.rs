//! The video of the hand beside a recording, used as a person does.

use super::{STACK, clockless_path, empty, harness, session, until};
use crate::ui::document::opening;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::video_actions;
use crate::ui::document::videos::State;
use crate::ui::session::Session;
use crate::ui::shell::app::App;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::video::tests::{bar, film, no_reader};
use egui::Role;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use std::path::Path;

/// Pictures a second.
const RATE_HZ: u32 = 25;

/// A film of the left fingertip: a bar that goes from side to side with it. It begins `before_s` before the recording.
fn film_of_the_hand(file: &Path, prepared: &Prepared, before_s: f64) {
    let [left, _] = prepared.tips.as_ref().expect("two fingers");
    let (first, last) = prepared.span();
    let count = ((last - first + before_s) * f64::from(RATE_HZ)) as usize;
    film(file, RATE_HZ, count, |k| {
        let t = first - before_s + k as f64 / f64::from(RATE_HZ);
        let sample = prepared.times.partition_point(|s| *s < t).min(prepared.times.len() - 1);
        let at = left.position[sample];
        bar(0.5 + 5.0 * at.x + 2.0 * (at.y + 0.1))
    });
}

fn window<'a>(session: Session) -> Harness<'a, App> {
    harness(App::new(session), [1280.0, 720.0], |ui, app: &mut App| app.show(ui))
}

fn press(harness: &mut Harness<'_, App>, role: Role, label: &str) {
    harness.get_by_role_and_label(role, label).click();
    harness.run_steps(3);
}

#[test]
fn a_dropped_video_is_shown_runs_with_the_cursor_and_finds_its_place() {
    if no_reader() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("from above.mp4");
    let session = session(STACK.clone());
    film_of_the_hand(&file, &session.document.recordings[0], 1.7);
    let mut harness = window(session);
    let ctx = harness.ctx.clone();
    opening::open_dropped(&mut harness.state_mut().session, &ctx, std::slice::from_ref(&file));
    harness.run_steps(2);
    assert!(harness.state_mut().dock.has(Workspace::Calibrate, PanelId::VIDEO), "its panel has come");
    until(&mut harness, "the first picture", |app| app.session.document.videos.shown() == Some(0));
    harness.state_mut().session.document.seek(4.0);
    until(&mut harness, "the picture at the cursor", |app| app.session.document.videos.shown() == Some(100));

    press(&mut harness, Role::Button, "Align video");
    until(&mut harness, "its place", |app| {
        video_actions::video_source(&app.session.document).is_some_and(|v| v.begins_at_s != 0.0)
    });
    let first = harness.state().session.document.recordings[0].span().0;
    let begins_at_s = video_actions::video_source(&harness.state().session.document).expect("a video").begins_at_s;
    assert!((begins_at_s - (first - 1.7)).abs() < 0.06, "it begins at {begins_at_s} s");
    until(&mut harness, "the picture that belongs to the cursor", |app| {
        app.session.document.videos.shown() == Some(142)
    });

    // It is kept with the project, and goes with another recording.
    let project = crate::ui::document::project_files::project_of(
        harness.state().session.workspace,
        &harness.state().session.document,
        &harness.state().session.calibration,
        &harness.state().session.plots,
    );
    assert_eq!(project.videos, harness.state().session.document.videos.sources);
    press(&mut harness, Role::Button, "Take the video away");
    assert!(video_actions::video_source(&harness.state().session.document).is_none());
    assert!(harness.query_by_label("Choose a video …").is_some());
}

#[test]
fn a_video_is_laid_over_its_recording_by_a_moment_that_one_recognises() {
    if no_reader() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.mkv");
    film(&file, RATE_HZ, 100, |k| bar(k as f64 / 100.0));
    let mut session = session(STACK.clone());
    video_actions::open_video(
        &mut session.document,
        &mut session.wanted_pane,
        &mut session.messages,
        &mut session.jobs,
        &file,
    );
    let mut harness = window(session);
    until(&mut harness, "the first picture", |app| app.session.document.videos.shown() == Some(0));
    press(&mut harness, Role::CheckBox, "By itself");
    harness.state_mut().session.document.videos.loose_s = Some(2.0);
    harness.state_mut().session.document.seek(9.5);
    until(&mut harness, "the picture that was looked for", |app| app.session.document.videos.shown() == Some(50));
    press(&mut harness, Role::Button, "They belong together");
    let session = &harness.state().session;
    assert!(session.document.videos.loose_s.is_none());
    assert!((video_actions::video_source(&session.document).expect("a video").begins_at_s - 7.5).abs() < 1e-9);
    assert_eq!(session.document.videos.shown(), Some(50), "the picture stays");
    // Before its beginning, the first picture stands there, with a word.
    harness.state_mut().session.document.seek(5.0);
    until(&mut harness, "the first picture", |app| app.session.document.videos.shown() == Some(0));
}

#[test]
fn a_video_that_stands_beside_its_log_is_found_with_its_sidecar() {
    if no_reader() {
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    let log = folder.path().join("run.csv");
    let mut recording = STACK.clone();
    estimator::log::write_csv(&recording, &log).expect("written");
    film(&folder.path().join("run.mp4"), RATE_HZ, 10, |_| bar(0.5));
    film(&folder.path().join("other.mp4"), RATE_HZ, 10, |_| bar(0.5));
    let opened = |log: &Path| {
        let mut harness = window(empty());
        let ctx = harness.ctx.clone();
        let session = &mut harness.state_mut().session;
        opening::open(&mut session.document, &mut session.jobs, &ctx, log);
        until(&mut harness, "the log", |app| !app.session.document.recordings.is_empty());
        video_actions::video_source(&harness.state().session.document).cloned().expect("a video")
    };
    let beside = opened(&log);
    assert_eq!((beside.file, beside.begins_at_s), (folder.path().join("run.mp4"), 0.0));
    recording.meta.video = Some(haptics::recording::VideoMeta { file: "other.mp4".into(), begins_at_s: -1.5 });
    estimator::log::write_meta(&recording, &log).expect("written");
    let named = opened(&log);
    assert_eq!((named.file, named.begins_at_s), (folder.path().join("other.mp4"), -1.5));
}

#[test]
fn what_is_in_the_way_of_a_video_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.mp4");
    std::fs::write(&file, b"\0\0\0\x20ftypisom\0\0\x02\0").expect("written");
    let ctx = egui::Context::default();
    let mut without = empty();
    opening::open_any(
        &mut without.document,
        &mut without.wanted_pane,
        &mut without.messages,
        &mut without.jobs,
        &ctx,
        &file,
    );
    assert!(without.messages.banners[0].text.contains("open the log first"), "{:?}", without.messages.banners);
    let mut clockless = session(clockless_path());
    opening::open_any(
        &mut clockless.document,
        &mut clockless.wanted_pane,
        &mut clockless.messages,
        &mut clockless.jobs,
        &ctx,
        &file,
    );
    assert!(clockless.messages.banners.iter().any(|b| b.text.contains("no clock")), "{:?}", clockless.messages.banners);
    if no_reader() {
        return;
    }
    let mut session = session(STACK.clone());
    opening::open_any(
        &mut session.document,
        &mut session.wanted_pane,
        &mut session.messages,
        &mut session.jobs,
        &ctx,
        &file,
    );
    let mut harness = window(session);
    until(&mut harness, "the refusal", |app| !app.session.jobs.is_busy());
    assert!(matches!({
            let session = &mut harness.state_mut().session;
            video_actions::video(&session.document, &mut session.jobs, &ctx)
        }, State::Failed(why) if why.contains("no video")));
    assert!(harness.query_by_label("Try again").is_some());
}
