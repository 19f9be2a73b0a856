//! Present state of the hand: the rules of the task on delayed signals, with biases and thresholds learned on the way.

use super::filter::{Filters, Sample};
use super::recursive::Recursive;
use crate::segment::rules::{Qualifier, beyond};
use crate::segment::threshold::Usual;
use foundation::estimate::EstimateError;
use foundation::tasks::definition::{Definition, Rules};
use foundation::tasks::{Sign, SystemState};
use haptics::Vec2;
use haptics::recording::Task;

/// Memory of the sensors' bias, seconds of free motion.
const BIAS_MEMORY_S: f64 = 20.0;
/// A zero of a sensor moves no farther than this, N, and no faster than this, N/s, on top.
const MOST_DRIFT_N: f64 = 0.1;
const MOST_DRIFT_N_S: f64 = 0.02;
/// Rows of free motion are so far apart, s.
pub(super) const FREE_ROW_S: f64 = 0.06;
/// Usual levels before anything was seen: they lead to the thesis's thresholds.
const START: Usual = Usual { force_noise_n: 0.003, net_n: 0.3, grip_n: 1.5, velocity_noise_m_s: 0.0, speed_m_s: 0.15 };

/// The state of the middle sample, and since when it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Now {
    pub(super) time_s: f64,
    pub(super) state: SystemState,
    pub(super) since_s: f64,
}

/// States and biases while samples come in.
#[derive(Clone, Debug)]
pub(super) struct StateTracker {
    rules: Rules,
    leave: f64,
    turns: bool,
    qualifier: Qualifier,
    signs: [Sign; 2],
    usual: Usual,
    now: Option<Now>,
    /// fx1 fy1 fx2 fy2 at rest.
    bias: [Recursive<1>; 4],
    /// Sum of the vertical ones, for its own error.
    lift_bias: Recursive<1>,
    next_free_s: f64,
    /// Least and largest of the four forces since a time: nothing held is so quiet.
    least: [f64; 4],
    most: [f64; 4],
    quiet_since_s: f64,
    /// Time of the last update of the bias, s.
    learned_s: f64,
}

impl StateTracker {
    pub(super) fn new(task: Task) -> Result<Self, EstimateError> {
        let definition = Definition::built_in(task)?;
        let blank = || Recursive::new([1.0], BIAS_MEMORY_S / FREE_ROW_S, 4);
        Ok(Self {
            rules: definition.rules(),
            leave: definition.thresholds.leave,
            turns: task == Task::Crank,
            qualifier: Qualifier::default(),
            signs: [Sign::Zero; 2],
            usual: START,
            now: None,
            bias: [blank(), blank(), blank(), blank()],
            lift_bias: blank(),
            next_free_s: f64::NEG_INFINITY,
            least: [f64::INFINITY; 4],
            most: [f64::NEG_INFINITY; 4],
            quiet_since_s: f64::NEG_INFINITY,
            learned_s: f64::NEG_INFINITY,
        })
    }

