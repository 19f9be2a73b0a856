//! Estimates while it happens, and what is still missing for them.
//!
//! [`Online`] takes one sample after the other, from the servo or from a log. Its signals are those of the batch fit, delayed by half a
//! window instead of looking ahead ([`filter`]); states come from the task's own rules ([`sense`]); rows go into square-root
//! recursions ([`recursive`]) that a detector watches ([`change`]). A sample allocates nothing; a [`Report`] does. `docs/online.md`.

pub mod block;
pub mod change;
pub mod crank;
mod decimating_store;
pub mod filter;
mod grasp_record;
pub mod information;
pub mod leak;
pub mod recursive;
mod replay;
mod state_tracker;
#[cfg(test)]
mod tests;
mod triangular;

use crate::estimate::{EstimateError, Parameter};
use block::Blocks;
pub use block::pull::{Anchor, Pull};
use crank::Crank;
use filter::{Filters, Sample};
use haptics::recording::Task;
use information::{Enough, Problem, Wanted};
use leak::LeakAnswer;
pub use replay::{enough_for, replay};
use serde::Serialize;
use state_tracker::Sense;

/// What may be chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Time after which what is excited all the while is forgotten, s; infinite: never.
    pub memory_s: f64,
    /// Most false alarms of the change detectors of one object, an hour.
    pub false_alarms_per_hour: f64,
    /// Gravity, m/s², positive.
    pub gravity_m_s2: f64,
    /// Wanted accuracies.
    pub wanted: Wanted,
}

impl Default for Settings {
    fn default() -> Self {
        Self { memory_s: 120.0, false_alarms_per_hour: 0.2, gravity_m_s2: 9.81, wanted: Wanted::default() }
    }
}

/// A change that was noticed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Event {
    /// Which object, from 0.
    pub object: usize,
    /// Name of the parameter.
    pub parameter: &'static str,
    /// Whether it grew.
    pub grows: bool,
    /// When it was noticed, s.
    pub noticed_s: f64,
    /// When it began, s.
    pub began_s: f64,
    /// Value before, in the parameter's unit.
    pub before: f64,
}

/// What is known now.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Time of the newest state, s.
    pub time_s: f64,
    /// The state, by its name.
    pub state: &'static str,
    /// Parameters of all objects, as a fit reports them.
    pub parameters: Vec<Parameter>,
    /// What is still missing for them.
    pub enough: Vec<Enough>,
    /// Changes, oldest first.
    pub events: Vec<Event>,
    /// Object and answer, where a weight changes.
    pub leaks: Vec<(String, LeakAnswer)>,
    /// Share of the largest shear that surely held which is free now; below zero it may slip. Absent while nothing is held.
    pub slip_margin: Option<f64>,
    /// What is held now.
    pub held: Option<String>,
    /// What else holds an object.
    pub pulls: Vec<Pull>,
}

#[derive(Clone, Debug)]
enum Body {
    Blocks(Box<Blocks>),
    Crank(Box<Crank>),
}

/// The estimator beside the servo.
#[derive(Clone, Debug)]
pub struct Online {
    filters: Filters,
    sense: Sense,
    body: Body,
    settings: Settings,
    now: Option<state_tracker::Now>,
}

impl Online {
    /// For samples `period_s` seconds apart. Errors: a task without on-line estimates, or an impossible period.
    pub fn new(task: Task, period_s: f64, settings: Settings) -> Result<Self, EstimateError> {
        if !(period_s > 0.0 && period_s < 1.0) {
            return Err(EstimateError::Other(format!(
                "an estimate beside the servo needs samples less than a second apart, not {period_s} s"
            )));
        }
        let filters = Filters::new(period_s);
        let body = match task {
            Task::BlockStack | Task::Barrel => Body::Blocks(Box::new(Blocks::new(
                task,
                &settings,
                filters.smooth_samples() as f64 * filters.period_s(),
            ))),
            Task::Crank => Body::Crank(Box::new(Crank::new(&settings, &filters))),
            other => {
                return Err(EstimateError::Other(format!(
                    "the task {} has no estimates while it happens; blocks, barrels and cranks have",
                    other.name()
                )));
            }
        };
        Ok(Self { filters, sense: Sense::new(task)?, body, settings, now: None })
    }

    /// Takes a sample; allocates, locks and waits for nothing. A sample with a number that is not finite is left out, after a hole in
    /// time the windows start anew.
    pub fn push(&mut self, time_s: f64, sample: &Sample) {
        if !(time_s.is_finite() && sample.iter().all(|v| v.is_finite())) {
            return;
        }
        match self.filters.push(time_s, sample) {
            Some(true) => {}
            Some(false) => return,
            None => {
                match &mut self.body {
                    Body::Blocks(blocks) => blocks.interrupt(),
                    Body::Crank(crank) => crank.interrupt(),
                }
                return;
            }
        }
        let mut free_row = None;
        let now = self.sense.update(&self.filters, &mut free_row);
        self.now = Some(now);
        match &mut self.body {
            Body::Blocks(blocks) => blocks.update(now, &self.filters, &self.sense, free_row),
            Body::Crank(crank) => crank.update(now, &self.filters, &self.sense),
        }
    }

    /// Other accuracies are wanted from now on.
    pub fn want(&mut self, wanted: Wanted) {
        self.settings.wanted = wanted;
    }

    /// What is known now. Allocates.
    pub fn report(&self) -> Report {
        let Some(now) = self.now else { return Report { state: "no-state", ..Report::default() } };
        let mut report = Report { time_s: now.time_s, state: now.state.name(), ..Report::default() };
        match &self.body {
            Body::Blocks(blocks) => blocks.report(&self.sense, &mut report),
            Body::Crank(crank) => crank.report(&self.sense, &mut report),
        }
        report.enough = self.enough(&report.parameters);
        report
    }

    /// What is missing for these parameters, by the information that was collected here.
    pub fn enough(&self, parameters: &[Parameter]) -> Vec<Enough> {
        information::judge(parameters, &self.problems(), &self.settings.wanted)
    }

    /// Whether a crank's laws have rows; blocks are judged from the first sample on.
    fn knows_something(&self) -> bool {
        match &self.body {
            Body::Blocks(_) => true,
            Body::Crank(crank) => crank.has_rows(),
        }
    }

    fn problems(&self) -> Vec<Problem> {
        match &self.body {
            Body::Blocks(blocks) => blocks.problems(&self.sense),
            Body::Crank(crank) => crank.problems(&self.sense),
        }
    }
}
