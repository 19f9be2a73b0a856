//! The calibration: how the recordings are fitted, and the fit.

use crate::ui::calibrate::refits::Refits;
use crate::ui::calibrate::replayed::Replayed;
use crate::ui::calibrate::rules::Rules;
use crate::ui::calibrate::sensitivity::Sensitivity;
use crate::ui::calibrate::what_if::WhatIf;
use crate::ui::document::fit_choice::FitChoice;
use estimator::online::information::Enough;
use estimator::pipeline::Analysis;
use estimator::segment::Segmentation;
use std::sync::Arc;

/// The choice of a fit, the fit, and all that is derived from it.
#[derive(Default)]
pub struct Calibration {
    /// The choice of how to fit.
    pub choice: FitChoice,
    /// The choice that the fit on the screen was made with differs from `choice`.
    pub stale: bool,
    /// Data that refits share.
    pub refits: Refits,
    /// The parameter that is looked at closely, `object.name`.
    pub selected_parameter: Option<String>,
    /// Sensitivity of the force to the parameters.
    pub sensitivity: Option<Arc<Sensitivity>>,
    /// Values that are tried.
    pub what_if: WhatIf,
    /// The fit.
    pub analysis: Option<Arc<Analysis>>,
    /// Why there is none, in one sentence.
    pub fit_problem: Option<String>,
    /// The replay through the fitted world, by recording.
    pub replays: Vec<Option<Replayed>>,
    /// The data that the parameters of the fit still need.
    pub enough: Vec<Enough>,
    /// The open editor of a task's rules.
    pub rules: Option<Box<Rules>>,
}

impl Calibration {
    /// Segmentation of a recording.
    pub fn segmentation(&self, recording: usize) -> Option<&Segmentation> {
        self.analysis.as_ref()?.segmentations.get(recording)?.as_ref()
    }

    /// Replay of a recording through the fitted world.
    pub fn replay(&self, recording: usize) -> Option<&Replayed> {
        self.replays.get(recording)?.as_ref()
    }

    /// Forgets the fit: other recordings were opened. The method and the wish to follow changes stay.
    pub fn forget(&mut self) {
        self.replays.clear();
        self.enough.clear();
        (self.analysis, self.fit_problem, self.rules) = (None, None, None);
        self.refits.forget();
        self.what_if.forget();
    }

    /// True when the fitted world has something that the hand can touch.
    pub fn can_train(&self) -> bool {
        self.analysis.as_ref().is_some_and(|a| !a.world.blocks.is_empty() || a.world.crank.is_some())
    }
}
