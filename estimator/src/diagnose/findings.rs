//! Everything that a diagnosis found: the published answer, and data for plots, worlds and checks on other recordings.

use super::contract::{Baseline, Diagnosis, Final};
use crate::diagnose::answer::atlas::Atlas;
use crate::diagnose::answer::time_series::Course;
use crate::diagnose::data::coordinate::Along;
use crate::diagnose::extension::hypothetical_worlds::Hypothesis;
use crate::diagnose::model_error::twin::Twin;
use crate::diagnose::recording::delay_scan::Late;
use crate::diagnose::validation::on_other_recordings::Kept;
use haptics::law::Effect;
use std::ops::{Deref, DerefMut};

/// The published answer with its data. It reads as the [`Diagnosis`] in it, which alone is the JSON.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// The published answer.
    pub diagnosis: Diagnosis,
    /// The model's laws, fitted without any cause.
    pub plain: Vec<Effect>,
    /// The laws of the extended world: those of the model, refitted, and the causes.
    pub effects: Vec<Effect>,
    /// Measured and modelled force, row by row.
    pub course: Course,
    /// The residual beside every suspect; empty unless [`super::options::Options::atlas`] asks for it.
    pub atlas: Atlas,
    /// Part of a sample by which force and motion differ in time, s: corrected, and not called a delay.
    pub skew_s: f64,
    /// Estimated terms, for other recordings.
    pub(crate) kept: Vec<Kept>,
    /// Replays without any cause; `None` unless [`super::options::Options::twins`] asks for them.
    pub(crate) twin: Option<Box<Twin>>,
    /// The coordinate of a mechanism, for other recordings.
    pub(crate) along: Option<Along>,
    /// True if forces are per unit of an unknown inertia, as in a free motion.
    pub(crate) per_inertia: bool,
    /// Evidence of a time delay.
    pub(crate) delay: DelayFindings,
    /// The answers that are not excluded, as laws: for rehearsals of experiments.
    pub(crate) hypotheses: Vec<Hypothesis>,
}

impl From<Diagnosis> for Findings {
    /// The published answer without its data, as it comes out of a file.
    fn from(diagnosis: Diagnosis) -> Self {
        Self { diagnosis, ..Self::default() }
    }
}

impl Findings {
    /// The figures by which a delay is judged.
    pub(crate) fn figures_of_delay(&self) -> Figures {
        self.delay.figures.clone().unwrap_or_else(|| Figures {
            baseline: self.baseline.clone(),
            end: self.end.clone(),
            noise_floor: self.noise_floor_n,
        })
    }
}

impl Deref for Findings {
    type Target = Diagnosis;

    fn deref(&self) -> &Diagnosis {
        &self.diagnosis
    }
}

impl DerefMut for Findings {
    fn deref_mut(&mut self) -> &mut Diagnosis {
        &mut self.diagnosis
    }
}

/// Evidence of a time delay of the forces, all in s.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct DelayFindings {
    /// Shift of the forces before the diagnosis.
    pub corrected_s: f64,
    /// Delay that remains, significant or not, and its standard error.
    pub rest_s: Option<[f64; 2]>,
    /// Delay with the smallest residual of a plain model, if it is too large for a linear regressor.
    pub guess_s: Option<f64>,
    /// Figures of the channel that shows the delay, if the published ones may be of another channel.
    pub figures: Option<Figures>,
    /// Evidence of the model of its channel beside structured errors, and number of rows.
    pub whole: Option<[f64; 2]>,
}

impl DelayFindings {
    /// Result of a search in one channel with these figures; a significant delay makes the diagnosis repeat.
    pub fn of_scan(late: Late, figures: Figures) -> Self {
        Self {
            corrected_s: 0.0,
            rest_s: Some([late.tau_s, late.error_s]),
            guess_s: late.is_seen.then_some(late.tau_s),
            figures: Some(figures),
            whole: None,
        }
    }
}

/// Residual figures of one channel, without and with the causes found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Figures {
    /// Without the causes.
    pub baseline: Baseline,
    /// With them.
    pub end: Final,
    /// Its noise.
    pub noise_floor: f64,
}

impl Figures {
    /// Figures if nothing was compared: zero residual, white.
    pub(crate) fn of_nothing() -> Self {
        Self {
            baseline: Baseline { whiteness_p: 1.0, ..Baseline::default() },
            end: Final { whiteness_p: 1.0, ..Final::default() },
            noise_floor: 0.0,
        }
    }
}
