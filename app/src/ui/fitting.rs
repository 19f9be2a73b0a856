//! From the loaded recordings to a fit and its replay, in the background, and again whenever the user changes how.

use super::film::Film;
use super::fit_choice::FitChoice;
use super::jobs::{JobKind, change};
use super::prepare::Prepared;
use super::replayed::Replayed;
use super::session::Session;
use crate::text::sentence::sentence;
use crate::ui::plots::levels::Levels;
use estimator::online::enough::{Enough, Wanted};
use estimator::pipeline::{self, Analysis};
use estimator::segment::{Segmentation, segment_by};
use estimator::simulate::Simulation;
use haptics::recording::Recording;
use haptics::world::World;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Segmenting and fitting.
pub const FIT: JobKind = JobKind::new("fit");
/// Finding states anew while rules are edited.
pub const SEGMENT: JobKind = JobKind::new("segment");
/// Replaying the measured motion through the fitted world.
pub const SIMULATE: JobKind = JobKind::new("simulate").after(&FIT);
/// Judging whether there is enough data.
const JUDGE: JobKind = JobKind::new("judge");

/// A fit that took no longer follows every change at once.
const AT_ONCE: Duration = Duration::from_millis(700);

/// What refits have in common, and how long they take.
#[derive(Clone)]
pub struct Refits {
    /// What of the recordings does not depend on the choice; for one chosen part of them.
    shared: Arc<pipeline::Prepared>,
    part_s: Option<(f64, f64)>,
    /// What the running or the last fit was asked.
    asked: Option<FitChoice>,
    begun: Instant,
    /// How long the last one took.
    took: Option<Duration>,
    /// Whether the fit follows every change.
    pub live: bool,
    /// … as long as it takes no longer than this.
    pub at_once: Duration,
}

impl Default for Refits {
    fn default() -> Self {
        Self {
            shared: Arc::default(),
            part_s: None,
            asked: None,
            begun: Instant::now(),
            took: None,
            live: true,
            at_once: AT_ONCE,
        }
    }
}

impl Refits {
    /// For other recordings.
    pub fn forget(&mut self) {
        *self = Self { live: self.live, at_once: self.at_once, ..Self::default() };
    }

    /// True when fits of these recordings are quick enough to follow every change.
    pub fn quick(&self) -> bool {
        self.took.is_some_and(|took| took < self.at_once)
    }

    /// How long the last fit took.
    pub fn took(&self) -> Option<Duration> {
        self.took
    }

    /// The fit on the screen is of this choice.
    pub fn answered(&mut self, choice: &FitChoice) {
        self.asked = Some(choice.clone());
    }

    /// The running fit will not come.
    pub fn gave_up(&mut self) {
        self.asked = None;
    }

    fn shared(&mut self, choice: &FitChoice) -> Arc<pipeline::Prepared> {
        if self.part_s != choice.only_s {
            self.part_s = choice.only_s;
            self.shared = Arc::default();
        }
        Arc::clone(&self.shared)
    }
}

impl Session {
    /// Segments and fits in the background.
    pub fn refit(&mut self, ctx: &egui::Context) {
        if self.recordings.is_empty() {
            return;
        }
        self.what_if.forget();
        self.jobs.cancel_after(FIT);
        self.stale = false;
        let (recordings, choice) = (self.recordings.clone(), self.choice.clone());
        let shared = self.refits.shared(&choice);
        self.refits.asked = Some(choice.clone());
        self.refits.begun = Instant::now();
        let job = self.jobs.start(ctx, FIT, "Fitting", move |_| {
            let analysis = analyse_sharing(&recordings, &shared, &choice)?;
            change(move |session: &mut Self, ctx| session.fitted(ctx, analysis))
        });
        job.if_given_up(|session: &mut Self, _| {
            if session.analysis.is_none() {
                session.fit_problem = Some("The fit was cancelled; press Fit to start it again.".to_owned());
            }
            session.refits.gave_up();
            session.stale = true;
        });
    }

