//! At the start: what a killed program had open is offered; layout and recent files come back by themselves.

use crate::text::file_name::name_of;
use crate::ui::document::autosave::Autosave;
use crate::ui::document::project_files;
use crate::ui::shell::app::App;
use crate::ui::shell::message_list::Tone;
use crate::ui::shell::messages;
use egui::Ui;
use std::path::Path;

impl App {
    /// Keeps what is open in a folder, and takes up what the last window left there. `fresh`: nothing was named to be opened.
    pub fn keep(&mut self, folder: &Path, fresh: bool) {
        let Some((autosave, before)) = Autosave::begin(folder) else { return };
        self.dock = before.dock.clone();
        self.session.document.recent = before.recent.clone();
        self.session.training.assistant = before.assistant;
        self.session.training.comfort = before.comfort;
        self.tour.seen = before.toured;
        self.autosave = Some(autosave);
        if !before.ended && !before.project.recordings.is_empty() {
            self.left_behind = Some(Box::new(before));
        } else if fresh && !before.toured {
            self.tour.begin();
        }
    }
}

/// Above the workspace: what a killed program had open, with the way back to it.
pub fn offer(ui: &mut Ui, app: &mut App) {
    let Some(state) = &app.left_behind else {
        messages::strip(ui, "left behind", 0, |_| {});
        return;
    };
    let logs = &state.project.recordings;
    let first = logs.first().map(|s| name_of(&s.log)).unwrap_or_default();
    let others = if logs.len() > 1 { format!(" and {} more", logs.len() - 1) } else { String::new() };
    let text = format!("The program ended unexpectedly while {first}{others} was open, with your changes.");
    let (mut again, mut dismiss) = (false, false);
    messages::strip(ui, "left behind", 1, |ui| {
        messages::message(ui, Tone::Done, &text, |ui| {
            dismiss = ui.small_button("Dismiss").clicked();
            again = ui.small_button("Go on there").clicked();
        });
    });
    if !again && !dismiss {
        return;
    }
    if let Some(state) = app.left_behind.take().filter(|_| again) {
        let ctx = ui.ctx().clone();
        app.session.document.opening_project = state.project_path;
        project_files::restore(&mut app.session.messages, &mut app.session.jobs, &ctx, state.project);
    }
}
