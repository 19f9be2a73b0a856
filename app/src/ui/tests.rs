//! The window without a window: every panel on an empty session, on blocks, on a crank, on a mechanism; what is shown and
//! what buttons do.

use super::app::App;
use super::jobs::JobKind;
use super::panels::Panel;
use super::panels::log::LogPanel;
use super::panels::parameters::ParametersPanel;
use super::panels::recording::RecordingPanel;
use super::panels::results::ResultsPanel;
use super::panels::scene::ScenePanel;
use super::panels::segments::SegmentsPanel;
use super::panels::trainer_side::TrainerSide;
use super::panels::trainer_view::TrainerView;
use super::prepare::Prepared;
use super::screenshot;
use super::session::{self, Session, Workspace};
use super::theme;
use super::trainer::{Clock, Operator, Trainer, WorldChoice};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use estimator::segment::SystemState;
use haptics::recording::{Channel, Recording};
use std::io::Write;
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

/// The scripted operator's recording in a preset world.
fn performed(choice: WorldChoice) -> Recording {
    let mut trainer = Trainer::default();
    (trainer.clock, trainer.operator, trainer.choice) = (Clock::Manual, Operator::Scripted, choice);
    trainer.ensure_running().expect("a loop");
    trainer.start_recording();
    while !trainer.performance_over() {
        trainer.advance(1.0);
    }
    trainer.stop_recording().expect("a recording")
}

/// A cart of 2 kg with friction, pushed to and fro.
fn cart() -> Recording {
    let time: Vec<f64> = (0..6_000).map(|i| f64::from(i) * 2e-3).collect();
    let q = |t: f64| 0.1 * (1.3 * t).sin() + 0.04 * (3.1 * t).sin();
    let v = |t: f64| 0.13 * (1.3 * t).cos() + 0.124 * (3.1 * t).cos();
    let a = |t: f64| -0.169 * (1.3 * t).sin() - 0.3844 * (3.1 * t).sin();
    let channel = |name: &str, unit: &str, values: Vec<f64>| Channel { name: name.into(), unit: unit.into(), values };
    let force = time.iter().map(|t| 2.0 * a(*t) + 5.0 * v(*t) + 0.8 * v(*t).signum()).collect();
    Recording {
        name: "cart".to_owned(),
        channels: vec![channel("q_m", "m", time.iter().map(|t| q(*t)).collect()), channel("f_N", "N", force)],
        time_s: Some(time),
        ..Recording::default()
    }
}

/// One second of a tool without a clock.
fn clockless_path() -> Recording {
    let turn = |i: i32| f64::from(i) * 0.01;
    let channel = |name: &str, values: Vec<f64>| Channel { name: name.into(), unit: "m".into(), values };
    Recording {
        name: "path".to_owned(),
        channels: vec![
            channel("x_m", (0..300).map(|i| 0.4 * turn(i).cos()).collect()),
            channel("y_m", (0..300).map(|i| 0.4 * turn(i).sin()).collect()),
        ],
        ..Recording::default()
    }
}

/// A session with a recording, fitted and replayed as far as that goes.
fn session(recording: Recording) -> Session {
    let mut session = Session::new();
    session.trainer.clock = Clock::Manual;
    session.workspace = Workspace::Calibrate;
    session.show(vec![Arc::new(Prepared::new(recording))]);
    match session::analyse(&session.recordings, session.choice) {
        Ok(analysis) => {
            session.replays = session::replay_all(&analysis.world, &session.recordings);
            session.analysis = Some(Arc::new(analysis));
        }
        Err(problem) => session.fit_problem = Some(problem),
    }
    session
}

static STACK: LazyLock<Recording> = LazyLock::new(|| performed(WorldChoice::Blocks));
static CRANK: LazyLock<Recording> = LazyLock::new(|| performed(WorldChoice::Crank));

fn empty() -> Session {
    let mut session = Session::new();
    session.trainer.clock = Clock::Manual;
    session
}

fn panels() -> Vec<Box<dyn Panel>> {
    vec![
        Box::new(LogPanel::default()),
        Box::new(SegmentsPanel),
        Box::new(ParametersPanel),
        Box::new(ResultsPanel::default()),
        Box::new(ScenePanel::default()),
        Box::new(RecordingPanel::default()),
        Box::new(TrainerView::default()),
        Box::new(TrainerSide),
    ]
}

