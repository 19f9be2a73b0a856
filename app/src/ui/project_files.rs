//! Opening and saving projects.

use super::files::{SAVE, SAVE_PROJECT, ask, saved};
use super::jobs::{Answer, Ticket, change, no_change};
use super::prepare::Prepared;
use super::session::Session;
use crate::text::sentence::sentence;
use crate::ui::file_kind::LOAD;
use crate::ui::project::{Project, Source, VERSION};
use estimator::log::Watch;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a session has open.
pub fn project_of(session: &Session) -> Project {
    Project {
        touchstone_project: VERSION,
        recordings: session.document.sources.clone(),
        videos: session.document.videos.sources.clone(),
        choice: session.calibration.choice.clone(),
        current: session.document.current,
        cursor_s: session.document.cursor_s,
        view_s: session.document.view_s,
        workspace: session.workspace,
        plots: session.plots.kept(),
    }
}

/// Reads every file of a project; work for a job.
fn read_all(project: Project, ticket: &Ticket) -> Answer<Session> {
    let mut recordings = Vec::new();
    let count = project.recordings.len().max(1) as f64;
    for (index, source) in project.recordings.iter().enumerate() {
        let progress = |share: f64| ticket.tell((index as f64 + share) / count);
        let watch = Watch { progress: &progress, cancelled: ticket.cancelled(), preview: None };
        match estimator::log::load_watched(&source.log, source.meta.as_deref(), &watch) {
            Ok(read) => recordings.extend(read.into_iter().map(|r| Arc::new(Prepared::new(r)))),
            Err(estimator::log::LogError::Cancelled { .. }) => return no_change(),
            Err(error) => return Err(sentence(&error.to_string())),
        }
    }
    change(|session: &mut Session, ctx| {
        session.opened_project(ctx, project, recordings);
        session.ask_again(ctx);
    })
}

impl Session {
    /// Opens a project file in the background.
    pub fn open_project(&mut self, ctx: &egui::Context, path: &Path) {
        match Project::read(path) {
            Ok(project) => {
                self.document.opening_project = Some(path.to_path_buf());
                self.restore(ctx, project);
            }
            Err(problem) => self.messages.fail(problem),
        }
    }

    /// Opens what a project names, in the background.
    pub fn restore(&mut self, ctx: &egui::Context, project: Project) {
        if project.recordings.is_empty() {
            self.messages.fail("This project names no recording.");
            return;
        }
        self.jobs.start(ctx, LOAD, "Opening the project", move |ticket| read_all(project, ticket));
    }

    /// A project's files were read.
    pub(super) fn opened_project(&mut self, ctx: &egui::Context, project: Project, recordings: Vec<Arc<Prepared>>) {
        let first = project.recordings.first().cloned().unwrap_or_default();
        self.document.meta = first.meta;
        self.document.path_field.clear();
        self.document.path = Some(first.log);
        self.document.sources = project.recordings;
        self.show(recordings);
        self.document.videos.sources = project.videos;
        self.calibration.choice = project.choice;
        self.document.select(project.current);
        if project.view_s.1 > project.view_s.0 {
            self.document.view_s = project.view_s;
        }
        self.document.seek(project.cursor_s);
        self.workspace = project.workspace;
        self.plots.restore(project.plots);
        self.document.project_path = self.document.opening_project.take();
        if let Some(path) = self.document.project_path.clone() {
            self.document.recent.note(&path);
        }
        self.refit(ctx);
    }

    /// Adds the recordings of another file to those that are open, and fits all of them together.
    pub fn add_log(&mut self, ctx: &egui::Context, path: &Path) {
        if self.document.sources.is_empty() {
            self.open_any(ctx, path);
            return;
        }
        let mut project = project_of(self);
        project.recordings.push(Source { log: path.to_path_buf(), meta: None });
        self.document.opening_project.clone_from(&self.document.project_path);
        self.restore(ctx, project);
    }

    /// Writes the project where it was opened, or asks where.
    pub fn save_project(&mut self, ctx: &egui::Context) {
        match self.document.project_path.clone() {
            Some(path) => self.save_project_as(ctx, path),
            None => ask(ctx, &mut self.jobs, SAVE_PROJECT),
        }
    }

    /// Writes the project there.
    pub fn save_project_as(&mut self, ctx: &egui::Context, path: PathBuf) {
        let project = project_of(self);
        self.document.project_path = Some(path.clone());
        self.document.recent.note(&path);
        self.jobs.start(ctx, SAVE, "", move |_| {
            project.write(&path)?;
            saved(path)
        });
    }
}
