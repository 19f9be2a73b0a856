//! Runs the stages over one log: segment, fit, calibrate, simulate, diagnose. What fails is a sentence in its place.

use super::source::Source;
use crate::ui::plots::residuals::Residuals;
use crate::ui::prepare::Prepared;
use estimator::diagnose::{self, Diagnosis};
use estimator::estimate::Parameter;
use estimator::online::enough::{Enough, Wanted};
use estimator::online::enough_for;
use estimator::pipeline::{Analysis, Options, analyse};
use estimator::segment::{Segmentation, segment};
use estimator::simulate::{Simulation, simulate};
use haptics::recording::Recording;

/// Recordings of one log that are drawn; further ones stand in the table.
pub const MOST_DRAWN: usize = 4;

/// Warnings of these kinds tell how the columns were understood.
const NOTES: [&str; 2] = ["columns", "text-column"];

/// One log of a report.
#[derive(Debug)]
pub struct Sheet {
    /// Where it came from.
    pub source: Source,
    /// What is in it, or why it could not be read.
    pub content: Result<Content, String>,
}

/// What the stages made of a log.
#[derive(Debug)]
pub struct Content {
    /// All of it.
    pub recordings: Vec<Recording>,
    /// The first few, ready to be drawn.
    pub drawn: Vec<Drawn>,
    /// Segments, parameters, constraints, the calibrated world.
    pub analysis: Result<Analysis, String>,
    /// How much of the usual accuracy was reached, and which motion is missing.
    pub enough: Vec<Enough>,
    /// What the plain model of the task gets wrong.
    pub diagnosis: Result<Diagnosis, String>,
    /// What the calibrated world gets wrong; absent where it failed or says the same.
    pub of_world: Option<Diagnosis>,
}

/// A recording that is drawn.
#[derive(Debug)]
pub struct Drawn {
    /// Its curves.
    pub prepared: Prepared,
    /// Its states, where they can be told.
    pub segmentation: Option<Segmentation>,
    /// The measured motion through the calibrated world.
    pub simulation: Result<Simulation, String>,
    /// Curves of the diagnosis, where there is one along the motion.
    pub residuals: Option<Residuals>,
}

impl Sheet {
    /// Of a log that was read, or that could not be.
    pub fn new(source: Source, read: Result<Vec<Recording>, String>) -> Self {
        Self { source, content: read.map(Content::new) }
    }
}

impl Content {
    fn new(recordings: Vec<Recording>) -> Self {
        let said = |error: estimator::estimate::EstimateError| error.to_string();
        let analysis = analyse(&recordings, &Options::default()).map_err(said);
        let enough =
            analysis.as_ref().map(|a| enough_for(&recordings, a.task, &a.fit, &Wanted::default())).unwrap_or_default();
        let diagnosis = diagnose::diagnose(&recordings, &diagnose::Options::default()).map_err(said);
        let of_world = analysis.as_ref().ok().filter(|_| diagnosis.is_ok()).and_then(|a| {
            let options = diagnose::Options { world: Some(a.world.clone()), ..diagnose::Options::default() };
            let found = diagnose::diagnose(&recordings, &options).ok()?;
            // Tasks that compare without a world would say everything twice.
            diagnosis
                .as_ref()
                .is_ok_and(|plain| plain.causes != found.causes || plain.causes.is_empty())
                .then_some(found)
        });
        let drawn = recordings
            .iter()
            .take(MOST_DRAWN)
            .enumerate()
            .map(|(k, recording)| Drawn {
                prepared: Prepared::new(recording.clone()),
                segmentation: match &analysis {
                    Ok(analysis) => analysis.segmentations.get(k).cloned().flatten(),
                    // A fit may fail where states can be told.
                    Err(_) => segment(recording, None, None).ok(),
                },
                simulation: match &analysis {
                    Ok(analysis) => simulate(&analysis.world, recording).map_err(said),
                    Err(_) => Err("there is no calibrated world, because the fit did not succeed".to_owned()),
                },
                residuals: diagnosis.as_ref().ok().map(|d| Residuals::new(d, k)).filter(|r| !r.is_empty()),
            })
            .collect();
        Self { recordings, drawn, analysis, enough, diagnosis, of_world }
    }

    /// Sentences about the quality of the data, each once.
    pub fn warnings(&self) -> Vec<&str> {
        self.said(|kind| !NOTES.contains(&kind))
    }

    /// Sentences about how the file was read, each once: nothing to worry about.
    pub fn notes(&self) -> Vec<&str> {
        self.said(|kind| NOTES.contains(&kind))
    }

    fn said(&self, counts: impl Fn(&str) -> bool) -> Vec<&str> {
        let mut found: Vec<&str> = Vec::new();
        for warning in self.recordings.iter().flat_map(|r| &r.warnings).filter(|w| counts(&w.kind)) {
            if !found.contains(&warning.text.as_str()) {
                found.push(&warning.text);
            }
        }
        found
    }

    /// Parameters that were measured, and all that were looked for. A value whose error is larger than itself is none.
    pub fn identified(&self) -> (usize, usize) {
        let all = self.analysis.as_ref().map_or(&[][..], |a| &a.fit.parameters);
        (all.iter().filter(|p| p.identified && !is_lost(p)).count(), all.len())
    }
}

/// Parameters that are as well known near zero as anywhere: places, angles, what a sensor reads at rest.
const OF_EITHER_SIGN: [&str; 9] =
    ["center_", "offset", "gravity_phase", "surface_position", "added_level", "bias", "position", "angle", "phase"];

/// Whether a size is lost in its own error: nothing, or twice as much, is as likely.
pub fn is_lost(parameter: &Parameter) -> bool {
    let sizes = parameter.value.zip(parameter.std_error);
    let is_place = OF_EITHER_SIGN.iter().any(|name| parameter.name.starts_with(name));
    !is_place && sizes.is_some_and(|(value, error)| error > value.abs())
}
