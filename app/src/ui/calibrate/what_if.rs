//! Trial values of parameters: the world with them, its replay and its residual force, live.

use crate::ui::background::jobs::JobKind;
use crate::ui::calibrate::replayed::Replayed;
use estimator::calibrate;
use estimator::pipeline::Analysis;
use haptics::recording::Recording;
use haptics::world::World;
use std::collections::BTreeMap;

/// Replaying with a value that is tried.
pub(crate) const WHAT_IF: JobKind = JobKind::new("what-if");

/// Values that are tried, and what comes of them.
#[derive(Clone, Debug, Default)]
pub struct WhatIf {
    /// Tried values by `object.name`, SI.
    pub values: BTreeMap<String, f64>,
    /// The values that the shown replay was made with.
    answered: Option<BTreeMap<String, f64>>,
    /// The replay of every recording.
    pub replays: Vec<Option<Replayed>>,
}

impl WhatIf {
    /// Nothing is tried any more.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// True when something is tried.
    pub fn is_on(&self) -> bool {
        !self.values.is_empty()
    }

    /// True when the shown replay is not yet that of the tried values.
    pub fn is_behind(&self) -> bool {
        self.is_on() && self.answered.as_ref() != Some(&self.values)
    }

    /// An answer has come.
    pub(crate) fn take(&mut self, values: BTreeMap<String, f64>, replays: Vec<Option<Replayed>>) {
        if self.is_on() {
            (self.answered, self.replays) = (Some(values), replays);
        }
    }
}

/// The world of a fit in which some parameters have other values.
pub fn world(analysis: &Analysis, recordings: &[Recording], values: &BTreeMap<String, f64>) -> World {
    let mut fit = analysis.fit.clone();
    for parameter in &mut fit.parameters {
        if let Some(value) = values.get(&parameter.full_name()) {
            // A trial value counts as exact, like a known one.
            (parameter.value, parameter.std_error) = (Some(*value), None);
            parameter.identified = true;
        }
    }
    // A block's mass and weight are two names of one number.
    let gravity = recordings.first().map_or(9.81, |r| r.meta.gravity());
    for (name, value) in values {
        let twin = match name.rsplit_once('.') {
            Some((object, "weight_N")) if gravity > 0.0 => (object, "mass_kg", value / gravity),
            Some((object, "mass_kg")) => (object, "weight_N", value * gravity),
            _ => continue,
        };
        let parameter = fit.parameters.iter_mut().find(|p| p.object == twin.0 && p.name == twin.1);
        if let Some(parameter) = parameter.filter(|p| !values.contains_key(&p.full_name())) {
            parameter.value = Some(twin.2);
        }
    }
    calibrate::world(analysis.task, recordings, &fit, &analysis.segmentations)
}

/// RMS residual of the force in a world, N (or Nm), over all channels and recordings; `None` if it predicts nothing.
pub fn residual_rms(replays: &[Option<Replayed>]) -> Option<f64> {
    let simulations = replays.iter().flatten().filter_map(|r| r.simulation.as_ref());
    let rms: Vec<f64> = simulations.flat_map(|s| s.residual_rms.iter().map(|(_, rms)| *rms)).collect();
    (!rms.is_empty()).then(|| (rms.iter().map(|r| r * r).sum::<f64>() / rms.len() as f64).sqrt())
}
