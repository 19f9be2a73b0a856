//! What the window knows: loaded recordings, their fit, the replay, the time cursor. Panels read and change it; jobs fill it.

use super::diagnosing::Diagnosing;
use super::film::Film;
pub use super::fit_choice::FitChoice;
use super::jobs::{JobKind, Jobs, Outcome, Purpose, Replayed};
use super::mapping::Mapping;
use super::plots::{Levels, PlotChoices};
use super::prepare::Prepared;
use super::rules::Rules;
pub use super::scene::SceneLayers;
use super::trainer::Trainer;
use crate::tasks::Chosen;
use estimator::online::enough::{Enough, Wanted};
use estimator::pipeline::{self, Analysis};
use estimator::segment::{Segmentation, segment_by};
use estimator::simulate::Simulation;
use haptics::recording::Recording;
use haptics::world::World;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The workspaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
    /// When it goes by itself; `None`: when it is dismissed.
    pub until: Option<Instant>,
}

/// How long one reads that something was done.
const DONE_LASTS: Duration = Duration::from_secs(10);

/// Everything that is shared between panels.
#[derive(Default)]
pub struct Session {
    /// The open workspace.
    pub workspace: Workspace,
    /// Loaded recordings.
    pub recordings: Vec<Arc<Prepared>>,
    /// The one that is shown.
    pub current: usize,
    /// Where they came from.
    pub path: Option<PathBuf>,
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
    /// The fit.
    pub analysis: Option<Arc<Analysis>>,
    /// Why there is none, in one sentence.
    pub fit_problem: Option<String>,
    /// The replay through the fitted world, by recording.
    pub replays: Vec<Option<Replayed>>,
    /// What the model gets wrong.
    pub diagnosing: Diagnosing,
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
    /// What the 3-D view shows.
    pub layers: SceneLayers,
    /// Messages.
    pub banners: Vec<Banner>,
    /// Background work.
    pub jobs: Jobs,
    /// A world that was opened from a file, for the trainer to take.
    pub opened_world: Option<Box<World>>,
    /// Where to save: the dialog's answer for the panels.
    pub chosen: Option<(Purpose, PathBuf)>,
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
            None => self.banners.push(Banner { tone, text, until }),
        }
    }

    /// Reads the same log again.
    pub fn reload(&mut self, ctx: &egui::Context) {
        match self.path.clone() {
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
        self.plots.forget_recordings();
        self.playing = false;
        self.rules = None;
        self.choice = FitChoice {
            task: self.task_hint.as_ref().map(Chosen::like),
            own: self.task_hint.as_ref().and_then(Chosen::own).cloned().map(Arc::new),
            thresholds: None,
            method: self.choice.method,
        };
        self.select(0);
    }

    /// Shows another recording of the file.
    pub fn select(&mut self, index: usize) {
        self.current = index.min(self.recordings.len().saturating_sub(1));
        if let Some(prepared) = self.prepared() {
            self.view_s = prepared.span();
            self.cursor_s = self.view_s.0;
        }
    }

    /// Segments and fits in the background.
    pub fn refit(&mut self, ctx: &egui::Context) {
        if self.recordings.is_empty() {
            return;
        }
        self.stale = false;
        self.jobs.cancel(JobKind::Simulate);
        let (recordings, choice) = (self.recordings.clone(), self.choice.clone());
        self.jobs.start_watched(ctx, JobKind::Fit, "Fitting".to_owned(), move |_| {
            match analyse(&recordings, &choice) {
                Ok(analysis) => Outcome::Fitted(Box::new(analysis)),
                Err(problem) => Outcome::Failed(problem),
            }
        });
    }

    /// Ends a job that the user does not want to wait for; what was there before stays.
    pub fn give_up(&mut self, kind: JobKind) {
        self.jobs.cancel(kind);
        if kind == JobKind::Fit && self.analysis.is_none() {
            self.fit_problem = Some("The fit was cancelled; press Fit to start it again.".to_owned());
        }
        if kind == JobKind::Curves {
            self.plots.give_up();
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
    }

    fn take(&mut self, ctx: &egui::Context, outcome: Outcome) {
        match outcome {
            Outcome::Loaded(path, recordings) => {
                let mute = super::opening::says_nothing(&recordings);
                self.path = Some(path);
                self.workspace = Workspace::Calibrate;
                self.show(recordings);
                match mute {
                    Some(why) => self.map_columns(ctx, Some(why)),
                    None => self.refit(ctx),
                }
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
                self.say(Tone::Done, format!("Saved to {}.", sidecar.display()));
                self.open_with(ctx, &log, Some(sidecar));
            }
            Outcome::Fitted(analysis) => self.fitted(ctx, *analysis),
            Outcome::Segmented(index, found) => self.segmented(index, *found),
            Outcome::Simulated(replays) => self.replays = replays,
            Outcome::Judged(enough) => self.enough = enough,
            Outcome::Diagnosed(answer) => self.diagnosed(answer),
            Outcome::Extended(worlds) => self.extended(ctx, worlds),
            Outcome::SimulatedExtended(replays) => self.diagnosing.replays = replays,
            Outcome::Curves(made) => self.plots.derived.take(made),
            Outcome::Aligned(recording, found) => self.aligned(recording, found),
            Outcome::Cancelled | Outcome::Chosen(_, None) => {}
            Outcome::Chosen(Purpose::OpenLog, Some(path)) => self.open_any(ctx, &path),
            Outcome::Chosen(Purpose::OpenWorld, Some(path)) => self.open_world(ctx, &path),
            Outcome::Chosen(purpose, Some(path)) => self.chosen = Some((purpose, path)),
            Outcome::Unfinished(found) => self.unfinished = found,
            Outcome::World(world) => self.opened_world = Some(world),
            Outcome::Saved(path) => self.say(Tone::Done, format!("Saved to {}.", path.display())),
            Outcome::Failed(problem) => {
                if !self.recordings.is_empty() && self.analysis.is_none() {
                    self.fit_problem = Some(problem.clone());
                }
                self.fail(problem);
            }
        }
    }

    /// Tells the states of the shown recording anew, in the background; the fit stays as it was.
    pub fn resegment(&mut self, ctx: &egui::Context) {
        let Some(prepared) = self.prepared().cloned() else { return };
        self.stale = true;
        let (index, choice) = (self.current, self.choice.clone());
        self.jobs.start(ctx, JobKind::Segment, move || {
            let recording = choice.given_to(&prepared.recording);
            match segment_by(choice.method, &recording, choice.task, choice.thresholds) {
                Ok(found) => Outcome::Segmented(index, Box::new(found)),
                Err(error) => Outcome::Failed(sentence(&error.to_string())),
            }
        });
    }

    fn segmented(&mut self, index: usize, found: Segmentation) {
        let Some(analysis) = self.analysis.as_ref() else { return };
        let mut analysis = (**analysis).clone();
        if let Some(place) = analysis.segmentations.get_mut(index) {
            *place = Some(found);
            self.analysis = Some(Arc::new(analysis));
        }
    }

    fn fitted(&mut self, ctx: &egui::Context, analysis: Analysis) {
        let analysis = Arc::new(analysis);
        self.analysis = Some(Arc::clone(&analysis));
        self.fit_problem = None;
        let (recordings, fitted) = (self.recordings.clone(), Arc::clone(&analysis));
        self.jobs.start(ctx, JobKind::Judge, move || Outcome::Judged(judge(&fitted, &recordings)));
        let recordings = self.recordings.clone();
        self.jobs.start_watched(ctx, JobKind::Simulate, "Replaying in the fitted world".to_owned(), move |_| {
            Outcome::Simulated(replay_all(&analysis.world, &recordings))
        });
    }
}

/// Segments and fits; the sentence of an error.
pub fn analyse(recordings: &[Arc<Prepared>], choice: &FitChoice) -> Result<Analysis, String> {
    let plain: Vec<Recording> = recordings.iter().map(|p| choice.given_to(&p.recording)).collect();
    let options = pipeline::Options { task: choice.task, thresholds: choice.thresholds, method: choice.method };
    pipeline::analyse(&plain, &options).map_err(|error| sentence(&error.to_string()))
}

/// What is still missing for the parameters of a fit.
pub fn judge(analysis: &Analysis, recordings: &[Arc<Prepared>]) -> Vec<Enough> {
    let plain: Vec<Recording> = recordings.iter().map(|p| p.recording.clone()).collect();
    estimator::online::enough_for(&plain, analysis.task, &analysis.fit, &Wanted::default())
}

/// Plays every recording through the world.
pub fn replay_all(world: &World, recordings: &[Arc<Prepared>]) -> Vec<Option<Replayed>> {
    recordings
        .iter()
        .map(|prepared| {
            let simulation = estimator::simulate::simulate(world, &prepared.recording).ok().map(Arc::new);
            let film = Film::shoot(world, prepared).map(Arc::new);
            let curves = simulation.as_ref().map(curves).unwrap_or_default();
            (simulation.is_some() || film.is_some()).then_some(Replayed { simulation, curves, film })
        })
        .collect()
}

/// The forces of every recording in a world, without the course of the world itself.
pub fn replay_forces(world: &World, recordings: &[Arc<Prepared>]) -> Vec<Option<Replayed>> {
    let replayed = |prepared: &Arc<Prepared>| {
        let simulation = Arc::new(estimator::simulate::simulate(world, &prepared.recording).ok()?);
        Some(Replayed { curves: curves(&simulation), simulation: Some(simulation), film: None })
    };
    recordings.iter().map(replayed).collect()
}

/// Predicted forces in shown units; their samples stay in the simulation.
fn curves(simulation: &Arc<Simulation>) -> Vec<(String, Arc<Levels>)> {
    let shown = |(index, channel): (usize, &haptics::recording::Channel)| {
        let (_, factor) = super::format::channel_unit(&channel.unit);
        (channel.name.clone(), Arc::new(Levels::of_simulation(simulation, index, factor)))
    };
    simulation.predicted.iter().enumerate().map(shown).collect()
}

/// Capital first, full stop last. A column's name in front stays as it is: `f_N` is no `F_N`.
pub fn sentence(text: &str) -> String {
    let text = text.trim();
    let named = text.split(' ').next().is_some_and(|word| word.contains('_'));
    let text = if named { text.to_owned() } else { super::format::capitalised(text) };
    if text.ends_with(['.', '!', '?']) { text } else { format!("{text}.") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_are_sentences() {
        assert_eq!(sentence("the file is empty"), "The file is empty.");
        assert_eq!(sentence("f_N stops changing"), "f_N stops changing.");
    }
}
