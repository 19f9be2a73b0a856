//! Runs the stages on one log: segment, fit, calibrate, simulate, diagnose. A failed stage is replaced by a sentence.

use super::source::Source;
use crate::ui::document::prepared::Prepared;
use crate::ui::plots::residuals::Residuals;
use estimator::diagnose::{self, Findings};
use estimator::estimate::Parameter;
use estimator::online::enough_for;
use estimator::online::information::{Enough, Wanted};
use estimator::pipeline::{Analysis, Options, analyse};
use estimator::segment::{Segmentation, segment};
use estimator::simulate::{Simulation, simulate};
use haptics::recording::Recording;

/// Maximum number of drawn recordings per log; further ones are only in the table.
pub const MOST_DRAWN: usize = 4;

/// Kinds of warnings that explain how the columns were read.
const NOTES: [&str; 2] = ["columns", "text-column"];

/// One log of a report.
#[derive(Debug)]
pub struct Sheet {
    /// Source of the log.
    pub source: Source,
    /// Content of the log, or the reason why it could not be read.
    pub content: Result<Content, String>,
}

/// Results of the stages for a log.
#[derive(Debug)]
pub struct Content {
    /// All recordings.
    pub recordings: Vec<Recording>,
    /// The first few, prepared for drawing.
    pub drawn: Vec<Drawn>,
    /// Segments, parameters, constraints, the calibrated world.
    pub analysis: Result<Analysis, String>,
    /// Attained share of the target accuracy per parameter, with the missing motion.
    pub enough: Vec<Enough>,
    /// Findings of the base model of the task.
    pub diagnosis: Result<Findings, String>,
    /// Findings of the calibrated world; `None` where it failed or agrees.
    pub of_world: Option<Findings>,
}

/// A recording that is drawn.
#[derive(Debug)]
pub struct Drawn {
    /// Its curves.
    pub prepared: Prepared,
    /// States of the recording, where segmentation is possible.
    pub segmentation: Option<Segmentation>,
    /// Simulation of the measured motion in the calibrated world.
    pub simulation: Result<Simulation, String>,
    /// Curves of the diagnosis, if there is one along the motion.
    pub residuals: Option<Residuals>,
}

impl Sheet {
    /// Sheet of a log that was read, or that could not be.
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
            // Tasks that are compared without a world would repeat everything.
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
                    // Segmentation can succeed where a fit fails.
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

    /// Warnings about data quality, each once.
    pub fn warnings(&self) -> Vec<&str> {
        self.said(|kind| !NOTES.contains(&kind))
    }

    /// Notes on how the file was read, each once: no cause for concern.
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

    /// Numbers of identified parameters and of all parameters. A value with an error larger than itself counts as
    /// unidentified.
    pub fn identified(&self) -> (usize, usize) {
        let all = self.analysis.as_ref().map_or(&[][..], |a| &a.fit.parameters);
        (all.iter().filter(|p| p.identified && !is_lost(p)).count(), all.len())
    }
}

/// Parameters for which zero is an ordinary value: positions, angles, sensor zeros.
const OF_EITHER_SIGN: [&str; 9] =
    ["center_", "offset", "gravity_phase", "surface_position", "added_level", "bias", "position", "angle", "phase"];

/// True if a magnitude is lost in its own error: zero, or twice the value, is as likely.
pub fn is_lost(parameter: &Parameter) -> bool {
    let sizes = parameter.value.zip(parameter.std_error);
    let is_place = OF_EITHER_SIGN.iter().any(|name| parameter.name.starts_with(name));
    !is_place && sizes.is_some_and(|(value, error)| error > value.abs())
}
