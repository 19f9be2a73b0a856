//! The video of the hand that belongs to a recording: reading it, its picture at the cursor, and where it lies in time.

use super::jobs::{JobKind, change, no_change};
use super::opening::LOAD;
use super::panel_id::PanelId;
use super::prepare::Prepared;
use super::session::Session;
use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::video::reading;
use crate::video::reading::{Video, VideoError, VideoSource, Watch};
use egui::{ColorImage, TextureHandle, TextureOptions};
use estimator::signal::lag::lag;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Reading a video.
const VIDEO: JobKind = JobKind::new("video").after(&LOAD);
/// Decoding a picture of it.
const PICTURE: JobKind = JobKind::new("picture");
/// Finding the place of a video on its recording.
pub const ALIGN_VIDEO: JobKind = JobKind::new("align-video");

/// Endings that a video beside its log may have.
const ENDINGS: [&str; 5] = ["mp4", "mov", "mkv", "webm", "avi"];
/// Speeds and changes of pictures less alike than this tell nothing.
const LEAST_LIKENESS: f64 = 0.3;

/// A file that was read, or why it could not be.
type Read = (PathBuf, Result<Arc<Video>, String>);

/// The picture on the screen.
#[derive(Clone)]
struct Shown {
    file: PathBuf,
    index: usize,
    /// `None` where the file is damaged.
    texture: Option<TextureHandle>,
}

/// The videos of the open recordings.
#[derive(Default)]
pub struct Videos {
    /// Which files, at most one a recording.
    pub sources: Vec<VideoSource>,
    /// While the video is looked at by itself: where in it, s from its beginning.
    pub loose_s: Option<f64>,
    /// Pictures are decoded while one waits: where there is no window whose next frame could show them.
    at_once: bool,
    read: Vec<Read>,
    shown: Option<Shown>,
}

#[cfg(test)]
impl Videos {
    /// Number of the picture on the screen.
    pub(super) fn shown(&self) -> Option<usize> {
        self.shown.as_ref().filter(|s| s.texture.is_some()).map(|s| s.index)
    }
}

