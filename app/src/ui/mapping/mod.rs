//! The mapping dialog: what the columns of a foreign table mean, with a live preview; it writes the sidecar.
//!
//! [`facts`] looks at the file, [`words`] and [`guess`] read the names, [`draft`] is what is edited and becomes the sidecar,
//! [`preview`] loads with it in the background, [`dialog`] draws.

pub mod dialog;
pub mod draft;
pub mod facts;
pub mod file_units;
pub mod guess;
pub mod names;
mod options;
mod plot;
pub mod preview;
mod table;
pub mod words;

use super::jobs::{JobKind, Jobs, Outcome};
use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use draft::Draft;
use estimator::log::{LogError, sidecar_path, write_sidecar};
use facts::FileFacts;
use haptics::recording::Meta;
use preview::Preview;
use std::path::{Path, PathBuf};

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
    view: plot::View,
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
pub fn look(ctx: &egui::Context, jobs: &mut Jobs, path: &Path, sidecar: Option<PathBuf>, why: Option<String>) {
    let path = path.to_path_buf();
    let what = format!("Looking at {}", name_of(&path));
    jobs.start_watched(ctx, JobKind::Look, what, move |_| {
        look_now(path, sidecar, why).map_or_else(Outcome::Failed, |looked| Outcome::Looked(Box::new(looked)))
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
pub fn save(ctx: &egui::Context, jobs: &mut Jobs, mapping: &Mapping) {
    let (meta, path, sidecar) = (mapping.draft.sidecar(), mapping.path.clone(), mapping.sidecar.clone());
    jobs.start(ctx, JobKind::Save, move || match write_sidecar(&meta, &sidecar) {
        Ok(()) => Outcome::Mapped { log: path, sidecar },
        Err(error) => Outcome::Failed(sentence(&error.to_string())),
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

#[cfg(test)]
mod dialog_tests;
#[cfg(test)]
mod draft_tests;
#[cfg(test)]
mod guess_tests;
