//! Open recordings, their files, and the time that is looked at.

use crate::tasks::Chosen;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::project::Source;
use crate::ui::document::recent::Recent;
use crate::ui::document::undo::Undo;
use crate::ui::document::videos::Videos;
use std::path::PathBuf;
use std::sync::Arc;

/// The open recordings.
#[derive(Default)]
pub struct Document {
    /// Loaded recordings.
    pub recordings: Vec<Arc<Prepared>>,
    /// The one that is shown.
    pub current: usize,
    /// The file that the recordings came from.
    pub path: Option<PathBuf>,
    /// The files of all recordings.
    pub sources: Vec<Source>,
    /// The project file that is open.
    pub project_path: Option<PathBuf>,
    /// The one that is being opened.
    pub opening_project: Option<PathBuf>,
    /// Files that were open before.
    pub recent: Recent,
    /// A sidecar named by hand.
    pub meta: Option<PathBuf>,
    /// The task that the user named when opening.
    pub task_hint: Option<Chosen>,
    /// The path field.
    pub path_field: String,
    /// Recordings that a killed program left without their end.
    pub unfinished: Vec<PathBuf>,
    /// Videos of the hand.
    pub videos: Videos,
    /// History of changes that can be undone.
    pub undo: Undo,
    /// The time that is looked at.
    pub cursor_s: f64,
    /// The part of the recording that plots show.
    pub view_s: (f64, f64),
    /// True if the cursor runs.
    pub playing: bool,
    /// Playback speed, times real time.
    pub speed: f64,
}

impl Document {
    /// The recording that is shown.
    pub fn prepared(&self) -> Option<&Arc<Prepared>> {
        self.recordings.get(self.current)
    }

    /// Shows another recording of the file.
    pub fn select(&mut self, index: usize) {
        self.current = index.min(self.recordings.len().saturating_sub(1));
        if let Some(prepared) = self.prepared() {
            self.view_s = prepared.span();
            self.cursor_s = self.view_s.0;
            self.videos.loose_s = None;
        }
    }
}
