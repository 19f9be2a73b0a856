//! The videos of the open recordings.

use crate::ui::background::jobs::JobKind;
use crate::ui::document::file_kind::LOAD;
use crate::ui::document::prepared::Prepared;
use crate::video::reading::{Video, VideoSource};
use egui::{ColorImage, TextureHandle};
use estimator::signal::lag::lag;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reading a video.
pub(crate) const VIDEO: JobKind = JobKind::new("video").after(&LOAD);

/// Decoding a picture of it.
pub(crate) const PICTURE: JobKind = JobKind::new("picture");

/// Finding the place of a video on its recording.
pub const ALIGN_VIDEO: JobKind = JobKind::new("align-video");

/// Endings that a video beside its log may have.
pub(crate) const ENDINGS: [&str; 5] = ["mp4", "mov", "mkv", "webm", "avi"];

/// Speeds and changes of pictures less alike than this tell nothing.
pub(crate) const LEAST_LIKENESS: f64 = 0.3;

/// A file that was read, or why it could not be.
pub(crate) type Read = (PathBuf, Result<Arc<Video>, String>);

/// The picture on the screen.
#[derive(Clone)]
pub(crate) struct Shown {
    pub(crate) file: PathBuf,
    pub(crate) index: usize,
    /// `None` where the file is damaged.
    pub(crate) texture: Option<TextureHandle>,
}

/// The videos of the open recordings.
#[derive(Default)]
pub struct Videos {
    /// Video files, at most one a recording.
    pub sources: Vec<VideoSource>,
    /// While the video is looked at by itself: where in it, s from its beginning.
    pub loose_s: Option<f64>,
    /// Pictures are decoded while one waits: where there is no window whose next frame could show them.
    pub(crate) at_once: bool,
    pub(crate) read: Vec<Read>,
    pub(crate) shown: Option<Shown>,
}

#[cfg(test)]
impl Videos {
    /// Number of the picture on the screen.
    pub(crate) fn shown(&self) -> Option<usize> {
        self.shown.as_ref().filter(|s| s.texture.is_some()).map(|s| s.index)
    }
}

/// State of the shown recording's video.
pub enum State {
    /// It has none.
    None,
    /// It is being read.
    Reading,
    /// Why it cannot be shown, a sentence.
    Failed(String),
    /// It can be looked at.
    There(Arc<Video>),
}

impl Videos {
    /// Files that no recording names any more are forgotten.
    pub(crate) fn tidy(&mut self) {
        self.read.retain(|(file, _)| self.sources.iter().any(|s| s.file == *file));
    }

    pub(crate) fn answer(&self, file: &Path) -> Option<&Result<Arc<Video>, String>> {
        self.read.iter().find(|(known, _)| known == file).map(|(_, answer)| answer)
    }

    /// Other recordings were opened: theirs may have videos that their sidecars name, or that stand beside the log.
    pub(crate) fn of_log(&mut self, log: &Path, recordings: &[Arc<Prepared>]) {
        *self = Self::default();
        let folder = log.parent().unwrap_or(Path::new(""));
        for (index, prepared) in recordings.iter().enumerate() {
            if let Some(named) = &prepared.recording.meta.video {
                let (file, begins_at_s) = (folder.join(&named.file), named.begins_at_s);
                self.sources.push(VideoSource { file, recording: index, begins_at_s });
            }
        }
        let beside = ENDINGS.iter().map(|ending| log.with_extension(ending)).find(|file| file.is_file());
        if let ([_], true, Some(file)) = (recordings, self.sources.is_empty(), beside) {
            self.sources.push(VideoSource { file, recording: 0, begins_at_s: 0.0 });
        }
    }
}

pub(crate) fn decoded(video: &Video, index: usize) -> Option<ColorImage> {
    let picture = video.picture(index)?;
    Some(ColorImage::from_rgb([picture.width() as usize, picture.height() as usize], picture.as_raw()))
}

/// Time at which a video begins on the recording's clock, s, by correlation of the motion in both.
pub(crate) fn begins_at(prepared: &Prepared, times: &[f64], changes: &[f64]) -> Result<f64, String> {
    let nothing = "Nothing moves in the video when the recorded hand moves; look at the video by itself, find a moment that \
                   you recognise, put the cursor there, and press They belong together.";
    let speed =
        hand_speed(prepared).ok_or("This recording says nothing of how the hand moved; shift the video by hand.")?;
    let found = lag((&prepared.times, &speed), (times, changes)).filter(|l| l.likeness > LEAST_LIKENESS);
    found.map(|l| l.offset_s).ok_or_else(|| nothing.to_owned())
}

/// Speed of the recorded motion, in the unit of its position per second; `None` without positions.
pub(crate) fn hand_speed(prepared: &Prepared) -> Option<Vec<f64>> {
    if prepared.clockless() || prepared.times.len() < 3 {
        return None;
    }
    let between = |i: usize| (i.saturating_sub(1), (i + 1).min(prepared.times.len() - 1));
    let rate = |of: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
        (0..prepared.times.len())
            .map(|i| {
                let (a, b) = between(i);
                of(a, b) / (prepared.times[b] - prepared.times[a])
            })
            .collect()
    };
    let tips: Vec<_> = prepared.tips.iter().flatten().chain(&prepared.tool).collect();
    if !tips.is_empty() {
        return Some(rate(&|a, b| tips.iter().map(|t| (t.position[b] - t.position[a]).norm()).sum()));
    }
    let group = prepared.groups.iter().find(|g| g.title == "Position" || g.title == "Angle")?;
    let trace = group.traces.first()?;
    let samples = trace.levels.samples(&prepared.recording);
    Some(rate(&|a, b| (samples.value(b) - samples.value(a)).abs()))
}
