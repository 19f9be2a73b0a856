//! What the window knows: loaded recordings, their fit, the replay, the time cursor. Panels read and change it; jobs fill it.

use super::comfort::Comfort;
use crate::ui::diagnosis_state::Diagnosing;
use crate::ui::experiments::Experiments;
use crate::ui::fit_choice::FitChoice;
use crate::ui::scene::layers::SceneLayers;

use super::jobs::{JobKind, Jobs};
use super::prepare::Prepared;
use super::project::Source;
use super::recent::Recent;
use super::replayed::Replayed;
use super::rules::Rules;
use crate::ui::file_kind::LOAD;
use crate::ui::lessons::state::Lessons;
use crate::ui::mapping::state::Mapping;
use crate::ui::plots::choices::PlotChoices;
use crate::ui::refits::Refits;

use super::undo::Undo;
use super::what_if::WhatIf;
use super::workspace::Workspace;
use crate::tasks::Chosen;
use crate::ui::trainer::live::Trainer;
use crate::ui::videos::Videos;
use estimator::online::enough::Enough;
use estimator::pipeline::Analysis;
use estimator::segment::Segmentation;
use haptics::world::World;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// How grave a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// Something did not work.
    Error,
    /// Something was done.
    Done,
}

/// A message above the workspace.
#[derive(Clone, Debug, PartialEq)]
pub struct Banner {
    /// How grave.
    pub tone: Tone,
    /// One sentence.
    pub text: String,
    /// More about it, for those who point at it.
    pub hint: String,
    /// When it goes by itself; `None`: when it is dismissed.
    pub until: Option<Instant>,
}

/// How long one reads that something was done.
const DONE_LASTS: Duration = Duration::from_secs(6);

/// Everything that is shared between panels.
#[derive(Default)]
pub struct Session {
    /// What makes training comfortable.
    pub comfort: Comfort,
    /// The open workspace.
    pub workspace: Workspace,
    /// Loaded recordings.
    pub recordings: Vec<Arc<Prepared>>,
    /// The one that is shown.
    pub current: usize,
    /// Where they came from.
    pub path: Option<PathBuf>,
    /// The files that the recordings came from.
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
    /// The live world.
    pub trainer: Trainer,
    /// The path field.
    pub path_field: String,
    /// How to fit.
    pub choice: FitChoice,
    /// The choice that the fit on the screen was made with differs from `choice`.
    pub stale: bool,
    /// What refits have in common.
    pub refits: Refits,
    /// What can be taken back.
    pub undo: Undo,
    /// The parameter that is looked at closely, `object.name`.
    pub selected_parameter: Option<String>,
    /// How the force depends on the parameters.
    pub sensitivity: Option<Arc<super::sensitivity::Sensitivity>>,
    /// Values that are tried.
    pub what_if: WhatIf,
    /// The fit.
    pub analysis: Option<Arc<Analysis>>,
    /// Why there is none, in one sentence.
    pub fit_problem: Option<String>,
    /// The replay through the fitted world, by recording.
    pub replays: Vec<Option<Replayed>>,
    /// What the model gets wrong.
    pub diagnosing: Diagnosing,
    /// Who practises, and how they get better.
    pub learning: super::learning::Learning,
    /// Experiments that would tell it better.
    pub experiments: Experiments,
    /// Where the trainer's picture was drawn last.
    pub trainer_place: Option<crate::ui::scene::view::Place>,
    /// What the assistant shows over the trainer's picture.
    pub assistant: crate::ui::assistant::state::Assistant,
    /// Lessons.
    pub lessons: Lessons,
    /// What is still missing for the parameters of the fit.
    pub enough: Vec<Enough>,
    /// The time that is looked at.
    pub cursor_s: f64,
    /// The part of the recording that plots show.
    pub view_s: (f64, f64),
    /// Whether the cursor runs.
    pub playing: bool,
    /// Playback speed, times real time.
    pub speed: f64,
    /// What the plots show.
    pub plots: PlotChoices,
    /// Videos of the hand.
    pub videos: Videos,
    /// Set where something appears in a panel that may not stand in the window.
    pub wanted_pane: Option<super::panel_id::PanelId>,
    /// What the 3-D view shows.
    pub layers: SceneLayers,
    /// Messages.
    pub banners: Vec<Banner>,
    /// Background work.
    pub jobs: Jobs<Session>,
    /// A world that was opened from a file, for the trainer to take.
    pub opened_world: Option<Box<World>>,
    /// Set by a panel: the trainer should take the calibrated world.
    pub train_calibrated: bool,
    /// Recordings that a killed program left without their end.
    pub unfinished: Vec<PathBuf>,
    /// The open editor of a task's rules.
    pub rules: Option<Box<Rules>>,
    /// The open mapping dialog.
    pub mapping: Option<Box<Mapping>>,
}

