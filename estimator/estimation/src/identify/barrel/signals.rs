//! Signals of a two-fingered recording of a barrel: motion, net force and grip, all through one filter, and the samples
//! in which it was held.

use crate::identify::limits::LEAST_FIT_ROWS;
use crate::identify::pads::SOFTEST;
use crate::segment::threshold::{Levels, percentile};
use crate::segment::{Method, Segmentation, by_hand, segment_signals_by};
use foundation::estimate::EstimateError;
use foundation::signal::noise::{quantum, resolution_error, white_noise};
use foundation::signal::task::{TaskSignals, half_width, smooth, task_signals};
use foundation::tasks::Thresholds;
use foundation::tasks::definition::{Definition, MOST_CARRIES};
use haptics::Vec2;
use haptics::recording::{Recording, Task};

/// Share of its height from which a lift counts: below it the floor may still carry a part.
/// Choice: no case of the ablation reads it.
const CLEAR_OF_FLOOR: f64 = 0.25;

/// The recording of a barrel.
pub struct Signals {
    /// The task's signals as they are.
    pub task: TaskSignals,
    /// Sample times, s.
    pub time_s: Vec<f64>,
    /// Middle of the tips, m, and its acceleration, m/s².
    pub position: Vec<Vec2>,
    /// m/s².
    pub acceleration: Vec<Vec2>,
    /// Rate of `position` as it is filtered, m/s.
    pub velocity: Vec<Vec2>,
    /// Sum of the tip forces without their bias, N, and its rate, N/s.
    pub net_n: Vec<Vec2>,
    /// N/s.
    pub net_rate: Vec<Vec2>,
    /// Height of the right tip above the left one, m.
    pub rise_m: Vec<f64>,
    /// Forces of the left and of the right finger without their bias, N.
    pub finger_n: [Vec<Vec2>; 2],
    /// Distance of the tips, m, and its rate, m/s.
    pub width_m: Vec<f64>,
    /// m/s.
    pub width_rate: Vec<f64>,
    /// Mean normal force of the two fingers, N.
    pub grip_n: Vec<f64>,
    /// Shear over normal force of the finger that has more of it; 0 without a grip.
    pub ratio: Vec<f64>,
    /// Force channels at rest.
    pub levels: Levels,
    /// States and subtasks found.
    pub segmentation: Segmentation,
    /// Error of a mean by the resolution, m.
    pub resolution_m: f64,
    /// Error of a mean by the resolution, N.
    pub resolution_n: f64,
    stride: usize,
}

impl Signals {
    /// Reads and segments a recording.
    pub fn of(method: Method, recording: &Recording, thresholds: Option<Thresholds>) -> Result<Self, EstimateError> {
        let signals = task_signals(recording)?;
        let definition = Definition::of(recording, Task::Barrel)?;
        let segmentation = segment_signals_by(method, &signals, &definition, thresholds)?;
        let segmentation = by_hand::put(segmentation, recording, &signals.time_s);
        let levels = Levels::of(&signals);
        let time_s = signals.time_s.clone();
        let value = |series: Vec<f64>| smooth(&time_s, &series).value;
        let axis = |series: &[Vec2], k: usize| series.iter().map(|v| v[k]).collect::<Vec<f64>>();
        let pair = |series: &[Vec2]| zip(&value(axis(series, 0)), &value(axis(series, 1)));
        let slope = |series: &[Vec2]| {
            let [x, y] = [0, 1].map(|k| smooth(&time_s, &axis(series, k)).slope);
            zip(&x, &y)
        };
        let forces = [0, 1].map(|f| pair(signals.tips[f].force.as_deref().unwrap_or(&[])));
        let force = |f: usize, i: usize| forces[f][i] - levels.bias_n[f];
        let every = |f: &dyn Fn(usize) -> f64| (0..time_s.len()).map(f).collect::<Vec<f64>>();
        let width = smooth(&time_s, &signals.grip_width_m);
        let least_n = 0.1 * levels.usual_grip_n;
        let ratio = |i: usize| {
            let of = |f: usize| {
                let normal = [1.0, -1.0][f] * force(f, i).x;
                if normal > least_n { force(f, i).y.abs() / normal } else { 0.0 }
            };
            of(0).max(of(1))
        };
        Ok(Self {
            position: pair(&signals.position),
            velocity: slope(&signals.position),
            acceleration: slope(&signals.velocity),
            net_rate: slope(&signals.net_force_n),
            net_n: (0..time_s.len()).map(|i| force(0, i) + force(1, i)).collect(),
            grip_n: every(&|i| 0.5 * (force(0, i).x - force(1, i).x)),
            ratio: every(&ratio),
            rise_m: value(zip_with(
                &axis(&signals.tips[1].position, 1),
                &axis(&signals.tips[0].position, 1),
                |r, l| r - l,
            )),
            finger_n: [0, 1].map(|f| (0..time_s.len()).map(|i| force(f, i)).collect()),
            width_m: width.value,
            width_rate: width.slope,
            resolution_m: unresolved(&signals, |s, f, k| axis(&s.tips[f].position, k)),
            resolution_n: unresolved(&signals, |s, f, k| axis(s.tips[f].force.as_deref().unwrap_or(&[]), k)),
            stride: 2 * half_width(&time_s),
            levels,
            segmentation,
            time_s,
            task: signals,
        })
    }