    /// Sees whether the fit on the screen still is what was chosen, and makes it follow where that is quick. Call once a frame.
    pub fn follow_choice(&mut self, ctx: &egui::Context) {
        let Some(asked) = &self.refits.asked else { return };
        self.stale = *asked != self.choice;
        let busy = self.jobs.is_running(FIT);
        // While rules are edited only the states follow: a fit with half a rule is of no use.
        if self.stale && self.refits.live && self.refits.quick() && !busy && self.rules.is_none() {
            self.refit(ctx);
        }
    }

    /// Tells the states of the shown recording anew, in the background; the fit stays as it was.
    pub fn resegment(&mut self, ctx: &egui::Context) {
        let Some(prepared) = self.prepared().cloned() else { return };
        let (index, choice) = (self.current, self.choice.clone());
        self.jobs.start(ctx, SEGMENT, "", move |_| {
            let recording = choice.given_to(index, &prepared.recording);
            let found = segment_by(choice.method, &recording, choice.task, choice.thresholds)
                .map_err(|error| sentence(&error.to_string()))?;
            change(move |session: &mut Self, _| session.segmented(index, found))
        });
    }

    /// The states of one recording were told anew.
    pub(super) fn segmented(&mut self, index: usize, found: Segmentation) {
        let Some(analysis) = self.analysis.as_mut() else { return };
        if let Some(place) = Arc::make_mut(analysis).segmentations.get_mut(index) {
            *place = Some(found);
        }
    }

    /// A fit has come.
    pub(super) fn fitted(&mut self, ctx: &egui::Context, analysis: Analysis) {
        self.refits.took = Some(self.refits.begun.elapsed());
        let analysis = Arc::new(analysis);
        self.analysis = Some(Arc::clone(&analysis));
        self.fit_problem = None;
        let (recordings, fitted) = (self.recordings.clone(), Arc::clone(&analysis));
        self.jobs.start(ctx, JUDGE, "", move |_| {
            let enough = judge(&fitted, &recordings);
            change(|session: &mut Self, _| session.enough = enough)
        });
        let recordings = self.recordings.clone();
        self.jobs.start(ctx, SIMULATE, "Replaying in the fitted world", move |_| {
            let replays = replay_all(&analysis.world, &recordings);
            change(|session: &mut Self, _| session.replays = replays)
        });
    }
}

/// Segments and fits; the sentence of an error.
pub fn analyse(recordings: &[Arc<Prepared>], choice: &FitChoice) -> Result<Analysis, String> {
    analyse_sharing(recordings, &pipeline::Prepared::default(), choice)
}

/// [`analyse`] for the second time and on: `shared` belongs to these recordings and the chosen part of them.
fn analyse_sharing(
    recordings: &[Arc<Prepared>],
    shared: &pipeline::Prepared,
    choice: &FitChoice,
) -> Result<Analysis, String> {
    let parts: Vec<Recording> = choice.given_to_all(recordings).into_iter().map(|r| choice.cut(r)).collect();
    let options = pipeline::Options { task: choice.task, thresholds: choice.thresholds, method: choice.method };
    let analysed = pipeline::analyse_prepared(&parts, shared, &options);
    let mut analysis = analysed.map_err(|error| sentence(&error.to_string()))?;
    if choice.only_s.is_some() {
        for ((prepared, part), found) in recordings.iter().zip(&parts).zip(&mut analysis.segmentations) {
            if let Some(found) = found {
                place_in_whole(found, prepared, part);
            }
        }
    }
    Ok(analysis)
}

/// Counts the samples of a part's intervals from the beginning of the whole recording.
fn place_in_whole(found: &mut Segmentation, whole: &Prepared, part: &Recording) {
    let first_s = part.time_s.as_ref().and_then(|t| t.first().copied());
    let offset = first_s.map_or(0, |first| whole.times.partition_point(|t| *t < first));
    for interval in &mut found.states {
        interval.first += offset;
        interval.end += offset;
    }
    // It has a row for every sample of the part only.
    found.posterior = None;
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
        let (_, factor) = crate::text::format::channel_unit(&channel.unit);
        (channel.name.clone(), Arc::new(Levels::of_simulation(simulation, index, factor)))
    };
    simulation.predicted.iter().enumerate().map(shown).collect()
}
