//! What the window knows: loaded recordings, their fit, the replay, the time cursor. Panels read and change it; jobs fill it.

use super::checking::On;
use super::comfort::Comfort;
use super::diagnosing::Diagnosing;
use super::experimenting::Experiments;
pub use super::fit_choice::FitChoice;
use super::fitting::Refits;
use super::icons::Icon;
use super::jobs::{JobKind, Jobs, Outcome, Replayed};
use super::lessons::Lessons;
use super::mapping::Mapping;
use super::plots::PlotChoices;
use super::prepare::Prepared;
use super::project::Source;
use super::recent::Recent;
use super::rules::Rules;
pub use super::scene::SceneLayers;
use super::trainer::Trainer;
use super::undo::Undo;
use super::video::Videos;
use super::what_if::WhatIf;
use crate::tasks::Chosen;
use estimator::online::enough::Enough;
use estimator::pipeline::Analysis;
use estimator::segment::Segmentation;
use haptics::world::World;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The workspaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Workspace {
    /// Touch a virtual world.
    #[default]
    Train,
    /// Measure a real one.
    Calibrate,
    /// What the model gets wrong about it.
    Diagnose,
    /// What moves the fingers, and how well.
    Devices,
}

impl Workspace {
    /// All of them: icon and name, and what it is for.
    pub const CHOICES: [(Self, (Icon, &str), &str); 4] = [
        (Self::Train, (Icon::Touch, "Train"), "Touch a virtual world (Ctrl+1)"),
        (Self::Calibrate, (Icon::Calibrate, "Calibrate"), "Measure a real one from a log (Ctrl+2)"),
        (Self::Diagnose, (Icon::Diagnose, "Diagnose"), "What the model gets wrong, and why (Ctrl+3)"),
        (Self::Devices, (Icon::Device, "Devices"), "What moves the fingers, and how well (Ctrl+4)"),
    ];

