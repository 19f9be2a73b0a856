//! File dialogs and saving, all in the background. Where the system has no dialog, the path fields do the same.

use super::checking::On;
use super::jobs::{JobKind, Jobs, Outcome, Purpose};
use super::session::Session;
use crate::export::{Format, export};
use crate::text::sentence::sentence;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Nobody cancels this fast: there is no dialog.
const THERE: Duration = Duration::from_millis(250);
const NO_DIALOG: &str =
    "This system opens no file dialog; type the path into the field, or drop the file on the window.";
/// Endings of logs.
const LOGS: &[&str] = &["csv", "txt", "tsv", "dat", "mcap", "parquet"];

/// Opens a file dialog on a thread of its own.
pub fn ask(ctx: &egui::Context, jobs: &mut Jobs, purpose: Purpose) {
    jobs.start(ctx, JobKind::Dialog, move || {
        let asked = Instant::now();
        let chosen = dialog(purpose);
        if chosen.is_none() && asked.elapsed() < THERE {
            return Outcome::Failed(NO_DIALOG.to_owned());
        }
        Outcome::Chosen(purpose, chosen)
    });
}

/// Opens a file dialog for several files, on a thread of its own.
pub fn ask_many(ctx: &egui::Context, jobs: &mut Jobs, purpose: Purpose) {
    jobs.start(ctx, JobKind::Dialog, move || {
        let asked = Instant::now();
        let dialog = rfd::FileDialog::new().set_title("Recordings of the same object").add_filter("Logs", LOGS);
        match dialog.add_filter("All files", &["*"]).pick_files() {
            Some(paths) => Outcome::ChosenMany(purpose, paths),
            None if asked.elapsed() < THERE => Outcome::Failed(NO_DIALOG.to_owned()),
            None => Outcome::Cancelled,
        }
    });
}

fn dialog(purpose: Purpose) -> Option<PathBuf> {
    let dialog = rfd::FileDialog::new();
    match purpose {
        Purpose::OpenLog => dialog
            .set_title("Open a log")
            .add_filter("Logs", LOGS)
            // What a file is, its content tells.
            .add_filter("All files", &["*"])
            .pick_file(),
        Purpose::OpenWorld => dialog.set_title("Open a world").add_filter("Worlds", &["json"]).pick_file(),
        Purpose::OpenProject => {
            dialog.set_title("Open a project").add_filter("Projects", &["touchstone.json", "json"]).pick_file()
        }
        Purpose::AddLog => dialog
            .set_title("Add a recording of the same object")
            .add_filter("Logs", LOGS)
            .add_filter("All files", &["*"])
            .pick_file(),
        Purpose::AddExperiment | Purpose::Check => dialog
            .set_title("Add a recording of the experiment")
            .add_filter("Logs", LOGS)
            .add_filter("All files", &["*"])
            .pick_file(),
        Purpose::OpenVideo => dialog
            .set_title("Open a video of the hand")
            .add_filter("Videos", &["mp4", "mov", "mkv", "webm", "avi", "m4v", "mpg", "ts", "gif"])
            .add_filter("All files", &["*"])
            .pick_file(),
        Purpose::SaveProject => {
            let name = format!("project.{}", super::project::ENDING);
            dialog.set_title("Save the project").set_file_name(name).save_file()
        }
        Purpose::SaveReport => dialog.set_title("Write a report").set_file_name("report.html").save_file(),
        Purpose::SaveLog => dialog.set_title("Save the recording").set_file_name("recording.csv").save_file(),
        Purpose::SaveWorld => dialog.set_title("Save the world").set_file_name("world.json").save_file(),
        Purpose::ExportWorld => dialog
            .set_title("Export the world: .xml for MuJoCo, .urdf or .sdf")
            .add_filter("MuJoCo", &["xml", "mjcf"])
            .add_filter("URDF", &["urdf"])
            .add_filter("SDF", &["sdf", "world"])
            .set_file_name("world.xml")
            .save_file(),
        Purpose::SaveHistory => dialog.set_title("Save the attempts").set_file_name("attempts.csv").save_file(),
        Purpose::SaveExtended => {
            dialog.set_title("Save the extended world").set_file_name("extended-world.json").save_file()
        }
    }
}

