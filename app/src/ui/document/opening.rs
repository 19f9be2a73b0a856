//! Opening files of any kind: logs, worlds, sidecars; told apart by what is in them, not by their names.

use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::{Answer, Jobs, Ticket, no_change};
use crate::ui::calibrate::fitting;
use crate::ui::column_mapping::look::look;
use crate::ui::column_mapping::state;
use crate::ui::document::file_kind::{FileKind, LOAD, LOG_ENDINGS, kind_of, says_nothing};
use crate::ui::document::prepared::Prepared;
use crate::ui::document::project::Source;
use crate::ui::document::project_files;
use crate::ui::document::state::Document;
use crate::ui::document::video_actions;
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use estimator::log::{LogError, Watch};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads a log and prepares it; work for a job.
pub(crate) fn read(path: PathBuf, meta: Option<&Path>, ticket: &Ticket) -> Answer<Session> {
    let progress = |share| ticket.tell(share);
    let watch = Watch { progress: &progress, cancelled: ticket.cancelled(), preview: Some(ticket.preview()) };
    match estimator::log::load_watched(&path, meta, &watch) {
        Ok(recordings) => {
            let prepared = recordings.into_iter().map(|r| Arc::new(Prepared::new(r))).collect();
            change(|session, ctx| loaded(session, ctx, path, prepared))
        }
        Err(LogError::Cancelled { .. }) => no_change(),
        Err(error) if state::mends(&error) => {
            let why = sentence(&error.to_string());
            change(move |session, ctx| {
                session.document.path_field = path.display().to_string();
                map_columns_of(&session.document, &mut session.jobs, ctx, &path, Some(why));
            })
        }
        Err(error) => Err(sentence(&error.to_string())),
    }
}

/// Reads a log in the background, with the sidecar named by hand if there is one, then fits it.
pub fn open(document: &mut Document, jobs: &mut Jobs<Session>, ctx: &egui::Context, path: &Path) {
    let (path, meta) = (path.to_path_buf(), document.meta.clone());
    document.path_field = path.display().to_string();
    let title = format!("Reading {}", name_of(&path));
    jobs.start(ctx, LOAD, title, move |ticket| read(path, meta.as_deref(), ticket));
}

/// Reads a log with this sidecar; without one, with the sidecar beside it.
pub fn open_with(
    document: &mut Document,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    path: &Path,
    sidecar: Option<PathBuf>,
) {
    document.meta = sidecar;
    open(document, jobs, ctx, path);
}

/// Reads a world in the background: a file, or a built-in one by its name.
pub fn open_world(jobs: &mut Jobs<Session>, ctx: &egui::Context, path: &Path) {
    let path = path.to_path_buf();
    jobs.start(ctx, LOAD, "", move |_| {
        let world = crate::worlds::find(&path).map_err(|error| sentence(&format!("{error:#}")))?;
        change(|session, _| session.training.opened_world = Some(Box::new(world)))
    });
}

/// A log was read.
fn loaded(session: &mut Session, ctx: &egui::Context, path: PathBuf, recordings: Vec<Arc<Prepared>>) {
    let mute = says_nothing(&recordings);
    session.document.recent.note(&path);
    session.document.path_field.clear();
    session.document.sources = vec![Source { log: path.clone(), meta: session.document.meta.clone() }];
    session.document.project_path = None;
    let again = session.document.path.as_ref() == Some(&path) && recordings.len() == session.document.recordings.len();
    let videos = std::mem::take(&mut session.document.videos);
    session.workspace = Workspace::Calibrate;
    session.show(recordings);
    session.document.videos = videos;
    if !again {
        session.document.videos.of_log(&path, &session.document.recordings);
    }
    session.document.path = Some(path);
    match mute {
        Some(why) => map_columns(&session.document, &mut session.jobs, ctx, Some(why)),
        None => fitting::refit(&session.document, &mut session.calibration, &mut session.jobs, ctx),
    }
}

/// Opens whatever a file is.
pub fn open_any(
    document: &mut Document,
    wanted_pane: &mut Option<PanelId>,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    path: &Path,
) {
    match kind_of(path) {
        FileKind::World => open_world(jobs, ctx, path),
        FileKind::Sidecar => open_sidecar(document, messages, jobs, ctx, path),
        FileKind::Project => project_files::open_project(document, messages, jobs, ctx, path),
        FileKind::Video => video_actions::open_video(document, wanted_pane, messages, jobs, path),
        FileKind::Log => {
            let again = document.path.as_deref() == Some(path);
            let sidecar = document.meta.clone().filter(|_| again);
            open_with(document, jobs, ctx, path, sidecar);
        }
    }
}

