//! An open mapping dialog.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::JobKind;
use crate::ui::column_mapping::draft::Draft;
use crate::ui::column_mapping::facts;
use crate::ui::column_mapping::facts::FileFacts;
use crate::ui::column_mapping::preview::Preview;
use estimator::log::{LogError, sidecar_path};
use haptics::recording::Meta;
use std::path::{Path, PathBuf};

/// Looking at a log whose columns are to be mapped.
pub(crate) const LOOK: JobKind = JobKind::new("look");

/// An open dialog.
#[derive(Debug)]
pub struct Mapping {
    /// The log.
    pub path: PathBuf,
    /// Path of the sidecar that will be written.
    pub sidecar: PathBuf,
    /// Reason why the dialog opened by itself, in one sentence.
    pub why: Option<String>,
    /// Facts about the log.
    pub file: FileFacts,
    /// Mapping that is being edited.
    pub draft: Draft,
    /// Preview of the mapped log.
    pub preview: Preview,
    /// Part of the preview that is drawn.
    pub(crate) view: View,
}

/// Content of the preview.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum View {
    /// The path if there is one, otherwise the first curves.
    #[default]
    Automatic,
    /// The path in the plane.
    Path,
    /// The curves of a group.
    Curves(usize),
}

/// Inspected file, on its way to a dialog.
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
        Self { path, sidecar, why, file, draft, preview: Preview::default(), view: View::default() }
    }
}

/// Inspects a log and its sidecar (`sidecar`, or the one beside it).
pub fn look_now(path: PathBuf, sidecar: Option<PathBuf>, why: Option<String>) -> Result<Looked, String> {
    let sidecar = sidecar.unwrap_or_else(|| sidecar_path(&path));
    let meta = read_sidecar(&sidecar)?;
    let file = facts::look(&path).map_err(|e| sentence(&e.to_string()))?;
    Ok(Looked { path, sidecar, why, file, meta })
}

/// Existing sidecar; an empty one if there is none.
pub(crate) fn read_sidecar(path: &Path) -> Result<Meta, String> {
    let text = match haptics::text_file::read(path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Meta::default()),
        Err(error) => return Err(format!("The sidecar cannot be read ({error}): {}", path.display())),
    };
    serde_json::from_str(text.trim_start_matches('\u{feff}'))
        .map_err(|error| format!("The sidecar is malformed ({error}); correct it or remove it: {}", path.display()))
}

/// True for an error that a mapping can fix.
pub fn mends(error: &LogError) -> bool {
    matches!(
        error,
        LogError::MissingColumn { .. }
            | LogError::UnknownUnit { .. }
            | LogError::WrongDimension { .. }
            | LogError::DuplicateColumn { .. }
            | LogError::NothingSelected { .. }
            | LogError::NoChannels { .. }
    )
}