impl Session {
    /// An empty session.
    pub fn new() -> Self {
        Self { speed: 1.0, view_s: (0.0, 1.0), ..Self::default() }
    }

    /// The recording that is shown.
    pub fn prepared(&self) -> Option<&Arc<Prepared>> {
        self.recordings.get(self.current)
    }

    /// Its segmentation.
    pub fn segmentation(&self) -> Option<&Segmentation> {
        self.analysis.as_ref()?.segmentations.get(self.current)?.as_ref()
    }

    /// Its replay through the world with what the diagnosis found.
    pub fn extended_replay(&self) -> Option<&Replayed> {
        self.diagnosing.replays.get(self.current)?.as_ref()
    }

    /// Its replay through the fitted world.
    pub fn replay(&self) -> Option<&Replayed> {
        self.replays.get(self.current)?.as_ref()
    }

    /// Adds an error.
    pub fn fail(&mut self, text: impl Into<String>) {
        self.say(Tone::Error, text.into());
    }

    /// Adds a message; the same one is not shown twice.
    pub fn say(&mut self, tone: Tone, text: String) {
        let until = (tone == Tone::Done).then(|| Instant::now() + DONE_LASTS);
        match self.banners.iter_mut().find(|banner| banner.tone == tone && banner.text == text) {
            Some(banner) => banner.until = until,
            None => self.banners.push(Banner { tone, text, hint: String::new(), until }),
        }
    }

    /// Says where something was written: the name, and the whole path for those who point at it.
    pub fn say_saved(&mut self, path: &std::path::Path) {
        let text = format!("Saved {}.", crate::text::file_name::name_of(path));
        self.say(Tone::Done, text.clone());
        if let Some(banner) = self.banners.iter_mut().find(|b| b.text == text) {
            banner.hint = path.display().to_string();
        }
    }

    /// Shows prepared recordings from the start.
    pub fn show(&mut self, recordings: Vec<Arc<Prepared>>) {
        self.recordings = recordings;
        self.replays.clear();
        self.enough.clear();
        self.analysis = None;
        self.fit_problem = None;
        self.diagnosing.forget();
        self.jobs.cancel_after(LOAD);
        self.plots.forget_recordings();
        self.playing = false;
        self.rules = None;
        self.choice = FitChoice {
            task: self.task_hint.as_ref().map(Chosen::like),
            own: self.task_hint.as_ref().and_then(Chosen::own).cloned().map(Arc::new),
            method: self.choice.method,
            ..FitChoice::default()
        };
        self.refits.forget();
        self.what_if.forget();
        self.videos = Videos::default();
        self.forget_changes();
        self.select(0);
    }

    /// True when the fitted world has something that the hand can touch.
    pub fn can_train(&self) -> bool {
        self.analysis.as_ref().is_some_and(|a| !a.world.blocks.is_empty() || a.world.crank.is_some())
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

    /// Ends a job that the user does not want to wait for; everything from before stays.
    pub fn give_up(&mut self, ctx: &egui::Context, kind: JobKind) {
        if let Some(change) = self.jobs.give_up(kind) {
            change(self, ctx);
        }
    }
}
