//! The video of the hand that belongs to a recording: reading it, its picture at the cursor, and where it lies in time.

use crate::text::file_name::name_of;
use crate::text::sentence::sentence;
use crate::ui::background::jobs::Jobs;
use crate::ui::background::jobs::no_change;
use crate::ui::document::state::Document;
use crate::ui::document::videos::{ALIGN_VIDEO, PICTURE, Shown, State, VIDEO, Videos, begins_at, decoded};
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel_id::PanelId;
use crate::video::reading;
use crate::video::reading::{Video, VideoError, VideoSource, Watch};
use egui::{ColorImage, TextureHandle, TextureOptions};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Video of the shown recording.
pub fn video_source(document: &Document) -> Option<&VideoSource> {
    document.videos.sources.iter().find(|s| s.recording == document.current)
}

fn video_source_mut(document: &mut Document) -> Option<&mut VideoSource> {
    let current = document.current;
    document.videos.sources.iter_mut().find(|s| s.recording == current)
}

/// A video for the shown recording, in the place of the one it has.
pub fn open_video(
    document: &mut Document,
    wanted_pane: &mut Option<PanelId>,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
    file: &Path,
) {
    match document.prepared() {
        None => messages.fail("A video belongs to a recording: open the log first, then the video."),
        Some(prepared) if prepared.clockless() => {
            messages.fail("This recording has no clock, so no video can run beside it; state its rate in the sidecar.");
        }
        Some(_) => {
            let begins_at_s = document.prepared().map_or(0.0, |p| p.span().0);
            forget_video(document, jobs);
            let recording = document.current;
            document.videos.sources.push(VideoSource { file: file.to_path_buf(), recording, begins_at_s });
            *wanted_pane = Some(PanelId::VIDEO);
        }
    }
}

/// Takes the video of the shown recording away.
pub fn forget_video(document: &mut Document, jobs: &mut Jobs<Session>) {
    let current = document.current;
    document.videos.sources.retain(|s| s.recording != current);
    (document.videos.loose_s, document.videos.shown) = (None, None);
    jobs.cancel(VIDEO);
    document.videos.tidy();
}

/// The video of the shown recording; begins to read it where nobody has yet.
pub fn video(document: &Document, jobs: &mut Jobs<Session>, ctx: &egui::Context) -> State {
    let Some(file) = video_source(document).map(|s| s.file.clone()) else { return State::None };
    match document.videos.answer(&file) {
        Some(Ok(video)) => return State::There(Arc::clone(video)),
        Some(Err(problem)) => return State::Failed(problem.clone()),
        None if jobs.is_running(VIDEO) => return State::Reading,
        None => {}
    }
    let job = jobs.start(ctx, VIDEO, format!("Reading {}", name_of(&file)), move |ticket| {
        let watch = Watch { progress: &|share| ticket.tell(share), cancelled: ticket.cancelled() };
        let answer = match Video::read(&file, &watch) {
            Err(VideoError::Cancelled) => return no_change(),
            read => read.map(Arc::new).map_err(|error| sentence(&error.to_string())),
        };
        change(|session, _| video_was_read(&mut session.document.videos, file, answer))
    });
    job.if_given_up(|session, _| gave_up_video(&mut session.document));
    State::Reading
}

/// Reads it and waits: for pictures without a window.
pub(crate) fn read_video_now(document: &mut Document) {
    let Some(file) = video_source(document).map(|s| s.file.clone()) else { return };
    let watch = Watch { progress: &|_| {}, cancelled: &AtomicBool::new(false) };
    let answer = Video::read(&file, &watch).map(Arc::new).map_err(|e| sentence(&e.to_string()));
    video_was_read(&mut document.videos, file, answer);
    document.videos.at_once = true;
}

/// A cancelled one is asked for again by hand.
pub(crate) fn gave_up_video(document: &mut Document) {
    if let Some(file) = video_source(document).map(|s| s.file.clone()) {
        video_was_read(&mut document.videos, file, Err(sentence(&VideoError::Cancelled.to_string())));
    }
}

/// Reads it again, after what was in the way is gone.
pub fn read_video_again(document: &mut Document) {
    if let Some(file) = video_source(document).map(|s| s.file.clone()) {
        document.videos.read.retain(|(known, _)| *known != file);
    }
}