/// How far the video of the shown recording is.
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
    fn tidy(&mut self) {
        self.read.retain(|(file, _)| self.sources.iter().any(|s| s.file == *file));
    }

    fn answer(&self, file: &Path) -> Option<&Result<Arc<Video>, String>> {
        self.read.iter().find(|(known, _)| known == file).map(|(_, answer)| answer)
    }

    /// Other recordings were opened: theirs may have videos that their sidecars name, or that stand beside the log.
    pub(super) fn of_log(&mut self, log: &Path, recordings: &[Arc<Prepared>]) {
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

impl Session {
    /// Which video the shown recording has.
    pub fn video_source(&self) -> Option<&VideoSource> {
        self.videos.sources.iter().find(|s| s.recording == self.current)
    }

    fn video_source_mut(&mut self) -> Option<&mut VideoSource> {
        let current = self.current;
        self.videos.sources.iter_mut().find(|s| s.recording == current)
    }

    /// A video for the shown recording, in the place of the one it has.
    pub fn open_video(&mut self, file: &Path) {
        match self.prepared() {
            None => self.fail("A video belongs to a recording: open the log first, then the video."),
            Some(prepared) if prepared.clockless() => {
                self.fail("This recording has no clock, so no video can run beside it; state its rate in the sidecar.");
            }
            Some(_) => {
                let begins_at_s = self.prepared().map_or(0.0, |p| p.span().0);
                self.forget_video();
                let recording = self.current;
                self.videos.sources.push(VideoSource { file: file.to_path_buf(), recording, begins_at_s });
                self.wanted_pane = Some(PanelId::VIDEO);
            }
        }
    }

    /// Takes the video of the shown recording away.
    pub fn forget_video(&mut self) {
        let current = self.current;
        self.videos.sources.retain(|s| s.recording != current);
        (self.videos.loose_s, self.videos.shown) = (None, None);
        self.jobs.cancel(VIDEO);
        self.videos.tidy();
    }

    /// The video of the shown recording; begins to read it where nobody has yet.
    pub fn video(&mut self, ctx: &egui::Context) -> State {
        let Some(file) = self.video_source().map(|s| s.file.clone()) else { return State::None };
        match self.videos.answer(&file) {
            Some(Ok(video)) => return State::There(Arc::clone(video)),
            Some(Err(problem)) => return State::Failed(problem.clone()),
            None if self.jobs.is_running(VIDEO) => return State::Reading,
            None => {}
        }
        let job = self.jobs.start(ctx, VIDEO, format!("Reading {}", name_of(&file)), move |ticket| {
            let watch = Watch { progress: &|share| ticket.tell(share), cancelled: ticket.cancelled() };
            let answer = match Video::read(&file, &watch) {
                Err(VideoError::Cancelled) => return no_change(),
                read => read.map(Arc::new).map_err(|error| sentence(&error.to_string())),
            };
            change(|session: &mut Self, _| session.video_was_read(file, answer))
        });
        job.if_given_up(|session: &mut Self, _| session.gave_up_video());
        State::Reading
    }

    /// Reads it and waits: for pictures without a window.
    pub(super) fn read_video_now(&mut self) {
        let Some(file) = self.video_source().map(|s| s.file.clone()) else { return };
        let watch = Watch { progress: &|_| {}, cancelled: &AtomicBool::new(false) };
        let answer = Video::read(&file, &watch).map(Arc::new).map_err(|e| sentence(&e.to_string()));
        self.video_was_read(file, answer);
        self.videos.at_once = true;
    }

    /// A cancelled one is asked for again by hand.
    pub(super) fn gave_up_video(&mut self) {
        if let Some(file) = self.video_source().map(|s| s.file.clone()) {
            self.video_was_read(file, Err(sentence(&VideoError::Cancelled.to_string())));
        }
    }

    /// Reads it again, after what was in the way is gone.
    pub fn read_video_again(&mut self) {
        if let Some(file) = self.video_source().map(|s| s.file.clone()) {
            self.videos.read.retain(|(known, _)| *known != file);
        }
    }

    pub(super) fn video_was_read(&mut self, file: PathBuf, answer: Result<Arc<Video>, String>) {
        self.videos.read.retain(|(known, _)| *known != file);
        self.videos.read.push((file, answer));
        self.videos.tidy();
    }

    /// The moment of the video that is shown, s from its beginning: that of the cursor, or where it is looked at by itself.
    pub fn video_time_s(&self) -> Option<f64> {
        let source = self.video_source()?;
        Some(self.videos.loose_s.unwrap_or(self.cursor_s - source.begins_at_s))
    }

    /// The picture number `index`, or the last one that was there while it is being decoded.
    pub fn video_picture(&mut self, ctx: &egui::Context, video: &Arc<Video>, index: usize) -> Option<TextureHandle> {
        let file = self.video_source()?.file.clone();
        let shown = self.videos.shown.as_ref().filter(|s| s.file == file);
        if shown.is_none_or(|s| s.index != index) && !self.jobs.is_running(PICTURE) {
            let (video, file) = (Arc::clone(video), file.clone());
            if self.videos.at_once {
                self.picture_came(ctx, (file, index), decoded(&video, index));
            } else {
                self.jobs.start(ctx, PICTURE, "", move |_| {
                    let picture = decoded(&video, index);
                    change(move |session: &mut Self, ctx| session.picture_came(ctx, (file, index), picture))
                });
            }
        }
        self.videos.shown.as_ref().filter(|s| s.file == file).and_then(|s| s.texture.clone())
    }

    pub(super) fn picture_came(
        &mut self,
        ctx: &egui::Context,
        (file, index): (PathBuf, usize),
        picture: Option<ColorImage>,
    ) {
        let old = self.videos.shown.take().filter(|s| s.file == file).and_then(|s| s.texture);
        let texture = picture.map(|picture| match old {
            Some(mut texture) => {
                texture.set(picture, TextureOptions::LINEAR);
                texture
            }
            None => ctx.load_texture("video", picture, TextureOptions::LINEAR),
        });
        self.videos.shown = Some(Shown { file, index, texture });
    }

    /// Where the video begins, on the recording's clock, s.
    pub fn shift_video(&mut self, begins_at_s: f64) {
        if let Some(source) = self.video_source_mut().filter(|_| begins_at_s.is_finite()) {
            source.begins_at_s = begins_at_s;
        }
    }

    /// Looks at the video by itself, or lets it run with the cursor again, where it was.
    pub fn loosen_video(&mut self, loose: bool) {
        self.videos.loose_s = self.video_time_s().filter(|_| loose);
    }

    /// The picture that is looked at was taken at the cursor.
    pub fn video_belongs_here(&mut self) {
        if let Some(loose_s) = self.videos.loose_s.take() {
            self.shift_video(self.cursor_s - loose_s);
        }
    }

    /// Shifts the video to where its pictures change when the recorded hand moves, in the background.
    pub fn align_video(&mut self, ctx: &egui::Context) {
        let (Some(prepared), Some(file)) = (self.prepared().cloned(), self.video_source().map(|s| s.file.clone()))
        else {
            return;
        };
        self.jobs.start(ctx, ALIGN_VIDEO, "Laying the video over the recording", move |ticket| {
            let found = match reading::motion(&file, ticket.cancelled()) {
                Ok((times, changes)) => begins_at(&prepared, &times, &changes),
                Err(VideoError::Cancelled) => return no_change(),
                Err(error) => Err(sentence(&error.to_string())),
            };
            change(move |session: &mut Self, _| session.video_aligned(&file, found))
        });
    }

    pub(super) fn video_aligned(&mut self, file: &Path, found: Result<f64, String>) {
        match found {
            Ok(begins_at_s) => {
                if self.video_source().is_some_and(|s| s.file == file) {
                    self.videos.loose_s = None;
                    self.shift_video(begins_at_s);
                }
            }
            Err(problem) => self.fail(problem),
        }
    }
}

fn decoded(video: &Video, index: usize) -> Option<ColorImage> {
    let picture = video.picture(index)?;
    Some(ColorImage::from_rgb([picture.width() as usize, picture.height() as usize], picture.as_raw()))
}

/// Where a video begins on the recording's clock, s, by what moves in both.
fn begins_at(prepared: &Prepared, times: &[f64], changes: &[f64]) -> Result<f64, String> {
    let nothing = "Nothing moves in the video when the recorded hand moves; look at the video by itself, find a moment that \
                   you recognise, put the cursor there, and press They belong together.";
    let speed =
        hand_speed(prepared).ok_or("This recording says nothing of how the hand moved; shift the video by hand.")?;
    let found = lag((&prepared.times, &speed), (times, changes)).filter(|l| l.likeness > LEAST_LIKENESS);
    found.map(|l| l.offset_s).ok_or_else(|| nothing.to_owned())
}

/// How fast whatever was recorded moved, in one unit or another; `None` without positions.
fn hand_speed(prepared: &Prepared) -> Option<Vec<f64>> {
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
