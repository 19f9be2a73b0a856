//! Fits and replays of recordings.

use crate::text::sentence::sentence;
use crate::ui::background::jobs::JobKind;
use crate::ui::calibrate::replay_frames::Film;
use crate::ui::calibrate::replayed::Replayed;
use crate::ui::document::fit_choice::FitChoice;
use crate::ui::document::prepared::Prepared;
use crate::ui::plots::levels::Levels;
use estimator::online::information::{Enough, Wanted};
use estimator::pipeline::{self, Analysis};
use estimator::segment::Segmentation;
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
pub(crate) const JUDGE: JobKind = JobKind::new("judge");

/// A fit that took no longer follows every change at once.
pub(crate) const AT_ONCE: Duration = Duration::from_millis(700);

/// Data that refits share, and the duration of the last one.
#[derive(Clone)]
pub struct Refits {
    /// Parts of the recordings that do not depend on the choice; for one chosen part of them.
    shared: Arc<pipeline::Prepared>,
    part_s: Option<(f64, f64)>,
    /// Choice of the running or the last fit.
    pub(crate) asked: Option<FitChoice>,
    pub(crate) begun: Instant,
    /// Duration of the last fit.
    pub(crate) took: Option<Duration>,
    /// True if the fit follows every change, unless it is slower than `at_once`.
    pub live: bool,
    /// Longest duration of a fit that follows every change at once.
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

    /// Duration of the last fit.
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

    pub(crate) fn shared(&mut self, choice: &FitChoice) -> Arc<pipeline::Prepared> {
        if self.part_s != choice.only_s {
            self.part_s = choice.only_s;
            self.shared = Arc::default();
        }
        Arc::clone(&self.shared)
    }
}

/// Segments and fits; the sentence of an error.
pub fn analyse(recordings: &[Arc<Prepared>], choice: &FitChoice) -> Result<Analysis, String> {
    analyse_sharing(recordings, &pipeline::Prepared::default(), choice)
}

/// [`analyse`] for the second time and on: `shared` belongs to these recordings and the chosen part of them.
pub(crate) fn analyse_sharing(
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
pub(crate) fn place_in_whole(found: &mut Segmentation, whole: &Prepared, part: &Recording) {
    let first_s = part.time_s.as_ref().and_then(|t| t.first().copied());
    let offset = first_s.map_or(0, |first| whole.times.partition_point(|t| *t < first));
    for interval in &mut found.states {
        interval.first += offset;
        interval.end += offset;
    }
    // It has a row for every sample of the part only.
    found.posterior = None;
}

/// Data that is still missing for the parameters of a fit.
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
pub(crate) fn curves(simulation: &Arc<Simulation>) -> Vec<(String, Arc<Levels>)> {
    let shown = |(index, channel): (usize, &haptics::recording::Channel)| {
        let (_, factor) = crate::text::format::channel_unit(&channel.unit);
        (channel.name.clone(), Arc::new(Levels::of_simulation(simulation, index, factor)))
    };
    simulation.predicted.iter().enumerate().map(shown).collect()
}
