//! Data of the window: recordings, their fit, the replay, the time cursor. Panels read and change it; jobs fill it.

use crate::ui::diagnose::experiment_state::Experiments;
use crate::ui::diagnose::state::Diagnosing;
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::scene::layers::SceneLayers;

use crate::ui::background::jobs::{Answer, JobKind, Jobs};
use crate::ui::column_mapping::state::Mapping;
use crate::ui::document::file_kind::LOAD;
use crate::ui::document::prepared::Prepared;
use crate::ui::plots::choices::PlotChoices;

use crate::tasks::Chosen;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::state::Document;
use crate::ui::document::undo::Undo;
use crate::ui::document::videos::Videos;
use crate::ui::shell::message_list::Messages;
use crate::ui::shell::panel_id::PanelId;
use crate::ui::shell::workspace::Workspace;
use crate::ui::train::state::Training;
use std::sync::Arc;

/// Everything that is shared between panels.
#[derive(Default)]
pub struct Session {
    /// The open workspace.
    pub workspace: Workspace,
    /// The open recordings.
    pub document: Document,
    /// Their fit.
    pub calibration: Calibration,
    /// Their diagnosis.
    pub diagnosing: Diagnosing,
    /// Experiments that the diagnosis asks for.
    pub experiments: Experiments,
    /// The live world.
    pub training: Training,
    /// The choices of the plots.
    pub plots: PlotChoices,
    /// The layers of the 3-D view.
    pub layers: SceneLayers,
    /// The open mapping dialog.
    pub mapping: Option<Box<Mapping>>,
    /// A panel to be brought in, because something appears in it.
    pub wanted_pane: Option<PanelId>,
    /// Messages.
    pub messages: Messages,
    /// Background work.
    pub jobs: Jobs<Session>,
}

impl Session {
    /// An empty session.
    pub fn new() -> Self {
        let document = Document { speed: 1.0, view_s: (0.0, 1.0), ..Document::default() };
        Self { document, ..Self::default() }
    }

    /// Shows prepared recordings from the start.
    pub fn show(&mut self, recordings: Vec<Arc<Prepared>>) {
        let document = &mut self.document;
        document.recordings = recordings;
        document.playing = false;
        (document.videos, document.undo) = (Videos::default(), Undo::default());
        document.select(0);
        self.calibration.forget();
        let hint = document.task_hint.as_ref();
        self.calibration.choice = FitChoice {
            task: hint.map(Chosen::like),
            own: hint.and_then(Chosen::own).cloned().map(Arc::new),
            method: self.calibration.choice.method,
            ..FitChoice::default()
        };
        self.diagnosing.forget();
        self.plots.forget_recordings();
        self.jobs.cancel_after(LOAD);
    }

    /// Ends a job that the user does not want to wait for; everything from before stays.
    pub fn give_up(&mut self, ctx: &egui::Context, kind: JobKind) {
        if let Some(change) = self.jobs.give_up(kind) {
            change(self, ctx);
        }
    }
}

/// A change of the session as the answer of a job.
pub fn change(change: impl FnOnce(&mut Session, &egui::Context) + Send + 'static) -> Answer<Session> {
    crate::ui::background::jobs::change(change)
}
