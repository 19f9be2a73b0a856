//! Kinds of files, told apart by their content.

use crate::ui::background::jobs::JobKind;
use crate::ui::document::prepared::Prepared;
use haptics::recording::Meta;
use haptics::world::World;
use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;

/// Reading a log, a project or a world.
pub const LOAD: JobKind = JobKind::new("load");

/// Bytes that tell JSON from anything else.
pub(crate) const START_BYTES: u64 = 4096;

/// Endings that the log of a sidecar may have.
pub(crate) const LOG_ENDINGS: [&str; 7] = ["csv", "mcap", "parquet", "mat", "tsv", "txt", "dat"];

/// Kind of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A table of samples in any format, or what the reader of logs will refuse in one sentence.
    Log,
    /// A world.
    World,
    /// The facts about a log.
    Sidecar,
    /// Recordings, and how they are fitted.
    Project,
    /// A video of the hand.
    Video,
}

/// Tells what a file is.
pub fn kind_of(path: &Path) -> FileKind {
    let mut start = Vec::new();
    let read = std::fs::File::open(path).and_then(|f| f.take(START_BYTES).read_to_end(&mut start));
    if crate::video::reading::looks_like_video(&start) {
        return FileKind::Video;
    }
    let text = start.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&start);
    if read.is_err() || text.trim_ascii_start().first() != Some(&b'{') {
        return FileKind::Log;
    }
    if crate::ui::document::project::is_project(path) {
        return FileKind::Project;
    }
    let named = path.file_name().is_some_and(|n| n.to_string_lossy().to_lowercase().ends_with(".meta.json"));
    if named || is_sidecar(path) { FileKind::Sidecar } else { FileKind::World }
}

/// True for JSON that says something about a log and nothing else.
pub(crate) fn is_sidecar(path: &Path) -> bool {
    let Ok(text) = haptics::text_file::read(path) else { return false };
    let meta: Option<Meta> = serde_json::from_str(text.trim_start_matches('\u{feff}')).ok();
    meta.is_some_and(|meta| {
        meta != Meta { other: meta.other.clone(), ..Meta::default() } && World::from_json(&text).is_err()
    })
}

/// Why a mapping should be offered for recordings that could be read: nothing in them has a name that the program knows.
pub fn says_nothing(recordings: &[Arc<Prepared>]) -> Option<String> {
    let warnings = &recordings.first()?.recording.warnings;
    let mute = warnings.iter().any(|w| w.kind == estimator::log::NO_KNOWN_COLUMN);
    mute.then(|| "No column has a name that the program knows: say what they mean.".to_owned())
}