fn harness<'a, S: 'a>(state: S, size: [f32; 2], mut show: impl FnMut(&mut egui::Ui, &mut S) + 'a) -> Harness<'a, S> {
    let builder = Harness::builder().with_size(size).with_max_steps(8).with_accessibility_check(false);
    let mut harness =
        builder.with_context_setup(theme::install).build_ui_state(move |ui, state| show(ui, state), state);
    harness.run_steps(3);
    harness
}

#[test]
fn every_panel_draws_every_kind_of_session() {
    let sessions: [fn() -> Session; 5] =
        [empty, || session(STACK.clone()), || session(CRANK.clone()), || session(cart()), || session(clockless_path())];
    for make in sessions {
        for mut panel in panels() {
            let title = panel.title();
            let mut harness = harness(make(), [420.0, 700.0], move |ui, session: &mut Session| panel.ui(ui, session));
            // Tiny windows too.
            harness.set_size(egui::vec2(60.0, 40.0));
            harness.run_steps(2);
            assert!(harness.state().banners.is_empty(), "{title}: {:?}", harness.state().banners);
        }
    }
}

#[test]
fn the_table_shows_the_values_and_greys_what_is_unknown() {
    let session = session(STACK.clone());
    let fit = session.analysis.as_ref().expect("fitted").fit.clone();
    let harness = harness(session, [420.0, 800.0], |ui, session| ParametersPanel.ui(ui, session));
    let weight = fit.parameter("block-1", "weight_N").expect("carried");
    let (value, error) = super::format::with_error(weight.value.expect("a value"), weight.std_error);
    assert!(harness.query_all_by_label(&value).next().is_some(), "{value}");
    assert!(harness.query_all_by_label(&error.expect("an error")).next().is_some());
    let unknown = fit.parameters.iter().filter(|p| !p.identified).count();
    assert_eq!(harness.query_all_by_label("not shown").count(), unknown);
}

#[test]
fn refit_starts_a_job_and_brings_a_fit() {
    let mut session = session(STACK.clone());
    session.analysis = None;
    let mut harness = harness(session, [300.0, 800.0], |ui, session| {
        let ctx = ui.ctx().clone();
        session.poll(&ctx);
        RecordingPanel::default().ui(ui, session);
    });
    harness.get_by_role_and_label(egui::Role::Button, "Fit").click();
    harness.run_steps(1);
    let begun = Instant::now();
    assert!(harness.state().jobs.is_running(JobKind::Fit) || harness.state().analysis.is_some());
    while harness.state().analysis.is_none() && begun.elapsed() < Duration::from_mins(1) {
        std::thread::sleep(Duration::from_millis(5));
        harness.run_steps(1);
    }
    assert!(harness.state().analysis.is_some());
}

#[test]
fn the_replay_lifts_the_block_as_it_was_lifted() {
    let session = session(STACK.clone());
    let segmentation = session.segmentation().expect("segmented");
    let carry = segmentation.states.iter().find(|i| i.state == SystemState::HoldAboveGround).expect("carried");
    let film = session.replay().and_then(|r| r.film.clone()).expect("played");
    let height = |t: f64| film.body_at(0, t).expect("block 1").y;
    assert!(height(0.5 * (carry.t0 + carry.t1)) - height(0.0) > 0.005);
    assert!(!session.replay().expect("played").curves.is_empty(), "simulated forces");
}

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

/// True, with a visible word, where pictures cannot be drawn.
fn no_driver() -> bool {
    let missing = render::Headless::new().err();
    if let Some(error) = &missing {
        let _ = writeln!(std::io::stderr(), "skipped: {error}");
    }
    missing.is_some()
}

fn count_near(picture: &image::RgbaImage, color: egui::Color32) -> usize {
    let [r, g, b, _] = color.to_array();
    let near = |a: u8, b: u8| a.abs_diff(b) <= 3;
    picture.pixels().filter(|p| near(p.0[0], r) && near(p.0[1], g) && near(p.0[2], b)).count()
}

#[test]
fn the_picture_of_the_log_has_a_band_in_the_states_colours() {
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let picture =
            screenshot::draw(session(STACK.clone()), screenshot::Panel::Log, [900, 560], dark).expect("drawn");
        for state in [SystemState::FreeMotion, SystemState::HoldOnGround, SystemState::HoldAboveGround] {
            let found = count_near(&picture, theme::state_color(dark, state));
            assert!(found > 500, "{state:?}, dark {dark}: {found} pixels");
        }
    }
}