/// Opens what was dropped on the window: one file, or a log with its sidecar.
pub fn open_dropped(session: &mut Session, ctx: &egui::Context, paths: &[PathBuf]) {
    if session.mapping.is_some() && !paths.is_empty() {
        session.messages.fail("Finish or cancel the mapping first, then drop the file again.");
        return;
    }
    match paths {
        [] => {}
        [one] => open_any(
            &mut session.document,
            &mut session.wanted_pane,
            &mut session.messages,
            &mut session.jobs,
            ctx,
            one,
        ),
        [a, b] => match (kind_of(a), kind_of(b)) {
            (FileKind::Log, FileKind::Sidecar) => {
                open_with(&mut session.document, &mut session.jobs, ctx, a, Some(b.clone()));
            }
            (FileKind::Sidecar, FileKind::Log) => {
                open_with(&mut session.document, &mut session.jobs, ctx, b, Some(a.clone()));
            }
            _ => open_first(
                &mut session.document,
                &mut session.wanted_pane,
                &mut session.messages,
                &mut session.jobs,
                ctx,
                paths,
            ),
        },
        _ => open_first(
            &mut session.document,
            &mut session.wanted_pane,
            &mut session.messages,
            &mut session.jobs,
            ctx,
            paths,
        ),
    }
}

fn open_first(
    document: &mut Document,
    wanted_pane: &mut Option<PanelId>,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    paths: &[PathBuf],
) {
    if let Some(first) = paths.first() {
        messages.fail(format!("One file at a time: of {} files, {} was taken.", paths.len(), name_of(first)));
        open_any(document, wanted_pane, messages, jobs, ctx, first);
    }
}

/// A sidecar: for the log that it stands beside, else for the one that is open.
fn open_sidecar(
    document: &mut Document,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    sidecar: &Path,
) {
    let name = name_of(sidecar);
    let stem = name.strip_suffix(".meta.json");
    let beside = stem.and_then(|stem| {
        let at = |ending: &&str| sidecar.with_file_name(format!("{stem}.{ending}"));
        LOG_ENDINGS.iter().map(at).find(|log| log.is_file())
    });
    match beside.or_else(|| document.path.clone()) {
        Some(log) => open_with(document, jobs, ctx, &log, Some(sidecar.to_path_buf())),
        None => messages.fail(format!(
            "{name} is a sidecar and no log stands beside it; open its log first, or drop both together."
        )),
    }
}

/// Opens the mapping dialog for the log that is open, or that the path field names.
pub fn map_columns(document: &Document, jobs: &mut Jobs<Session>, ctx: &egui::Context, why: Option<String>) {
    let named = PathBuf::from(document.path_field.trim());
    let path = document.path.clone().filter(|p| named.as_os_str().is_empty() || *p == named).unwrap_or(named);
    map_columns_of(document, jobs, ctx, &path, why);
}

/// Opens the mapping dialog for a log.
pub fn map_columns_of(
    document: &Document,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    path: &Path,
    why: Option<String>,
) {
    look(ctx, jobs, path, document.meta.clone(), why);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_told_apart_by_their_content() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = |name: &str, text: &str| {
            let path = folder.path().join(name);
            std::fs::write(&path, text).expect("writable");
            path
        };
        let world = haptics::world::presets::stacking().to_json();
        assert_eq!(kind_of(&file("a.csv", "t_s,q_m\n0,1\n")), FileKind::Log);
        assert_eq!(kind_of(&file("b.json", &world)), FileKind::World);
        assert_eq!(kind_of(&file("world.txt", &world)), FileKind::World);
        assert_eq!(kind_of(&file("c.json", r#"{"rate_hz": 100}"#)), FileKind::Sidecar);
        assert_eq!(kind_of(&file("d.meta.json", "{}")), FileKind::Sidecar);
        assert_eq!(
            kind_of(&file("e.json", r#"{"hello": 1}"#)),
            FileKind::World,
            "the world's reader says what is wrong"
        );
        assert_eq!(kind_of(&file("f.json", "t_s,q_m\n0,1\n")), FileKind::Log);
        assert_eq!(kind_of(folder.path()), FileKind::Log);
    }

    #[test]
    fn a_sidecar_alone_says_what_it_needs() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let sidecar = folder.path().join("a.meta.json");
        std::fs::write(&sidecar, r#"{"rate_hz": 100}"#).expect("writable");
        let mut session = Session::new();
        open_any(
            &mut session.document,
            &mut session.wanted_pane,
            &mut session.messages,
            &mut session.jobs,
            &egui::Context::default(),
            &sidecar,
        );
        assert!(session.messages.banners[0].text.contains("open its log first"), "{:?}", session.messages.banners);
    }
}
