//! The video of the hand that belongs to a recording: reading it, its picture at the cursor, and where it lies in time.

use super::jobs::{change, no_change};
use super::panel_id::PanelId;
use super::session::Session;
use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::videos::{ALIGN_VIDEO, PICTURE, Shown, State, VIDEO, begins_at, decoded};
use crate::video::reading;
use crate::video::reading::{Video, VideoError, VideoSource, Watch};
use egui::{ColorImage, TextureHandle, TextureOptions};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

impl Session {
    /// Which video the shown recording has.
    pub fn video_source(&self) -> Option<&VideoSource> {
        self.document.videos.sources.iter().find(|s| s.recording == self.document.current)
    }

    fn video_source_mut(&mut self) -> Option<&mut VideoSource> {
        let current = self.document.current;
        self.document.videos.sources.iter_mut().find(|s| s.recording == current)
    }

    /// A video for the shown recording, in the place of the one it has.
    pub fn open_video(&mut self, file: &Path) {
        match self.document.prepared() {
            None => self.messages.fail("A video belongs to a recording: open the log first, then the video."),
            Some(prepared) if prepared.clockless() => {
                self.messages
                    .fail("This recording has no clock, so no video can run beside it; state its rate in the sidecar.");
            }
            Some(_) => {
                let begins_at_s = self.document.prepared().map_or(0.0, |p| p.span().0);
                self.forget_video();
                let recording = self.document.current;
                self.document.videos.sources.push(VideoSource { file: file.to_path_buf(), recording, begins_at_s });
                self.wanted_pane = Some(PanelId::VIDEO);
            }
        }
    }

    /// Takes the video of the shown recording away.
    pub fn forget_video(&mut self) {
        let current = self.document.current;
        self.document.videos.sources.retain(|s| s.recording != current);
        (self.document.videos.loose_s, self.document.videos.shown) = (None, None);
        self.jobs.cancel(VIDEO);
        self.document.videos.tidy();
    }

    /// The video of the shown recording; begins to read it where nobody has yet.
    pub fn video(&mut self, ctx: &egui::Context) -> State {
        let Some(file) = self.video_source().map(|s| s.file.clone()) else { return State::None };
        match self.document.videos.answer(&file) {
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
        self.document.videos.at_once = true;
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
            self.document.videos.read.retain(|(known, _)| *known != file);
        }
    }

    pub(super) fn video_was_read(&mut self, file: PathBuf, answer: Result<Arc<Video>, String>) {
        self.document.videos.read.retain(|(known, _)| *known != file);
        self.document.videos.read.push((file, answer));
        self.document.videos.tidy();
    }

    /// The moment of the video that is shown, s from its beginning: that of the cursor, or where it is looked at by itself.
    pub fn video_time_s(&self) -> Option<f64> {
        let source = self.video_source()?;
        Some(self.document.videos.loose_s.unwrap_or(self.document.cursor_s - source.begins_at_s))
    }

    /// The picture number `index`, or the last one that was there while it is being decoded.
    pub fn video_picture(&mut self, ctx: &egui::Context, video: &Arc<Video>, index: usize) -> Option<TextureHandle> {
        let file = self.video_source()?.file.clone();
        let shown = self.document.videos.shown.as_ref().filter(|s| s.file == file);
        if shown.is_none_or(|s| s.index != index) && !self.jobs.is_running(PICTURE) {
            let (video, file) = (Arc::clone(video), file.clone());
            if self.document.videos.at_once {
                self.picture_came(ctx, (file, index), decoded(&video, index));
            } else {
                self.jobs.start(ctx, PICTURE, "", move |_| {
                    let picture = decoded(&video, index);
                    change(move |session: &mut Self, ctx| session.picture_came(ctx, (file, index), picture))
                });
            }
        }
        self.document.videos.shown.as_ref().filter(|s| s.file == file).and_then(|s| s.texture.clone())
    }

    pub(super) fn picture_came(
        &mut self,
        ctx: &egui::Context,
        (file, index): (PathBuf, usize),
        picture: Option<ColorImage>,
    ) {
        let old = self.document.videos.shown.take().filter(|s| s.file == file).and_then(|s| s.texture);
        let texture = picture.map(|picture| match old {
            Some(mut texture) => {
                texture.set(picture, TextureOptions::LINEAR);
                texture
            }
            None => ctx.load_texture("video", picture, TextureOptions::LINEAR),
        });
        self.document.videos.shown = Some(Shown { file, index, texture });
    }

    /// Where the video begins, on the recording's clock, s.
    pub fn shift_video(&mut self, begins_at_s: f64) {
        if let Some(source) = self.video_source_mut().filter(|_| begins_at_s.is_finite()) {
            source.begins_at_s = begins_at_s;
        }
    }

    /// Looks at the video by itself, or lets it run with the cursor again, where it was.
    pub fn loosen_video(&mut self, loose: bool) {
        self.document.videos.loose_s = self.video_time_s().filter(|_| loose);
    }

    /// The picture that is looked at was taken at the cursor.
    pub fn video_belongs_here(&mut self) {
        if let Some(loose_s) = self.document.videos.loose_s.take() {
            self.shift_video(self.document.cursor_s - loose_s);
        }
    }

    /// Shifts the video to where its pictures change when the recorded hand moves, in the background.
    pub fn align_video(&mut self, ctx: &egui::Context) {
        let (Some(prepared), Some(file)) =
            (self.document.prepared().cloned(), self.video_source().map(|s| s.file.clone()))
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
                    self.document.videos.loose_s = None;
                    self.shift_video(begins_at_s);
                }
            }
            Err(problem) => self.messages.fail(problem),
        }
    }
}