    /// Noise of the net force as it is filtered, N.
    pub fn net_noise_n(&self) -> f64 {
        let samples = (self.stride + 1) as f64;
        std::f64::consts::SQRT_2 * (self.levels.force_noise_n / samples.sqrt()).hypot(self.resolution_n)
    }

    /// Noise of the tips' middle as it is filtered, m.
    pub fn place_noise_m(&self) -> f64 {
        let tips = |f: usize| white_noise(&self.task.tips[f].position.iter().map(|p| p.y).collect::<Vec<f64>>());
        0.5 * tips(0).hypot(tips(1)) / ((self.stride + 1) as f64).sqrt()
    }

    /// Half of the filter's window, s.
    pub fn reach_s(&self) -> f64 {
        let n = self.time_s.len();
        0.5 * self.stride as f64 * (self.time_s[n - 1] - self.time_s[0]) / (n - 1).max(1) as f64
    }

    /// Number of the lifts that were seen.
    pub fn lifts(&self) -> usize {
        (1..=MOST_CARRIES)
            .take_while(|n| !self.segmentation.samples_of(&format!("carry-barrel-{n}")).is_empty())
            .count()
    }

    /// Samples while held, from the first grip to letting go, in all lifts.
    pub fn held(&self) -> Vec<usize> {
        let of = |n: usize| ["pick-up", "carry", "place"].map(|verb| format!("{verb}-barrel-{n}"));
        (1..=self.lifts()).flat_map(of).flat_map(|name| self.segmentation.samples_of(&name)).collect()
    }

    /// Samples of every lift in which the barrel hangs from the fingers (and the cable), clear of the floor.
    pub fn hanging(&self) -> Vec<Vec<usize>> {
        let lift = |n: usize| {
            let samples = self.segmentation.samples_of(&format!("carry-barrel-{n}"));
            let height = |i: &usize| self.position[*i].y;
            let low = samples.iter().map(height).fold(f64::INFINITY, f64::min);
            let high = samples.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
            let mut lift: Vec<f64> = samples.iter().map(|i| self.net_n[*i].y).collect();
            let mut grip: Vec<f64> = samples.iter().map(|i| self.grip_n[*i]).collect();
            let grip_n = percentile(&mut grip, 0.5).max(f64::MIN_POSITIVE);
            let stretched = 0.5 * SOFTEST * self.task.object_m() * percentile(&mut lift, 0.5) / grip_n;
            let clear = |i: &usize| self.position[*i].y > low + stretched.min(CLEAR_OF_FLOOR * (high - low));
            let first = samples.iter().position(&clear).unwrap_or(0);
            let end = samples.iter().rposition(clear).map_or(0, |k| k + 1);
            samples[first.min(end)..end].to_vec()
        };
        (1..=self.lifts()).map(lift).collect()
    }

    /// Samples a filter window apart: neighbours share their noise.
    pub fn rows(&self, samples: &[usize]) -> Vec<usize> {
        let stride = self.stride.min(samples.len() / LEAST_FIT_ROWS).max(1);
        samples.iter().copied().step_by(stride).collect()
    }
}

fn zip_with(a: &[f64], b: &[f64], of: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| of(*a, *b)).collect()
}

fn zip(x: &[f64], y: &[f64]) -> Vec<Vec2> {
    x.iter().zip(y).map(|(x, y)| Vec2::new(*x, *y)).collect()
}

/// The largest error that rounding leaves in a mean, among both axes of both fingers.
fn unresolved(signals: &TaskSignals, channel: impl Fn(&TaskSignals, usize, usize) -> Vec<f64>) -> f64 {
    let of = |(f, k)| {
        let values = channel(signals, f, k);
        resolution_error(quantum(&values), white_noise(&values))
    };
    [(0, 0), (0, 1), (1, 0), (1, 1)].map(of).into_iter().fold(0.0, f64::max)
}
