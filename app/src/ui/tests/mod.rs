//! The window without a window: sessions to draw, and what the tests share.

mod assistant;
mod carry;
mod check;
mod comfort;
pub mod diagnose;
mod ended;
mod experiment;
mod layouts;
mod legible;
mod lessons;
mod marking;
mod panels;
mod pictures;
mod plots;
mod progress;
mod rules;
mod scene;
mod shifting;
mod spoken;
mod texts;
mod thresholds;
mod train;
mod video;
mod window;
mod workbench;

use super::session::{self, Session};
use crate::ui::background::jobs::JobKind;
use crate::ui::document::prepared::Prepared;
use crate::ui::headless::screenshot;
use crate::ui::kit::theme;
use crate::ui::shell::app::App;
use crate::ui::shell::panel::Picture;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::trainer::live::{Clock, Operator, Trainer};
use crate::ui::train::trainer::world_choice::WorldChoice;
use egui_kittest::Harness;
use haptics::recording::{Channel, Recording};
use std::io::Write;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

/// The scripted operator's recording in a preset world.
fn performed(choice: WorldChoice) -> Recording {
    let mut trainer = Trainer::default();
    (trainer.clock, trainer.operator, trainer.choice) = (Clock::Manual, Operator::Scripted, choice);
    trainer.ensure_running().expect("a loop");
    let folder = tempfile::tempdir().expect("a temporary folder");
    trainer.recordings_folder = Some(folder.path().to_path_buf());
    trainer.start_recording().expect("begins");
    while !trainer.performance_over() {
        trainer.advance(1.0);
    }
    let finished = trainer.stop_recording().expect("it ran").wait().expect("written");
    estimator::log::load(&finished.path, None).expect("opens").remove(0)
}

/// A cart of 2 kg with friction, pushed to and fro.
pub fn cart() -> Recording {
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
pub fn clockless_path() -> Recording {
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
pub fn session(recording: Recording) -> Session {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session.workspace = Workspace::Calibrate;
    session.show(vec![Arc::new(Prepared::new(recording))]);
    match crate::ui::calibrate::refits::analyse(&session.document.recordings, &session.calibration.choice) {
        Ok(analysis) => {
            session.calibration.replays =
                crate::ui::calibrate::refits::replay_all(&analysis.world, &session.document.recordings);
            session.calibration.enough = crate::ui::calibrate::refits::judge(&analysis, &session.document.recordings);
            session.calibration.analysis = Some(Arc::new(analysis));
            session.calibration.refits.answered(&session.calibration.choice.clone());
        }
        Err(problem) => session.calibration.fit_problem = Some(problem),
    }
    session
}

pub static STACK: LazyLock<Recording> = LazyLock::new(|| performed(WorldChoice::Blocks));
pub static CRANK: LazyLock<Recording> = LazyLock::new(|| performed(WorldChoice::Crank));

pub fn empty() -> Session {
    let mut session = Session::new();
    session.training.trainer.clock = Clock::Manual;
    session
}

/// Train, with its files in a folder.
pub fn in_train(folder: &Path) -> Session {
    let mut session = empty();
    session.workspace = Workspace::Train;
    session.training.trainer.recordings_folder = Some(folder.to_path_buf());
    session.training.lessons.folder = Some(folder.join("lessons"));
    session
}

/// A picture by its name.
pub fn picture(name: &str) -> &'static Picture {
    screenshot::pictures().find(|picture| picture.name == name).expect("a picture of this name")
}

/// A window that shows a session in Train.
pub fn train_window(session: Session) -> Harness<'static, App> {
    harness(screenshot::app_for(session, picture("train")), [1280.0, 900.0], |ui, app: &mut App| app.show(ui))
}

pub fn harness<'a, S: 'a>(
    state: S,
    size: [f32; 2],
    mut show: impl FnMut(&mut egui::Ui, &mut S) + 'a,
) -> Harness<'a, S> {
    let builder = Harness::builder().with_size(size).with_max_steps(8).with_accessibility_check(false);
    let mut harness =
        builder.with_context_setup(theme::install).build_ui_state(move |ui, state| show(ui, state), state);
    harness.run_steps(3);
    harness
}

/// Frames pass until `over`; what never comes fails with a word.
pub fn until<S>(harness: &mut Harness<'_, S>, what: &str, over: impl Fn(&S) -> bool) {
    let begun = Instant::now();
    while !over(harness.state()) {
        assert!(begun.elapsed() < Duration::from_mins(2), "{what} never comes");
        // Jobs have threads of their own; nothing wakes a window that is not there.
        std::thread::sleep(Duration::from_millis(3));
        harness.run_steps(1);
    }
    harness.run_steps(3);
}

/// Until the window's jobs of a kind are over.
pub fn until_done(harness: &mut Harness<'_, App>, kind: JobKind) {
    until(harness, "the end of a job", |app| !app.session.jobs.is_running(kind));
}

/// Until the window has nothing more to do.
pub fn until_quiet(harness: &mut Harness<'_, App>) {
    until(harness, "the end of all jobs", |app| !app.session.jobs.is_busy());
}

/// True, with a visible word, where pictures cannot be drawn.
pub fn no_driver() -> bool {
    let missing = render::Headless::new().err();
    if let Some(error) = &missing {
        let _ = writeln!(std::io::stderr(), "skipped: {error}");
    }
    missing.is_some()
}

/// Writes a picture into the folder that `TOUCHSTONE_PICTURES` names, to be looked at; nothing without it.
pub fn keep(name: &str, picture: &image::RgbaImage) {
    if let Some(folder) = std::env::var_os("TOUCHSTONE_PICTURES") {
        let path = Path::new(&folder).join(format!("{name}.png"));
        picture.save_with_format(path, image::ImageFormat::Png).expect("the folder can be written to");
    }
}

pub fn count_near(picture: &image::RgbaImage, color: egui::Color32) -> usize {
    let [r, g, b, _] = color.to_array();
    let near = |a: u8, b: u8| a.abs_diff(b) <= 3;
    picture.pixels().filter(|p| near(p.0[0], r) && near(p.0[1], g) && near(p.0[2], b)).count()
}
