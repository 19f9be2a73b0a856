//! A project: which recordings, how they are fitted, and what was looked at, in one small JSON file.

use crate::text::sentence::sentence;
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::plots::choices::KeptChoices;
use crate::ui::shell::workspace::Workspace;
use crate::video::reading::VideoSource;
use crate::write_whole::write_whole;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The ending of project files.
pub const ENDING: &str = "touchstone.json";

/// The version that this program writes.
pub(crate) const VERSION: u32 = 1;

/// A file with recordings.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// The log.
    #[serde(with = "crate::path_bytes")]
    pub log: PathBuf,
    /// A sidecar that does not stand beside it.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "crate::path_bytes")]
    pub meta: Option<PathBuf>,
}

/// Everything that opening a project brings back.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Project {
    /// The version of this format.
    pub touchstone_project: u32,
    /// The files, in order.
    pub recordings: Vec<Source>,
    /// Videos of the hand.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub videos: Vec<VideoSource>,
    /// Settings of their fit.
    pub choice: FitChoice,
    /// The recording that is shown.
    pub current: usize,
    /// The time cursor, s.
    pub cursor_s: f64,
    /// The visible time, s.
    pub view_s: (f64, f64),
    /// The open workspace.
    pub workspace: Workspace,
    /// Settings of the plots.
    pub plots: KeptChoices,
}

impl Project {
    /// Reads one; an error is a sentence.
    pub fn read(path: &Path) -> Result<Self, String> {
        let text = haptics::text_file::read(path)
            .map_err(|e| format!("The project cannot be read ({e}): {}", path.display()))?;
        let mut project: Self = serde_json::from_str(&text).map_err(|e| {
            let why = haptics::text_file::one_line(&e.to_string());
            format!("This is no project that can be read ({why}): {}", path.display())
        })?;
        if project.touchstone_project > VERSION {
            return Err(format!("This project was written by a newer version of the program: {}", path.display()));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        for source in &mut project.recordings {
            source.log = folder.join(&source.log);
            source.meta = source.meta.as_ref().map(|meta| folder.join(meta));
        }
        for video in &mut project.videos {
            video.file = folder.join(&video.file);
        }
        Ok(project)
    }

    /// Writes it whole or not at all; files below the project's folder are named from there, so that the folder can be moved.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let folder = std::path::absolute(path).ok().and_then(|p| p.parent().map(Path::to_path_buf)).unwrap_or_default();
        let within = |p: &Path| {
            let whole = std::path::absolute(p).unwrap_or_else(|_| p.to_path_buf());
            whole.strip_prefix(&folder).map(Path::to_path_buf).unwrap_or(whole)
        };
        let mut project = self.clone();
        for source in &mut project.recordings {
            source.log = within(&source.log);
            source.meta = source.meta.as_deref().map(within);
        }
        for video in &mut project.videos {
            video.file = within(&video.file);
        }
        let text = serde_json::to_string_pretty(&project).map_err(|e| sentence(&e.to_string()))? + "\n";
        write_whole(path, &text)
    }
}

/// True if a JSON file is a project.
pub fn is_project(path: &Path) -> bool {
    let text = haptics::text_file::read(path).unwrap_or_default();
    let value: Option<serde_json::Value> = serde_json::from_str(&text).ok();
    value.is_some_and(|v| v.get("touchstone_project").is_some())
}

#[cfg(test)]
mod tests {
    use super::*;
    use estimator::segment::Method;

    fn project(log: PathBuf) -> Project {
        Project {
            touchstone_project: VERSION,
            videos: vec![VideoSource { file: log.with_extension("mp4"), recording: 0, begins_at_s: -0.4 }],
            recordings: vec![Source { log, meta: None }],
            choice: FitChoice { method: Method::Hmm, ..FitChoice::default() },
            cursor_s: 1.5,
            view_s: (1.0, 2.0),
            workspace: Workspace::Calibrate,
            ..Project::default()
        }
    }

    #[test]
    fn a_project_moves_with_its_folder() {
        let (old, new) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
        let file = old.path().join("a.touchstone.json");
        let mine = project(old.path().join("logs/a.csv"));
        mine.write(&file).expect("written");
        assert!(is_project(&file));
        assert_eq!(Project::read(&file).as_ref(), Ok(&mine));
        let moved = new.path().join("a.touchstone.json");
        std::fs::rename(&file, &moved).expect("moved");
        let again = Project::read(&moved).expect("read");
        assert_eq!(again.recordings[0].log, new.path().join("logs/a.csv"));
        assert_eq!(again.videos[0].file, new.path().join("logs/a.mp4"));
    }

    #[test]
    fn a_file_elsewhere_is_named_in_full() {
        let (folder, other) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
        let file = folder.path().join("a.touchstone.json");
        project(other.path().join("a.csv")).write(&file).expect("written");
        assert_eq!(Project::read(&file).expect("read").recordings[0].log, other.path().join("a.csv"));
    }

    #[test]
    fn what_is_no_project_is_refused_in_words() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("x.json");
        for (text, says) in [("{", "no project"), (r#"{"touchstone_project": 99}"#, "newer version")] {
            std::fs::write(&file, text).expect("written");
            assert!(Project::read(&file).is_err_and(|why| why.contains(says)), "{text}");
        }
        assert!(Project::read(&folder.path().join("none.json")).is_err_and(|why| why.contains("cannot be read")));
    }
}
