//! Opening and saving projects.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::{Answer, Jobs, Ticket, no_change};
use crate::ui::calibrate::fitting;
use crate::ui::calibrate::state::Calibration;
use crate::ui::diagnose::actions;
use crate::ui::document::file_kind::LOAD;
use crate::ui::document::files::{Dialog, SAVE, ask, saved};
use crate::ui::document::opening;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::project::{Project, Source, VERSION};
use crate::ui::document::state::Document;
use crate::ui::plots::choices::PlotChoices;
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::workspace::Workspace;
use estimator::log::Watch;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The place of the project.
pub const SAVE_PROJECT: Dialog = Dialog {
    title: "Save the project",
    filters: &[],
    saves_as: Some("project.touchstone.json"),
    then: save_project_as,
};

/// Project that holds all that a session has open.
pub fn project_of(
    workspace: Workspace,
    document: &Document,
    calibration: &Calibration,
    plots: &PlotChoices,
) -> Project {
    Project {
        touchstone_project: VERSION,
        recordings: document.sources.clone(),
        videos: document.videos.sources.clone(),
        choice: calibration.choice.clone(),
        current: document.current,
        cursor_s: document.cursor_s,
        view_s: document.view_s,
        workspace,
        plots: plots.kept(),
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
    change(|session, ctx| {
        opened_project(session, ctx, project, recordings);
        actions::ask_again(session, ctx);
    })
}

/// Opens a project file in the background.
pub fn open_project(
    document: &mut Document,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    path: &Path,
) {
    match Project::read(path) {
        Ok(project) => {
            document.opening_project = Some(path.to_path_buf());
            restore(messages, jobs, ctx, project);
        }
        Err(problem) => messages.fail(problem),
    }
}

/// Opens what a project names, in the background.
pub fn restore(messages: &mut Messages, jobs: &mut Jobs<Session>, ctx: &egui::Context, project: Project) {
    if project.recordings.is_empty() {
        messages.fail("This project names no recording.");
        return;
    }
    jobs.start(ctx, LOAD, "Opening the project", move |ticket| read_all(project, ticket));
}

/// A project's files were read.
pub(crate) fn opened_project(
    session: &mut Session,
    ctx: &egui::Context,
    project: Project,
    recordings: Vec<Arc<Prepared>>,
) {
    let first = project.recordings.first().cloned().unwrap_or_default();
    session.document.meta = first.meta;
    session.document.path_field.clear();
    session.document.path = Some(first.log);
    session.document.sources = project.recordings;
    session.show(recordings);
    session.document.videos.sources = project.videos;
    session.calibration.choice = project.choice;
    session.document.select(project.current);
    if project.view_s.1 > project.view_s.0 {
        session.document.view_s = project.view_s;
    }
    session.document.seek(project.cursor_s);
    session.workspace = project.workspace;
    session.plots.restore(project.plots);
    session.document.project_path = session.document.opening_project.take();
    if let Some(path) = session.document.project_path.clone() {
        session.document.recent.note(&path);
    }
    fitting::refit(&session.document, &mut session.calibration, &mut session.jobs, ctx);
}

/// Adds the recordings of another file to those that are open, and fits all of them together.
pub fn add_log(session: &mut Session, ctx: &egui::Context, path: &Path) {
    if session.document.sources.is_empty() {
        opening::open_any(
            &mut session.document,
            &mut session.wanted_pane,
            &mut session.messages,
            &mut session.jobs,
            ctx,
            path,
        );
        return;
    }
    let mut project = project_of(session.workspace, &session.document, &session.calibration, &session.plots);
    project.recordings.push(Source { log: path.to_path_buf(), meta: None });
    session.document.opening_project.clone_from(&session.document.project_path);
    restore(&mut session.messages, &mut session.jobs, ctx, project);
}

/// Writes the project where it was opened, or asks where.
pub fn save_project(session: &mut Session, ctx: &egui::Context) {
    match session.document.project_path.clone() {
        Some(path) => save_project_as(session, ctx, path),
        None => ask(ctx, &mut session.jobs, SAVE_PROJECT),
    }
}

/// Writes the project there.
pub fn save_project_as(session: &mut Session, ctx: &egui::Context, path: PathBuf) {
    let project = project_of(session.workspace, &session.document, &session.calibration, &session.plots);
    session.document.project_path = Some(path.clone());
    session.document.recent.note(&path);
    session.jobs.start(ctx, SAVE, "", move |_| {
        project.write(&path)?;
        saved(path)
    });
}