impl Session {
    /// A dialog was answered.
    pub(super) fn chosen(&mut self, ctx: &egui::Context, purpose: Purpose, path: PathBuf) {
        match purpose {
            Purpose::OpenLog => self.open_any(ctx, &path),
            Purpose::OpenWorld => self.open_world(ctx, &path),
            Purpose::OpenProject => self.open_project(ctx, &path),
            Purpose::OpenVideo => self.open_video(&path),
            Purpose::AddLog => self.add_log(ctx, &path),
            Purpose::AddExperiment => self.add_experiment(ctx, &path),
            Purpose::Check => self.check(ctx, On::Files(vec![path])),
            Purpose::SaveProject => self.save_project_as(ctx, path),
            Purpose::SaveReport => save_report(ctx, self, path),
            Purpose::SaveLog => {
                save_log(ctx, self, &path.display().to_string());
            }
            Purpose::SaveWorld => {
                save_world(ctx, self, &path.display().to_string());
            }
            Purpose::ExportWorld => export_world(ctx, self, path),
            Purpose::SaveExtended => save_extended(ctx, self, path),
            Purpose::SaveHistory => self.export_history(path),
        }
    }
}

/// Writes the shown recording and its sidecar.
pub fn save_log(ctx: &egui::Context, session: &mut Session, field: &str) {
    let Some(prepared) = session.prepared().cloned() else { return };
    let path = PathBuf::from(field.trim());
    let (choice, index) = (session.choice.clone(), session.current);
    session.jobs.start(ctx, JobKind::Save, move || {
        // A task of the user's goes along, and what was stated and set by hand.
        let recording = &choice.given_to(index, &prepared.recording);
        let written = estimator::log::write_csv(recording, &path)
            .and_then(|()| estimator::log::write_meta(recording, &path).map(drop));
        match written {
            Ok(()) => Outcome::Saved(path),
            Err(error) => Outcome::Failed(sentence(&error.to_string())),
        }
    });
}

/// Writes a report of the open files, as they are fitted.
pub fn save_report(ctx: &egui::Context, session: &mut Session, path: PathBuf) {
    let (sources, choice) = (session.sources.clone(), session.choice.clone());
    session.jobs.start_watched(ctx, JobKind::Save, "Writing the report".to_owned(), move |_| {
        match crate::report::of_files(&sources_of(&sources), &path, |index, recording| {
            choice.given_to(index, &recording)
        }) {
            Ok(()) => Outcome::Saved(path),
            Err(problem) => Outcome::Failed(problem),
        }
    });
}

fn sources_of(sources: &[super::project::Source]) -> Vec<(PathBuf, Option<PathBuf>)> {
    sources.iter().map(|s| (s.log.clone(), s.meta.clone())).collect()
}

/// Writes the world with what a diagnosis found in it.
pub fn save_extended(ctx: &egui::Context, session: &mut Session, path: PathBuf) {
    let Some(worlds) = session.diagnosing.worlds.clone() else { return };
    session.jobs.start(ctx, JobKind::Save, move || match write(&path, &(worlds.after.to_json() + "\n")) {
        Ok(()) => Outcome::Saved(path),
        Err(problem) => Outcome::Failed(problem),
    });
}

/// Writes the calibrated world.
pub fn save_world(ctx: &egui::Context, session: &mut Session, field: &str) {
    let Some(analysis) = session.analysis.clone() else { return };
    let path = PathBuf::from(field.trim());
    session.jobs.start(ctx, JobKind::Save, move || match write(&path, &analysis.world.to_json()) {
        Ok(()) => Outcome::Saved(path),
        Err(problem) => Outcome::Failed(problem),
    });
}

/// Writes the calibrated world for another simulator; what has no counterpart there stands at the top of the file.
pub fn export_world(ctx: &egui::Context, session: &mut Session, path: PathBuf) {
    let Some(analysis) = session.analysis.clone() else { return };
    session.jobs.start(ctx, JobKind::Save, move || {
        let Some(format) = Format::of_ending(&path) else {
            return Outcome::Failed(format!(
                "The ending names no format; use .xml (MuJoCo), .urdf or .sdf: {}",
                path.display()
            ));
        };
        let exported = export(&analysis.world, format, false);
        if exported.bodies.is_empty() {
            return Outcome::Failed(format!("Nothing of this world has a counterpart in {}.", format.name()));
        }
        match write(&path, &exported.text) {
            Ok(()) => Outcome::Saved(path),
            Err(problem) => Outcome::Failed(problem),
        }
    });
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    crate::write_whole::write_whole(path, text)
}
