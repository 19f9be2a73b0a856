//! File dialogs and saving, all in the background. Where the system has no dialog, the path fields do the same.

use crate::export::{Format, export};
use crate::report::of_files;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::{Answer, JobKind, Jobs, no_change};
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::document::state::Document;
use crate::ui::session::{Session, change};
use crate::write_whole::write_whole;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Nobody cancels this fast: there is no dialog.
const THERE: Duration = Duration::from_millis(250);
const NO_DIALOG: &str =
    "This system opens no file dialog; type the path into the field, or drop the file on the window.";
/// Endings of logs.
const LOGS: &[&str] = &["csv", "txt", "tsv", "dat", "mcap", "parquet", "mat"];

/// Waiting for a file dialog.
const DIALOG: JobKind = JobKind::new("dialog").waits();
/// Writing a file.
pub const SAVE: JobKind = JobKind::new("save").writes();

/// A file dialog, and the use of the path that it brings.
#[derive(Clone, Copy)]
pub struct Dialog {
    pub(crate) title: &'static str,
    /// Name and endings of the files on offer.
    pub(crate) filters: &'static [(&'static str, &'static [&'static str])],
    /// The proposed name of a file to write; nothing where one is opened.
    pub(crate) saves_as: Option<&'static str>,
    /// Use of the chosen path.
    pub(crate) then: fn(&mut Session, &egui::Context, PathBuf),
}

/// Logs first; the content tells what a file is.
pub(crate) const LOGS_AND_ALL: &[(&str, &[&str])] = &[("Logs", LOGS), ("All files", &["*"])];

/// Opens a file dialog on a thread of its own.
pub fn ask(ctx: &egui::Context, jobs: &mut Jobs<Session>, dialog: Dialog) {
    jobs.start(ctx, DIALOG, "", move |_| {
        let asked = Instant::now();
        let shown = dialog_of(dialog.title, dialog.filters);
        let chosen = match dialog.saves_as {
            Some(name) => shown.set_file_name(name).save_file(),
            None => shown.pick_file(),
        };
        match chosen {
            Some(path) => answered(dialog, path),
            None if asked.elapsed() < THERE => Err(NO_DIALOG.to_owned()),
            None => no_change(),
        }
    });
}

/// The answer of a dialog in which a file was chosen.
pub fn answered(dialog: Dialog, path: PathBuf) -> Answer<Session> {
    change(move |session, ctx| (dialog.then)(session, ctx, path))
}

/// Asks for several logs on a thread of its own.
pub fn ask_for_logs(
    ctx: &egui::Context,
    jobs: &mut Jobs<Session>,
    title: &'static str,
    then: impl FnOnce(Vec<PathBuf>) -> Answer<Session> + Send + 'static,
) {
    jobs.start(ctx, DIALOG, "", move |_| {
        let asked = Instant::now();
        match dialog_of(title, LOGS_AND_ALL).pick_files() {
            Some(paths) => then(paths),
            None if asked.elapsed() < THERE => Err(NO_DIALOG.to_owned()),
            None => no_change(),
        }
    });
}

fn dialog_of(title: &str, filters: &[(&str, &[&str])]) -> rfd::FileDialog {
    let dialog = rfd::FileDialog::new().set_title(title);
    filters.iter().fold(dialog, |dialog, (name, endings)| dialog.add_filter(*name, endings))
}

/// The answer of a job that has written a file.
pub fn saved(path: PathBuf) -> Answer<Session> {
    change(move |session, _| session.messages.say_saved(&path))
}

/// Writes the shown recording and its sidecar.
pub fn save_log(
    ctx: &egui::Context,
    document: &Document,
    calibration: &Calibration,
    jobs: &mut Jobs<Session>,
    field: &str,
) {
    let Some(prepared) = document.prepared().cloned() else { return };
    let path = PathBuf::from(field.trim());
    let (choice, index) = (calibration.choice.clone(), document.current);
    jobs.start(ctx, SAVE, "", move |_| {
        // A task of the user's goes along, and what was stated and set by hand.
        let recording = &choice.given_to(index, &prepared.recording);
        estimator::log::write_csv(recording, &path)
            .and_then(|()| estimator::log::write_meta(recording, &path))
            .map_err(|error| sentence(&error.to_string()))?;
        saved(path)
    });
}

/// Writes a report of the open files, as they are fitted.
pub fn save_report(
    ctx: &egui::Context,
    document: &Document,
    calibration: &Calibration,
    jobs: &mut Jobs<Session>,
    path: PathBuf,
) {
    let (sources, choice) = (document.sources.clone(), calibration.choice.clone());
    jobs.start(ctx, SAVE, "Writing the report", move |_| {
        let given = |index, recording| choice.given_to(index, &recording);
        of_files::of_files(&sources_of(&sources), &path, given)?;
        saved(path)
    });
}

fn sources_of(sources: &[crate::ui::document::project::Source]) -> Vec<(PathBuf, Option<PathBuf>)> {
    sources.iter().map(|s| (s.log.clone(), s.meta.clone())).collect()
}

/// Writes the world with what a diagnosis found in it.
pub fn save_extended(ctx: &egui::Context, diagnosing: &Diagnosing, jobs: &mut Jobs<Session>, path: PathBuf) {
    let Some(worlds) = diagnosing.worlds.clone() else { return };
    jobs.start(ctx, SAVE, "", move |_| {
        write_whole(&path, &(worlds.after.to_json() + "\n"))?;
        saved(path)
    });
}

/// Writes the calibrated world.
pub fn save_world(ctx: &egui::Context, calibration: &Calibration, jobs: &mut Jobs<Session>, field: &str) {
    let Some(analysis) = calibration.analysis.clone() else { return };
    let path = PathBuf::from(field.trim());
    jobs.start(ctx, SAVE, "", move |_| {
        write_whole(&path, &analysis.world.to_json())?;
        saved(path)
    });
}

/// Writes the calibrated world for another simulator; what has no counterpart there stands at the top of the file.
pub fn export_world(ctx: &egui::Context, calibration: &Calibration, jobs: &mut Jobs<Session>, path: PathBuf) {
    let Some(analysis) = calibration.analysis.clone() else { return };
    jobs.start(ctx, SAVE, "", move |_| {
        let Some(format) = Format::of_ending(&path) else {
            return Err(format!("The ending names no format; use .xml (MuJoCo), .urdf or .sdf: {}", path.display()));
        };
        let exported = export(&analysis.world, format, false);
        if exported.bodies.is_empty() {
            return Err(format!("Nothing of this world has a counterpart in {}.", format.name()));
        }
        write_whole(&path, &exported.text)?;
        saved(path)
    });
}