pub(crate) fn video_was_read(videos: &mut Videos, file: PathBuf, answer: Result<Arc<Video>, String>) {
    videos.read.retain(|(known, _)| *known != file);
    videos.read.push((file, answer));
    videos.tidy();
}

/// The moment of the video that is shown, s from its beginning: that of the cursor, or where it is looked at by itself.
pub fn video_time_s(document: &Document) -> Option<f64> {
    let source = video_source(document)?;
    Some(document.videos.loose_s.unwrap_or(document.cursor_s - source.begins_at_s))
}

/// The picture number `index`, or the last one that was there while it is being decoded.
pub fn video_picture(
    document: &mut Document,
    jobs: &mut Jobs<Session>,
    ctx: &egui::Context,
    video: &Arc<Video>,
    index: usize,
) -> Option<TextureHandle> {
    let file = video_source(document)?.file.clone();
    let shown = document.videos.shown.as_ref().filter(|s| s.file == file);
    if shown.is_none_or(|s| s.index != index) && !jobs.is_running(PICTURE) {
        let (video, file) = (Arc::clone(video), file.clone());
        if document.videos.at_once {
            picture_came(&mut document.videos, ctx, (file, index), decoded(&video, index));
        } else {
            jobs.start(ctx, PICTURE, "", move |_| {
                let picture = decoded(&video, index);
                change(move |session, ctx| picture_came(&mut session.document.videos, ctx, (file, index), picture))
            });
        }
    }
    document.videos.shown.as_ref().filter(|s| s.file == file).and_then(|s| s.texture.clone())
}

pub(crate) fn picture_came(
    videos: &mut Videos,
    ctx: &egui::Context,
    (file, index): (PathBuf, usize),
    picture: Option<ColorImage>,
) {
    let old = videos.shown.take().filter(|s| s.file == file).and_then(|s| s.texture);
    let texture = picture.map(|picture| match old {
        Some(mut texture) => {
            texture.set(picture, TextureOptions::LINEAR);
            texture
        }
        None => ctx.load_texture("video", picture, TextureOptions::LINEAR),
    });
    videos.shown = Some(Shown { file, index, texture });
}

/// Sets the time at which the video begins, on the recording's clock, s.
pub fn shift_video(document: &mut Document, begins_at_s: f64) {
    if let Some(source) = video_source_mut(document).filter(|_| begins_at_s.is_finite()) {
        source.begins_at_s = begins_at_s;
    }
}

/// Looks at the video by itself, or lets it run with the cursor again, where it was.
pub fn loosen_video(document: &mut Document, loose: bool) {
    document.videos.loose_s = video_time_s(document).filter(|_| loose);
}

/// The picture that is looked at was taken at the cursor.
pub fn video_belongs_here(document: &mut Document) {
    if let Some(loose_s) = document.videos.loose_s.take() {
        shift_video(document, document.cursor_s - loose_s);
    }
}

/// Shifts the video to where its pictures change when the recorded hand moves, in the background.
pub fn align_video(document: &Document, jobs: &mut Jobs<Session>, ctx: &egui::Context) {
    let (Some(prepared), Some(file)) = (document.prepared().cloned(), video_source(document).map(|s| s.file.clone()))
    else {
        return;
    };
    jobs.start(ctx, ALIGN_VIDEO, "Laying the video over the recording", move |ticket| {
        let found = match reading::motion(&file, ticket.cancelled()) {
            Ok((times, changes)) => begins_at(&prepared, &times, &changes),
            Err(VideoError::Cancelled) => return no_change(),
            Err(error) => Err(sentence(&error.to_string())),
        };
        change(move |session, _| video_aligned(&mut session.document, &mut session.messages, &file, found))
    });
}

pub(crate) fn video_aligned(document: &mut Document, messages: &mut Messages, file: &Path, found: Result<f64, String>) {
    match found {
        Ok(begins_at_s) => {
            if video_source(document).is_some_and(|s| s.file == file) {
                document.videos.loose_s = None;
                shift_video(document, begins_at_s);
            }
        }
        Err(problem) => messages.fail(problem),
    }
}
