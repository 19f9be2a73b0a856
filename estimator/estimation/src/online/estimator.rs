//! The estimator beside the servo.

use super::block::Blocks;
use super::crank::Crank;
use super::filter::{Filters, Sample};
use super::information::problem::Problem;
use super::information::{Enough, Wanted, judge};
use super::report::Report;
use super::settings::Settings;
use super::state_tracker::{Now, StateTracker};
use foundation::estimate::{EstimateError, Parameter};
use haptics::recording::Task;

#[derive(Clone, Debug)]
enum Body {
    Blocks(Box<Blocks>),
    Crank(Box<Crank>),
}

/// The estimator beside the servo.
#[derive(Clone, Debug)]
pub struct Online {
    filters: Filters,
    sense: StateTracker,
    body: Body,
    settings: Settings,
    now: Option<Now>,
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
        Ok(Self { filters, sense: StateTracker::new(task)?, body, settings, now: None })
    }

    /// Takes a sample; allocates, locks and waits for nothing. A sample with a number that is not finite is left out;
    /// after a gap in time the windows start again.
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

    /// Present estimates. Allocates.
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

    /// Information still missing for these parameters, by the data collected here.
    pub fn enough(&self, parameters: &[Parameter]) -> Vec<Enough> {
        judge(parameters, &self.problems(), &self.settings.wanted)
    }

    /// True if a crank's laws have rows; blocks are judged from the first sample on.
    pub(super) fn knows_something(&self) -> bool {
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