    /// For people.
    pub fn title(self) -> &'static str {
        self.face().1
    }

    /// For people who look.
    pub fn icon(self) -> Icon {
        self.face().0
    }

    fn face(self) -> (Icon, &'static str) {
        Self::CHOICES.iter().find(|(w, ..)| *w == self).map_or((Icon::Panel, ""), |(_, face, _)| *face)
    }
}

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
    pub trainer_place: Option<super::scene::Place>,
    /// What the assistant shows over the trainer's picture.
    pub assistant: super::assistant::Assistant,
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
    pub wanted_pane: Option<super::dock::Pane>,
    /// What the 3-D view shows.
    pub layers: SceneLayers,
    /// Messages.
    pub banners: Vec<Banner>,
    /// Background work.
    pub jobs: Jobs,
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

    /// Reads the same log again.
    pub fn reload(&mut self, ctx: &egui::Context) {
        match self.path.clone() {
            Some(_) if self.sources.len() > 1 => self.restore(ctx, super::project::Project::of(self)),
            Some(path) => self.open(ctx, &path),
            None => self.fail("There is no file to reload: open a log first."),
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
        self.jobs.cancel(JobKind::Diagnose);
        self.jobs.cancel(JobKind::Extend);
        self.jobs.cancel(JobKind::SimulateExtended);
        self.jobs.cancel(JobKind::Rehearse);
        self.jobs.cancel(JobKind::Check);
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
        self.jobs.cancel(JobKind::Video);
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

    /// Ends a job that the user does not want to wait for; what was there before stays.
    pub fn give_up(&mut self, kind: JobKind) {
        self.jobs.cancel(kind);
        if kind == JobKind::Fit && self.analysis.is_none() {
            self.fit_problem = Some("The fit was cancelled; press Fit to start it again.".to_owned());
        }
        if kind == JobKind::Video {
            self.gave_up_video();
        }
        if kind == JobKind::Curves {
            self.plots.give_up();
        }
        if kind == JobKind::Fit {
            self.refits.gave_up();
            self.stale = true;
        }
        if kind == JobKind::Diagnose {
            self.diagnosing.problem = Some("The diagnosis was cancelled before it came to an answer.".to_owned());
        }
    }

    /// Takes in what the jobs bring; call once a frame.
    pub fn poll(&mut self, ctx: &egui::Context) {
        for outcome in self.jobs.poll() {
            self.take(ctx, outcome);
        }
        super::recorder::follow(ctx, self);
        self.follow_experiment(ctx);
        self.follow_history();
        self.follow_lesson(ctx);
        let (now_s, held) = ctx.input(|i| (i.time, i.pointer.any_down()));
        self.note_changes(now_s, held);
        self.follow_choice(ctx);
        self.follow_what_if(ctx);
    }

    fn take(&mut self, ctx: &egui::Context, outcome: Outcome) {
        match outcome {
            Outcome::Loaded(path, recordings) => {
                let mute = super::opening::says_nothing(&recordings);
                self.recent.note(&path);
                self.path_field.clear();
                self.sources = vec![Source { log: path.clone(), meta: self.meta.clone() }];
                self.project_path = None;
                let again = self.path.as_ref() == Some(&path) && recordings.len() == self.recordings.len();
                let videos = std::mem::take(&mut self.videos);
                self.workspace = Workspace::Calibrate;
                self.show(recordings);
                self.videos = videos;
                if !again {
                    self.videos.of_log(&path, &self.recordings);
                }
                self.path = Some(path);
                match mute {
                    Some(why) => self.map_columns(ctx, Some(why)),
                    None => self.refit(ctx),
                }
            }
            Outcome::Project(project, recordings) => {
                self.opened_project(ctx, *project, recordings);
                self.ask_again(ctx);
            }
            Outcome::Unmapped(path, why) => {
                self.path_field = path.display().to_string();
                self.map_columns_of(ctx, &path, Some(why));
            }
            Outcome::Looked(looked) => self.mapping = Some(Box::new((*looked).into())),
            Outcome::Previewed(seen) => {
                if let Some(mapping) = &mut self.mapping {
                    mapping.preview.seen = Some(*seen);
                }
            }
            Outcome::Mapped { log, sidecar } => {
                self.mapping = None;
                self.say_saved(&sidecar);
                self.open_with(ctx, &log, Some(sidecar));
            }
            Outcome::Fitted(analysis) => self.fitted(ctx, *analysis),
            Outcome::Segmented(index, found) => self.segmented(index, *found),
            Outcome::Simulated(replays) => self.replays = replays,
            Outcome::Tried(values, replays) => self.what_if.take(values, replays),
            Outcome::Sensitive(found) => self.sensitivity = Some(found),
            Outcome::Judged(enough) => self.enough = enough,
            Outcome::Diagnosed(answer) => self.diagnosed(answer),
            Outcome::Extended(worlds) => self.extended(ctx, worlds),
            Outcome::Checked(checked) => self.checked(checked),
            Outcome::Rehearsed(rehearsal) => self.rehearsed(rehearsal),
            Outcome::Guided(guided) => self.guided(guided),
            Outcome::Expert(trace) => self.expert_did_it(trace),
            Outcome::Graded(debrief) => self.graded(debrief),
            Outcome::Practise(lesson) => self.lesson_made(ctx, lesson),
            Outcome::Followed(path) => self.followed(path),
            Outcome::Performed(path) => self.performed(ctx, &path),
            Outcome::SimulatedExtended(replays) => self.diagnosing.replays = replays,
            Outcome::Curves(made) => self.plots.derived.take(made),
            Outcome::Aligned(recording, found) => self.aligned(recording, found),
            Outcome::Video(file, answer) => self.video_was_read(file, answer),
            Outcome::Picture { file, index, picture } => self.picture_came(ctx, (file, index), picture),
            Outcome::VideoAligned(file, found) => self.video_aligned(&file, found),
            Outcome::MostAlike(pair, found) => {
                self.plots.likeliest.insert(pair, found);
            }
            Outcome::Cancelled | Outcome::Chosen(_, None) => {}
            Outcome::Chosen(purpose, Some(path)) => self.chosen(ctx, purpose, path),
            Outcome::ChosenMany(_, paths) => self.check(ctx, On::Files(paths)),
            Outcome::Unfinished(found) => self.unfinished = found,
            Outcome::World(world) => self.opened_world = Some(world),
            Outcome::Saved(path) => self.say_saved(&path),
            Outcome::Failed(problem) => {
                self.experiments.asks_again = false;
                if !self.recordings.is_empty() && self.analysis.is_none() {
                    self.fit_problem = Some(problem.clone());
                }
                self.fail(problem);
            }
        }
    }
}
