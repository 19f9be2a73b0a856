//! The window's part of recording: the card beside the trainer, what becomes of a recording that ended, and recordings that a killed
//! program left behind.

use crate::recorder::{Status, folder};
use crate::text::file_name::name_of;
use crate::text::format;
use crate::ui::background::jobs::{JobKind, Jobs};
use crate::ui::document::file_kind::LOAD;
use crate::ui::document::files::saved;
use crate::ui::document::opening;
use crate::ui::document::state::Document;
use crate::ui::kit::icons::Icon;
use crate::ui::kit::theme;
use crate::ui::kit::widgets::{primary_button, recording_light, remark};
use crate::ui::session::{Session, change};
use crate::ui::shell::message_list::{Messages, Tone};
use crate::ui::shell::messages;
use crate::ui::train::trainer::live::Trainer;
use egui::Ui;
use std::path::Path;

/// Waiting for the end of a recording.
pub const RECORD: JobKind = JobKind::new("record").writes();
/// Looking for recordings that a killed program left behind.
const RECOVER: JobKind = JobKind::new("recover");

/// The card beside the trainer's picture.
pub fn controls(
    ui: &mut Ui,
    document: &mut Document,
    trainer: &mut Trainer,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
) {
    let Some(status) = trainer.recording_status() else {
        ui.label(theme::caption(ui, "Keeps every tick, to measure the objects from."));
        if primary_button(ui, true, (Icon::Record, "Record")).on_hover_text(whereto(trainer)).clicked() {
            start(trainer, messages);
        }
        return;
    };
    ui.horizontal(|ui| {
        recording_light(ui);
        ui.label(theme::strong(format::clock(status.length_s)));
        let files = if status.files > 1 { format!(" in {} files", status.files) } else { String::new() };
        let size = ui.label(theme::caption(ui, format!("every tick is kept · {}{files}", megabytes(status.bytes))));
        if let Some(path) = &status.path {
            size.on_hover_text(path.display().to_string());
        }
    });
    if let Some(text) = losses(&status) {
        remark(ui, Icon::Doubt, text);
    }
    ui.horizontal(|ui| {
        if primary_button(ui, true, (Icon::Stop, "Stop and calibrate")).clicked() {
            let ctx = ui.ctx().clone();
            stop_and_open(&ctx, document, trainer, messages, jobs);
        }
        if ui.button((Icon::Remove, "Discard")).on_hover_text("Ends the recording and removes its file").clicked() {
            trainer.discard_recording();
        }
    });
}

fn whereto(trainer: &Trainer) -> String {
    let folder = trainer.recordings_folder.clone().or_else(folder::of_user);
    folder.map_or_else(|| "R".to_owned(), |folder| format!("R\nGoes to {}", folder.display()))
}

/// Samples that the file lacks, in one sentence; `None` if it is complete.
fn losses(status: &Status) -> Option<String> {
    match (status.dropped, status.left_out) {
        (0, 0) => None,
        (0, n) => Some(format!("{n} ticks were left out: they held no number, or time stood still.")),
        (n, _) => Some(format!("{n} ticks were lost: the disk did not keep up.")),
    }
}

fn megabytes(bytes: u64) -> String {
    let megabytes = bytes as f64 * 1e-6;
    if megabytes < 1e3 {
        format!("{} MB", format::number(megabytes, 1))
    } else {
        format!("{} GB", format::number(1e-3 * megabytes, 2))
    }
}

/// Begins to record; what is in the way is said.
pub fn start(trainer: &mut Trainer, messages: &mut Messages) {
    if let Err(problem) = trainer.start_recording() {
        messages.fail(problem);
    }
}

/// Ends the recording and opens it as a log, all in the background.
pub fn stop_and_open(
    ctx: &egui::Context,
    document: &mut Document,
    trainer: &mut Trainer,
    messages: &mut Messages,
    jobs: &mut Jobs<Session>,
) {
    let status = trainer.recording_status().unwrap_or_default();
    let Some(stopping) = trainer.stop_recording() else { return };
    if status.files > 1 {
        messages.say(Tone::Done, format!("The recording has {} files; the newest one is opened.", status.files));
    }
    // A sidecar that was named for another log is not for this one.
    document.meta = None;
    document.path_field = status.path.map(|path| path.display().to_string()).unwrap_or_default();
    jobs.start(ctx, LOAD, "Reading the recording", move |ticket| opening::read(stopping.wait()?.path, None, ticket));
}

/// Recordings that ended without being asked to are told; call once a frame.
pub fn follow(ctx: &egui::Context, trainer: &mut Trainer, jobs: &mut Jobs<Session>) {
    while let Some(stopping) = trainer.take_ended_recording() {
        jobs.start(ctx, RECORD, "", move |_| saved(stopping.wait()?.path));
    }
}

/// Looks for recordings that a killed program left behind, in the background.
pub fn look_for_unfinished(ctx: &egui::Context, trainer: &Trainer, jobs: &mut Jobs<Session>) {
    let Some(folder) = trainer.recordings_folder.clone().or_else(folder::of_user) else { return };
    jobs.start(ctx, RECOVER, "", move |_| {
        let unfinished = folder::unfinished(&folder);
        change(|session, _| session.document.unfinished = unfinished)
    });
}

/// Above the workspace: a recording that has no end, with the way to open it.
pub fn unfinished(ui: &mut Ui, document: &mut Document, jobs: &mut Jobs<Session>) {
    let count = document.unfinished.len();
    let path = document.unfinished.first().cloned().unwrap_or_default();
    let (mut open, mut dismiss) = (false, false);
    messages::strip(ui, "unfinished recordings", count.min(1), |ui| {
        messages::message(ui, Tone::Error, &said(&path, count), |ui| {
            dismiss = ui.small_button("Dismiss").on_hover_text("The file stays where it is").clicked();
            open = ui.small_button("Open").on_hover_text(path.display().to_string()).clicked();
        });
    });
    if open || dismiss {
        document.unfinished.remove(0);
        folder::forget(&path);
    }
    if open {
        let ctx = ui.ctx().clone();
        opening::open_with(document, jobs, &ctx, &path, None);
    }
}

fn said(path: &Path, count: usize) -> String {
    let others = if count > 1 { format!(" ({count} such recordings)") } else { String::new() };
    let name = name_of(path);
    format!("The program ended while it recorded {name}; the recording opens up to its last second.{others}")
}
