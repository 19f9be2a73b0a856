//! The file dialogs of the window: the files on offer, and the use of the chosen path.

use crate::ui::background::jobs::Jobs;
use crate::ui::diagnose::checked::On;
use crate::ui::diagnose::experiment;
use crate::ui::diagnose::validation;
use crate::ui::document::files;
use crate::ui::document::files::{Dialog, LOGS_AND_ALL};
use crate::ui::document::opening;
use crate::ui::document::project_files;
use crate::ui::document::video_actions;
use crate::ui::session::{Session, change};
use crate::ui::train::trainees;

/// A log to calibrate from.
pub const OPEN_LOG: Dialog = Dialog {
    title: "Open a log",
    filters: LOGS_AND_ALL,
    saves_as: None,
    then: |session, ctx, path| {
        opening::open_any(
            &mut session.document,
            &mut session.wanted_pane,
            &mut session.messages,
            &mut session.jobs,
            ctx,
            &path,
        );
    },
};
/// A world to train in.
pub const OPEN_WORLD: Dialog = Dialog {
    title: "Open a world",
    filters: &[("Worlds", &["json"])],
    saves_as: None,
    then: |session, ctx, path| opening::open_world(&mut session.jobs, ctx, &path),
};
/// A project.
pub const OPEN_PROJECT: Dialog = Dialog {
    title: "Open a project",
    filters: &[("Projects", &["touchstone.json", "json"])],
    saves_as: None,
    then: |session, ctx, path| {
        project_files::open_project(&mut session.document, &mut session.messages, &mut session.jobs, ctx, &path);
    },
};
/// Another recording of the same object.
pub const ADD_LOG: Dialog = Dialog {
    title: "Add a recording of the same object",
    filters: LOGS_AND_ALL,
    saves_as: None,
    then: |session, ctx, path| project_files::add_log(session, ctx, &path),
};
/// A recording of the experiment that a diagnosis asks for.
pub const ADD_EXPERIMENT: Dialog = Dialog {
    title: "Add a recording of the experiment",
    filters: LOGS_AND_ALL,
    saves_as: None,
    then: |session, ctx, path| experiment::add_experiment(session, ctx, &path),
};
/// A video of the shown recording.
pub const OPEN_VIDEO: Dialog = Dialog {
    title: "Open a video of the hand",
    filters: &[("Videos", &["mp4", "mov", "mkv", "webm", "avi", "m4v", "mpg", "ts", "gif"]), ("All files", &["*"])],
    saves_as: None,
    then: |session, _, path| {
        video_actions::open_video(
            &mut session.document,
            &mut session.wanted_pane,
            &mut session.messages,
            &mut session.jobs,
            &path,
        );
    },
};
/// The place of the report.
pub const SAVE_REPORT: Dialog = Dialog {
    title: "Write a report",
    filters: &[],
    saves_as: Some("report.html"),
    then: |session, ctx, path| {
        files::save_report(ctx, &session.document, &session.calibration, &mut session.jobs, path);
    },
};
/// The place of the recording.
pub const SAVE_LOG: Dialog = Dialog {
    title: "Save the recording",
    filters: &[],
    saves_as: Some("recording.csv"),
    then: |session, ctx, path| {
        files::save_log(ctx, &session.document, &session.calibration, &mut session.jobs, &path.display().to_string());
    },
};
/// The place of the calibrated world.
pub const SAVE_WORLD: Dialog = Dialog {
    title: "Save the world",
    filters: &[],
    saves_as: Some("world.json"),
    then: |session, ctx, path| {
        files::save_world(ctx, &session.calibration, &mut session.jobs, &path.display().to_string());
    },
};
/// The place of the calibrated world in the format of another simulator.
pub const EXPORT_WORLD: Dialog = Dialog {
    title: "Export the world: .xml for MuJoCo, .urdf or .sdf",
    filters: &[("MuJoCo", &["xml", "mjcf"]), ("URDF", &["urdf"]), ("SDF", &["sdf", "world"])],
    saves_as: Some("world.xml"),
    then: |session, ctx, path| files::export_world(ctx, &session.calibration, &mut session.jobs, path),
};
/// The place of the extended world.
pub const SAVE_EXTENDED: Dialog = Dialog {
    title: "Save the extended world",
    filters: &[],
    saves_as: Some("extended-world.json"),
    then: |session, ctx, path| files::save_extended(ctx, &session.diagnosing, &mut session.jobs, path),
};
/// The place of a table of attempts.
pub const SAVE_HISTORY: Dialog = Dialog {
    title: "Save the attempts",
    filters: &[],
    saves_as: Some("attempts.csv"),
    then: |session, _, path| trainees::export_history(&session.training.learning, path),
};

/// Asks for recordings to check a diagnosis on, on a thread of its own.
pub fn ask_for_recordings_to_check(ctx: &egui::Context, jobs: &mut Jobs<Session>) {
    files::ask_for_logs(ctx, jobs, "Recordings of the same object", |paths| {
        change(|session, ctx| {
            validation::check(
                &session.document,
                &session.calibration,
                &mut session.diagnosing,
                &mut session.jobs,
                ctx,
                On::Files(paths),
            );
        })
    });
}