    /// Mean force of each finger at rest, N; zero before it was seen.
    pub(super) fn bias_n(&self) -> [Vec2; 2] {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k: usize| self.bias[k].values()[0]);
        [Vec2::new(a, b), Vec2::new(c, d)]
    }

    /// Sum of the vertical forces at rest and its standard error, N; `None` before it was seen for long enough.
    pub(super) fn lift_bias(&self) -> Option<(f64, f64)> {
        let error = self.lift_bias.std_errors()[0];
        error.is_finite().then(|| (self.lift_bias.values()[0], error))
    }

    /// Sum of both fingers' forces at rest, N, and the standard error of each of its components; `None` before it was seen for long
    /// enough.
    pub(super) fn net_bias(&self) -> Option<(Vec2, f64)> {
        let (lift, error) = self.lift_bias()?;
        let across_error = self.bias[0].std_errors()[0].hypot(self.bias[2].std_errors()[0]);
        let across = self.bias[0].values()[0] + self.bias[2].values()[0];
        across_error.is_finite().then(|| (Vec2::new(across, lift), error.max(across_error)))
    }

    /// Noise of the sum of the vertical forces from row to row, N.
    pub(super) fn lift_noise_n(&self) -> f64 {
        self.lift_bias.noise()
    }

    /// The state at the filters' middle. `learn` says once in a while that a free row was taken: time and vertical sum, N.
    pub(super) fn update(&mut self, filters: &Filters, free_row: &mut Option<(f64, f64)>) -> Now {
        let time_s = filters.time_s();
        let c = filters.calm(|s: &Sample| [s[8], s[9], s[10], s[11], 0.5 * (s[4] + s[6]), 0.5 * (s[5] + s[7])]);
        self.find_rest(time_s, [c[0], c[1], c[2], c[3]]);
        let bias = self.bias_n();
        let force = [Vec2::new(c[0], c[1]) - bias[0], Vec2::new(c[2], c[3]) - bias[1]];
        let velocity = Vec2::new(c[4], c[5]);
        self.learn_usual(force, velocity, filters.period_s());
        let limits = self.usual.thresholds();
        let state = if self.turns {
            let grip = force[0].x.min(-force[1].x);
            self.signs[0] = beyond(self.signs[0], grip, limits.force_n, self.leave);
            self.signs[1] = beyond(self.signs[1], velocity.norm(), limits.velocity_m_s, self.leave);
            self.rules.state(&[Some(self.signs[0]), Some(self.signs[1])])
        } else {
            self.rules.state(&self.qualifier.next(force, velocity, &limits, self.leave).values())
        };
        let since_s = self.now.filter(|n| n.state == state).map_or(time_s, |n| n.since_s);
        let now = Now { time_s, state, since_s };
        self.now = Some(now);
        // The very ends of free motion touch already. A crank's rule looks at the grip alone.
        let quiet = force.iter().all(|f| f.norm() < limits.force_n.max(0.03));
        if state == SystemState::FreeMotion && quiet && time_s - since_s > 0.15 && time_s >= self.next_free_s {
            self.next_free_s = time_s + FREE_ROW_S;
            self.learn_bias(time_s, [c[0], c[1], c[2], c[3]]);
            *free_row = Some((time_s, c[1] + c[3]));
        }
        now
    }

    /// Finds free motion by its quiet, because a bias that drifted during a hold would hide that the hand is free
    /// again. In free motion no force moves beyond the noise for a while, and there is hardly any grip. The mean is the
    /// bias then, whatever its value.
    fn find_rest(&mut self, time_s: f64, raw: [f64; 4]) {
        const QUIET_S: f64 = 0.4;
        const NOISES: f64 = 8.0;
        const HARDLY: f64 = 0.35;
        for ((least, most), value) in self.least.iter_mut().zip(&mut self.most).zip(raw) {
            (*least, *most) = (least.min(value), most.max(value));
        }
        let range = (0..4).map(|k| self.most[k] - self.least[k]).fold(0.0, f64::max);
        let grip = raw[0].min(-raw[2]) - self.bias[0].values()[0].min(-self.bias[2].values()[0]);
        let free = range < NOISES * self.usual.force_noise_n.max(5e-4) && grip.abs() < HARDLY * self.usual.grip_n;
        if !free {
            (self.least, self.most, self.quiet_since_s) = (raw, raw, time_s);
            return;
        }
        if time_s - self.quiet_since_s < QUIET_S {
            return;
        }
        let limit = 0.5 * self.usual.thresholds().force_n;
        let far = self.bias.iter().zip(raw).any(|(bias, value)| (value - bias.values()[0]).abs() > limit);
        let since_s = time_s - self.learned_s;
        let most = MOST_DRIFT_N + MOST_DRIFT_N_S * since_s;
        // One finger that presses on something is as quiet, but no zero moves so far so soon.
        let presses = self.bias.iter().zip(raw).any(|(bias, value)| (value - bias.values()[0]).abs() > most);
        if far && !(presses && since_s.is_finite()) {
            self.bias.iter_mut().for_each(Recursive::reset);
            self.lift_bias.reset();
            self.learn_bias(time_s, raw);
        }
        (self.least, self.most, self.quiet_since_s) = (raw, raw, time_s);
    }

    fn learn_bias(&mut self, time_s: f64, raw: [f64; 4]) {
        self.learned_s = time_s;
        for (bias, value) in self.bias.iter_mut().zip(raw) {
            bias.push(&[1.0], value, 1.0);
        }
        self.lift_bias.push(&[1.0], raw[1] + raw[3], 1.0);
        if self.lift_bias.rows() > 8 {
            self.usual.force_noise_n = self.bias.iter().map(Recursive::noise).fold(0.0, f64::max);
        }
    }

    /// Percentiles by stochastic approximation: up by p, down by 1 − p, in steps that are shares of themselves.
    fn learn_usual(&mut self, force: [Vec2; 2], velocity: Vec2, period_s: f64) {
        const PER_SECOND: f64 = 0.5;
        let step = PER_SECOND * period_s;
        let follow = |usual: &mut f64, value: f64, share: f64, low: f64, high: f64| {
            *usual = (*usual * (1.0 + step * if value > *usual { share } else { share - 1.0 })).clamp(low, high);
        };
        // Resting does not make the usual levels smaller.
        if force[0].norm() + force[1].norm() > 0.2 * self.usual.grip_n {
            follow(&mut self.usual.net_n, (force[0] + force[1]).y.abs(), 0.9, 0.02, 50.0);
            follow(&mut self.usual.grip_n, force[0].x.min(-force[1].x), 0.95, 0.2, 50.0);
        }
        if velocity.norm() > 0.1 * self.usual.speed_m_s {
            follow(&mut self.usual.speed_m_s, velocity.norm(), 0.95, 0.03, 2.0);
        }
    }
}
