//! What if a parameter had another value: the world with it, its replay and what that leaves of the measured force, live.

use super::fitting::replay_forces;
use super::jobs::{JobKind, change};
use super::replayed::Replayed;
use super::session::Session;
use estimator::calibrate;
use estimator::pipeline::Analysis;
use haptics::recording::Recording;
use haptics::world::World;
use std::collections::BTreeMap;

/// Replaying with a value that is tried.
const WHAT_IF: JobKind = JobKind::new("what-if");

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
    pub(super) fn take(&mut self, values: BTreeMap<String, f64>, replays: Vec<Option<Replayed>>) {
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
            // What is tried holds exactly, like what is known.
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

/// What a world leaves of the measured force, N (or Nm) RMS over all channels and recordings; `None` where it predicts nothing.
pub fn residual_rms(replays: &[Option<Replayed>]) -> Option<f64> {
    let simulations = replays.iter().flatten().filter_map(|r| r.simulation.as_ref());
    let rms: Vec<f64> = simulations.flat_map(|s| s.residual_rms.iter().map(|(_, rms)| *rms)).collect();
    (!rms.is_empty()).then(|| (rms.iter().map(|r| r * r).sum::<f64>() / rms.len() as f64).sqrt())
}

impl Session {
    /// Tries a value, or with `None` no longer.
    pub fn try_value(&mut self, name: &str, value: Option<f64>) {
        match value {
            Some(value) => drop(self.what_if.values.insert(name.to_owned(), value)),
            None => drop(self.what_if.values.remove(name)),
        }
        if !self.what_if.is_on() {
            self.what_if.forget();
        }
    }

    /// Replays with the newest tried values when the last replay has come; call once a frame.
    pub fn follow_what_if(&mut self, ctx: &egui::Context) {
        if !self.what_if.is_behind() || self.jobs.is_running(WHAT_IF) {
            return;
        }
        let Some(analysis) = self.analysis.clone() else { return };
        let (recordings, choice, values) = (self.recordings.clone(), self.choice.clone(), self.what_if.values.clone());
        self.jobs.start(ctx, WHAT_IF, "", move |_| {
            let world = world(&analysis, &choice.given_to_all(&recordings), &values);
            let replays = replay_forces(&world, &recordings);
            change(|session: &mut Self, _| session.what_if.take(values, replays))
        });
    }

    /// Replays with the tried values now, for a picture.
    pub(super) fn try_now(&mut self) {
        let Some(analysis) = &self.analysis else { return };
        let values = self.what_if.values.clone();
        let world = world(analysis, &self.choice.given_to_all(&self.recordings), &values);
        let replays = replay_forces(&world, &self.recordings);
        self.what_if.take(values, replays);
    }

    /// The replay that plots show: of the tried values while something is tried.
    pub fn shown_curves(&self) -> Option<&Replayed> {
        let tried = self.what_if.replays.get(self.current).filter(|_| self.what_if.is_on());
        tried.and_then(Option::as_ref).or_else(|| self.replay())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ui::tests::{CRANK, STACK, session};

    fn tried(session: &Session, name: &str, factor: f64) -> f64 {
        let analysis = session.analysis.as_ref().expect("fitted");
        let (object, plain) = name.split_once('.').expect("object.name");
        let value = analysis.fit.value(object, plain).expect("identified");
        let recordings = session.choice.given_to_all(&session.recordings);
        let world = world(analysis, &recordings, &[(name.to_owned(), factor * value)].into());
        residual_rms(&replay_forces(&world, &session.recordings)).expect("predicts")
    }

    #[test]
    fn a_wrong_weight_leaves_more_of_the_force_and_the_fitted_one_as_much_as_before() {
        for (recording, name) in [(STACK.clone(), "block-1.weight_N"), (CRANK.clone(), "crank.weight_N")] {
            let session = session(recording);
            let before = residual_rms(&session.replays).expect("predicts");
            let same = tried(&session, name, 1.0);
            assert!((same - before).abs() < 1e-9 + 1e-6 * before, "{name}: {same} and {before}");
            let heavy = tried(&session, name, 1.6);
            assert!(heavy > 1.1 * before, "{name}: {heavy} against {before}");
        }
    }
}