#[test]
fn doubtful_spans_are_shaded_and_listed() {
    let mut recording = cart();
    let spans = [(1_000, 1_200), (4_000, 4_001)].map(|(first, end)| haptics::recording::Span { first, end });
    recording.warnings.push(haptics::recording::Warning {
        kind: "stuck-channel".to_owned(),
        column: Some("f_N".to_owned()),
        spans: spans.to_vec(),
        text: "f_N is stuck".to_owned(),
    });
    let mut harness =
        harness(session(recording.clone()), [420.0, 900.0], |ui, session| ResultsPanel::default().ui(ui, session));
    harness.get_by_label("Go to 2.00 s (1 of 2)").click();
    harness.run_steps(3);
    let (from, to) = harness.state().view_s;
    assert!(harness.state().cursor_s == 2.0 && from < 2.0 && to > 2.4 && to - from < 3.0);
    harness.get_by_label("Go to 8.00 s (2 of 2)").click();
    harness.run_steps(3);
    assert_eq!(harness.state().cursor_s, 8.0);
    if no_driver() {
        return;
    }
    for dark in [false, true] {
        let marks = |recording: &Recording| {
            let picture = screenshot::draw(session(recording.clone()), screenshot::Panel::Log, [900, 560], dark);
            count_near(&picture.expect("drawn"), theme::Palette::of(dark).caution)
        };
        let (with, without) = (marks(&recording), marks(&cart()));
        assert!(with > without + 30, "{with} and {without} pixels, dark {dark}");
    }
}

#[test]
fn the_scene_stands_in_the_picture_of_the_workbench() {
    if no_driver() {
        return;
    }
    let with = screenshot::draw(session(STACK.clone()), screenshot::Panel::Scene, [600, 400], true).expect("drawn");
    let block = theme::role(true, render::ColorRole::Block(0));
    let [r, g, b, _] = block.to_array().map(i32::from);
    let like_the_block = |p: &&image::Rgba<u8>| {
        let [pr, pg, pb, _] = p.0.map(i32::from);
        (pr - r).abs() + (pg - g).abs() + (pb - b).abs() < 60
    };
    let found = with.pixels().filter(like_the_block).count();
    assert!(found > 300, "{found} pixels of block 1");
}

#[test]
fn a_whole_workspace_is_drawn_without_anything() {
    if no_driver() {
        return;
    }
    for panel in [screenshot::Panel::Workbench, screenshot::Panel::Train] {
        let picture = screenshot::draw(empty(), panel, [1000, 700], false).expect("drawn");
        assert_eq!(picture.dimensions(), (1000, 700));
    }
}

#[test]
fn a_million_samples_stay_fast() {
    let n = 1_000_000;
    let wave = |k: usize| (0..n).map(|i| (f64::from(i) * 1e-4 * k as f64).sin()).collect();
    let channel = |k: usize| Channel { name: format!("s{k}_V"), unit: "V".to_owned(), values: wave(k) };
    let recording = Recording {
        channels: (1..=6)
            .map(channel)
            .chain([Channel { name: "q_m".into(), unit: "m".into(), values: wave(7) }])
            .collect(),
        time_s: Some((0..n).map(|i| f64::from(i) * 1e-3).collect()),
        ..Recording::default()
    };
    let mut session = Session::new();
    session.show(vec![Arc::new(Prepared::new(recording))]);
    let mut panel = LogPanel::default();
    let mut harness = harness(session, [1400.0, 800.0], move |ui, session: &mut Session| panel.ui(ui, session));
    let begun = Instant::now();
    for i in 0..20 {
        harness.state_mut().cursor_s = f64::from(i);
        harness.step();
    }
    let moving_cursor = begun.elapsed() / 20;
    let begun = Instant::now();
    for i in 0..20 {
        harness.state_mut().view_s = (0.0, 1_000.0 - f64::from(i));
        harness.step();
    }
    let moving_view = begun.elapsed() / 20;
    println!("cursor {moving_cursor:?}, view {moving_view:?} a picture");
    // Unoptimised; a picture has 16 ms, these are limits against a relapse to drawing every sample.
    assert!(moving_cursor < Duration::from_millis(150), "{moving_cursor:?}");
    assert!(moving_view < Duration::from_millis(300), "{moving_view:?}");
}
