//! An open mapping dialog.

use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::files::SAVE;
use crate::ui::jobs::{JobKind, Jobs, change};
use crate::ui::mapping::draft::Draft;
use crate::ui::mapping::facts;
use crate::ui::mapping::facts::FileFacts;
use crate::ui::mapping::plot;
use crate::ui::mapping::preview::Preview;
use crate::ui::session::Session;
use estimator::log::{LogError, sidecar_path, write_sidecar};
use haptics::recording::Meta;
use std::path::{Path, PathBuf};

/// Looking at a log whose columns are to be mapped.
const LOOK: JobKind = JobKind::new("look");

/// An open dialog.
#[derive(Debug)]
pub struct Mapping {
    /// The log.
    pub path: PathBuf,
    /// The sidecar that will be written.
    pub sidecar: PathBuf,
    /// Why the dialog opened by itself, in one sentence.
    pub why: Option<String>,
    /// What the log looks like.
    pub file: FileFacts,
    /// What is edited.
    pub draft: Draft,
    /// What comes of it.
    pub preview: Preview,
    /// Which part of the preview is drawn.
    pub(crate) view: plot::View,
}

/// A file that was looked at, on its way to a dialog.
#[derive(Debug)]
pub struct Looked {
    path: PathBuf,
    sidecar: PathBuf,
    why: Option<String>,
    file: FileFacts,
    meta: Meta,
}

impl From<Looked> for Mapping {
    fn from(looked: Looked) -> Self {
        let Looked { path, sidecar, why, file, meta } = looked;
        let draft = Draft::new(&file, meta);
        Self { path, sidecar, why, file, draft, preview: Preview::default(), view: plot::View::default() }
    }
}

/// Looks at a log in the background; the dialog opens when that is done.
pub fn look(ctx: &egui::Context, jobs: &mut Jobs<Session>, path: &Path, sidecar: Option<PathBuf>, why: Option<String>) {
    let path = path.to_path_buf();
    jobs.start(ctx, LOOK, format!("Looking at {}", name_of(&path)), move |_| {
        let looked = look_now(path, sidecar, why)?;
        change(|session: &mut Session, _| session.mapping = Some(Box::new(looked.into())))
    });
}

/// Looks at a log and its sidecar (`sidecar`, or the one beside it).
pub fn look_now(path: PathBuf, sidecar: Option<PathBuf>, why: Option<String>) -> Result<Looked, String> {
    let sidecar = sidecar.unwrap_or_else(|| sidecar_path(&path));
    let meta = read_sidecar(&sidecar)?;
    let file = facts::look(&path).map_err(|e| sentence(&e.to_string()))?;
    Ok(Looked { path, sidecar, why, file, meta })
}

/// Writes the sidecar in the background; the log is opened with it when that is done.
pub fn save(ctx: &egui::Context, jobs: &mut Jobs<Session>, mapping: &Mapping) {
    let (meta, path, sidecar) = (mapping.draft.sidecar(), mapping.path.clone(), mapping.sidecar.clone());
    jobs.start(ctx, SAVE, "", move |_| {
        write_sidecar(&meta, &sidecar).map_err(|error| sentence(&error.to_string()))?;
        change(move |session: &mut Session, ctx| {
            session.mapping = None;
            session.say_saved(&sidecar);
            session.open_with(ctx, &path, Some(sidecar));
        })
    });
}

/// The sidecar that is there; an empty one when there is none.
fn read_sidecar(path: &Path) -> Result<Meta, String> {
    let text = match haptics::text_file::read(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Meta::default()),
        Err(error) => return Err(format!("The sidecar cannot be read ({error}): {}", path.display())),
    };
    serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|error| format!("The sidecar is malformed ({error}); correct it or remove it: {}", path.display()))
}

/// True for an error that a mapping can mend.
pub fn mends(error: &LogError) -> bool {
    matches!(
        error,
        LogError::MissingColumn { .. }
            | LogError::UnknownUnit { .. }
            | LogError::WrongDimension { .. }
            | LogError::DuplicateColumn { .. }
            | LogError::NothingSelected { .. }
    )
}
