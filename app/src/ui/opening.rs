//! Opening files of any kind: logs, worlds, sidecars; told apart by what is in them, not by their names.

use super::jobs::{Answer, Ticket, change, no_change};
use super::prepare::Prepared;
use super::project::Source;
use super::session::Session;
use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::file_kind::{FileKind, LOAD, LOG_ENDINGS, kind_of, says_nothing};
use crate::ui::mapping::actions::look;
use crate::ui::mapping::state;
use crate::ui::workspace::Workspace;
use estimator::log::{LogError, Watch};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads a log and prepares it; work for a job.
pub(super) fn read(path: PathBuf, meta: Option<&Path>, ticket: &Ticket) -> Answer<Session> {
    let progress = |share| ticket.tell(share);
    let watch = Watch { progress: &progress, cancelled: ticket.cancelled(), preview: Some(ticket.preview()) };
    match estimator::log::load_watched(&path, meta, &watch) {
        Ok(recordings) => {
            let prepared = recordings.into_iter().map(|r| Arc::new(Prepared::new(r))).collect();
            change(|session: &mut Session, ctx| session.loaded(ctx, path, prepared))
        }
        Err(LogError::Cancelled { .. }) => no_change(),
        Err(error) if state::mends(&error) => {
            let why = sentence(&error.to_string());
            change(move |session: &mut Session, ctx| {
                session.document.path_field = path.display().to_string();
                session.map_columns_of(ctx, &path, Some(why));
            })
        }
        Err(error) => Err(sentence(&error.to_string())),
    }
}

impl Session {
    /// Reads a log in the background, with the sidecar named by hand if there is one, then fits it.
    pub fn open(&mut self, ctx: &egui::Context, path: &Path) {
        let (path, meta) = (path.to_path_buf(), self.document.meta.clone());
        self.document.path_field = path.display().to_string();
        let title = format!("Reading {}", name_of(&path));
        self.jobs.start(ctx, LOAD, title, move |ticket| read(path, meta.as_deref(), ticket));
    }

    /// Reads a log with this sidecar; without one, with the sidecar beside it.
    pub fn open_with(&mut self, ctx: &egui::Context, path: &Path, sidecar: Option<PathBuf>) {
        self.document.meta = sidecar;
        self.open(ctx, path);
    }

    /// Reads a world in the background: a file, or a built-in one by its name.
    pub fn open_world(&mut self, ctx: &egui::Context, path: &Path) {
        let path = path.to_path_buf();
        self.jobs.start(ctx, LOAD, "", move |_| {
            let world = crate::worlds::find(&path).map_err(|error| sentence(&format!("{error:#}")))?;
            change(|session: &mut Self, _| session.training.opened_world = Some(Box::new(world)))
        });
    }

    /// A log was read.
    fn loaded(&mut self, ctx: &egui::Context, path: PathBuf, recordings: Vec<Arc<Prepared>>) {
        let mute = says_nothing(&recordings);
        self.document.recent.note(&path);
        self.document.path_field.clear();
        self.document.sources = vec![Source { log: path.clone(), meta: self.document.meta.clone() }];
        self.document.project_path = None;
        let again = self.document.path.as_ref() == Some(&path) && recordings.len() == self.document.recordings.len();
        let videos = std::mem::take(&mut self.document.videos);
        self.workspace = Workspace::Calibrate;
        self.show(recordings);
        self.document.videos = videos;
        if !again {
            self.document.videos.of_log(&path, &self.document.recordings);
        }
        self.document.path = Some(path);
        match mute {
            Some(why) => self.map_columns(ctx, Some(why)),
            None => self.refit(ctx),
        }
    }

    /// Opens whatever a file is.
    pub fn open_any(&mut self, ctx: &egui::Context, path: &Path) {
        match kind_of(path) {
            FileKind::World => self.open_world(ctx, path),
            FileKind::Sidecar => self.open_sidecar(ctx, path),
            FileKind::Project => self.open_project(ctx, path),
            FileKind::Video => self.open_video(path),
            FileKind::Log => {
                let again = self.document.path.as_deref() == Some(path);
                let sidecar = self.document.meta.clone().filter(|_| again);
                self.open_with(ctx, path, sidecar);
            }
        }
    }

    /// Opens what was dropped on the window: one file, or a log with its sidecar.
    pub fn open_dropped(&mut self, ctx: &egui::Context, paths: &[PathBuf]) {
        if self.mapping.is_some() && !paths.is_empty() {
            self.messages.fail("Finish or cancel the mapping first, then drop the file again.");
            return;
        }
        match paths {
            [] => {}
            [one] => self.open_any(ctx, one),
            [a, b] => match (kind_of(a), kind_of(b)) {
                (FileKind::Log, FileKind::Sidecar) => self.open_with(ctx, a, Some(b.clone())),
                (FileKind::Sidecar, FileKind::Log) => self.open_with(ctx, b, Some(a.clone())),
                _ => self.open_first(ctx, paths),
            },
            _ => self.open_first(ctx, paths),
        }
    }

    fn open_first(&mut self, ctx: &egui::Context, paths: &[PathBuf]) {
        if let Some(first) = paths.first() {
            self.messages.fail(format!("One file at a time: of {} files, {} was taken.", paths.len(), name_of(first)));
            self.open_any(ctx, first);
        }
    }

    /// A sidecar: for the log that it stands beside, else for the one that is open.
    fn open_sidecar(&mut self, ctx: &egui::Context, sidecar: &Path) {
        let name = name_of(sidecar);
        let stem = name.strip_suffix(".meta.json");
        let beside = stem.and_then(|stem| {
            let at = |ending: &&str| sidecar.with_file_name(format!("{stem}.{ending}"));
            LOG_ENDINGS.iter().map(at).find(|log| log.is_file())
        });
        match beside.or_else(|| self.document.path.clone()) {
            Some(log) => self.open_with(ctx, &log, Some(sidecar.to_path_buf())),
            None => self.messages.fail(format!(
                "{name} is a sidecar and no log stands beside it; open its log first, or drop both together."
            )),
        }
    }

    /// Opens the mapping dialog for the log that is open, or that the path field names.
    pub fn map_columns(&mut self, ctx: &egui::Context, why: Option<String>) {
        let named = PathBuf::from(self.document.path_field.trim());
        let path = self.document.path.clone().filter(|p| named.as_os_str().is_empty() || *p == named).unwrap_or(named);
        self.map_columns_of(ctx, &path, why);
    }

    /// Opens the mapping dialog for a log.
    pub fn map_columns_of(&mut self, ctx: &egui::Context, path: &Path, why: Option<String>) {
        look(ctx, &mut self.jobs, path, self.document.meta.clone(), why);
    }
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
        session.open_any(&egui::Context::default(), &sidecar);
        assert!(session.messages.banners[0].text.contains("open its log first"), "{:?}", session.messages.banners);
    }
}
