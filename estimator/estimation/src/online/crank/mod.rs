//! A crank while it is turned: centre, radius and give first, then weight, friction and inertia along the circle.
//!
//! Signals, frame and laws are those of the batch fit ([`crate::identify::crank`]). The circle is found by recursion
//! ([`geometry`]). The laws' rows are made with the circle known when they began, and corrected to first order for its
//! later changes ([`laws`]).

mod candidates;
mod geometry;
mod laws;
pub(super) mod recorded;

use super::filter::{Filters, Sample};
use super::information::problem::Problem;
use super::report::{Event, Report};
use super::settings::Settings;
use super::state_tracker::{FREE_ROW_S, Now, StateTracker};
use crate::identify::crank::frame::{Handled, blur};
use crate::identify::crank::laws::NAMES;
use candidates::crank_problems;
use foundation::tasks::SystemState;
use geometry::Circle;
use haptics::Vec2;
use laws::Laws;

/// The ends of turning are left out, s.
const GUARD_S: f64 = 0.15;
/// Events that are kept.
const MOST_EVENTS: usize = 32;

/// One crank.
#[derive(Clone, Debug)]
pub struct Crank {
    circle: Circle,
    laws: Laws,
    events: Vec<Event>,
    /// Samples wait here until it has turned on for [`GUARD_S`].
    waiting: Vec<(f64, Handled)>,
    next: usize,
    waits: usize,
}

impl Crank {
    pub(super) fn new(settings: &Settings, filters: &Filters) -> Self {
        Self {
            circle: Circle::new(settings, filters.period_s()),
            laws: Laws::new(settings, filters.period_s()),
            events: Vec::with_capacity(MOST_EVENTS),
            waiting: vec![(0.0, Handled::default()); (GUARD_S / filters.period_s()).ceil().max(1.0) as usize],
            next: 0,
            waits: 0,
        }
    }

    pub(super) fn interrupt(&mut self) {
        self.waits = 0;
        self.laws.interrupt();
    }

    pub(super) fn update(&mut self, now: Now, filters: &Filters, sense: &StateTracker) {
        if now.state != SystemState::Turning || now.time_s - now.since_s < GUARD_S {
            self.interrupt();
            return;
        }
        let bias = sense.bias_n();
        let newest = (now.time_s, handled(filters, bias[0] + bias[1]));
        let (time_s, handled) = std::mem::replace(&mut self.waiting[self.next], newest);
        self.next = (self.next + 1) % self.waiting.len();
        if self.waits < self.waiting.len() {
            self.waits += 1;
            return;
        }
        let blur_m_s = blur(filters.velocity_noise() * filters.cubic_leaves());
        self.take(time_s, &handled, blur_m_s);
    }

    fn take(&mut self, time_s: f64, handled: &Handled, blur_m_s: f64) {
        if let Some(slip) = self.circle.push(time_s, handled) {
            // The circle that the fingers follow is another one now.
            self.note(Event {
                object: 0,
                parameter: "center_m",
                grows: slip.grows,
                noticed_s: slip.noticed_s,
                began_s: slip.began_s,
                before: 0.0,
            });
            self.laws.interrupt();
        }
        if let Some((law, change, before)) = self.laws.push(time_s, handled, &self.circle, blur_m_s) {
            let (noticed_s, began_s) = (change.noticed_s, change.began_s);
            self.note(Event { object: 0, parameter: NAMES[law], grows: change.grows, noticed_s, began_s, before });
        }
    }

    fn note(&mut self, event: Event) {
        if self.events.len() == MOST_EVENTS {
            self.events.remove(0);
        }
        self.events.push(event);
    }

    pub(super) fn report(&self, sense: &StateTracker, report: &mut Report) {
        report.parameters.extend(self.circle.parameters());
        report.parameters.extend(self.laws.parameters(&self.circle, sense.lift_bias()));
        report.events.extend_from_slice(&self.events);
    }

    pub(super) fn has_rows(&self) -> bool {
        self.circle.frame().is_some() && self.laws.fit().rows() > 0
    }

    pub(super) fn problems(&self, sense: &StateTracker) -> Vec<Problem> {
        let bias_error = sense.lift_bias().map(|(_, error)| error);
        crank_problems(&self.circle, &self.laws, bias_error, sense.lift_noise_n(), FREE_ROW_S)
    }
}

fn handled(filters: &Filters, bias_n: Vec2) -> Handled {
    let pick = |s: &Sample| {
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        [mean(s[0], s[2]), mean(s[1], s[3]), mean(s[4], s[6]), mean(s[5], s[7]), s[8] + s[10], s[9] + s[11]]
    };
    let [value, first, second] = filters.cubic(pick);
    let pair = |series: &[f64; 6], k: usize| Vec2::new(series[k], series[k + 1]);
    Handled {
        position: pair(&value, 0),
        velocity: pair(&value, 2),
        acceleration: pair(&first, 2),
        force: pair(&value, 4) - bias_n,
        force_rate: pair(&first, 4),
        force_bend: pair(&second, 4),
    }
}
