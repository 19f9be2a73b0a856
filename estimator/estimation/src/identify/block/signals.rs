//! Signals of a recording of blocks: states, calmed channels, and the samples that show a parameter of a block.

use crate::identify::limits::LEAST_FIT_ROWS;
use crate::regression::linear::least_squares;
use crate::segment::threshold::Levels;
use crate::segment::{Method, Segmentation, by_hand, segment_signals_by};
use foundation::estimate::EstimateError;
use foundation::signal::noise::{quantum, resolution_error, white_noise};
use foundation::signal::task::{TaskSignals, TipSeries, half_width, smooth, task_signals};
use foundation::tasks::Thresholds;
use foundation::tasks::definition::{Definition, MOST_CARRIES};
use haptics::Vec2;
use haptics::recording::{Recording, Task};

/// The states that show this one are those in which a block is carried; they number the blocks.
pub const MAIN: &str = "weight_N";

/// Everything that the block fit (and the diagnosis of blocks) works on.
pub struct Blocks<'a> {
    /// Signals of the task.
    pub signals: TaskSignals,
    /// Bias and noise of the forces.
    pub levels: Levels,
    /// States and subtasks.
    pub segmentation: Segmentation,
    pub(super) task: Definition,
    /// The recording itself.
    pub recording: &'a Recording,
    /// Error of a single position and of a single force by the resolution of the log, m and N: averaging does not
    /// remove it.
    pub(super) resolution_m: f64,
    pub(super) resolution_n: f64,
    /// Vertical acceleration of the grip, m/s².
    pub acceleration_y: Vec<f64>,
    /// Grip width, m. It, the height, the grip, the lift, and the rate of the width pass through one and the same smoothing
    /// filter. Noise in a force would otherwise flatten the slope of a position against it.
    pub width: Vec<f64>,
    /// Grip height, m.
    pub height: Vec<f64>,
    /// Mean normal force, N.
    pub grip: Vec<f64>,
    /// Summed vertical force, N.
    pub lift: Vec<f64>,
    /// Rate of the grip width, m/s.
    pub width_rate: Vec<f64>,
}

/// Error of a mean by the resolution, the largest among the components of a series of both fingers.
fn unresolved(signals: &TaskSignals, series: impl Fn(&TipSeries) -> Option<&Vec<Vec2>>) -> f64 {
    let error = |pick: fn(&Vec2) -> f64| {
        let of = |tip| {
            series(tip).map_or(0.0, |s: &Vec<Vec2>| {
                let values: Vec<f64> = s.iter().map(pick).collect();
                resolution_error(quantum(&values), white_noise(&values))
            })
        };
        of(&signals.tips[0]).max(of(&signals.tips[1]))
    };
    error(|v| v.x).max(error(|v| v.y))
}

/// Error of a tip's mean position by the steps of the joint encoders, m; 0 for a log of tip positions.
fn unresolved_by_joints_m(recording: &Recording) -> f64 {
    let finger = recording.meta.hand().fingers[0];
    let error = |name: &str| recording.channel(name).map_or(0.0, |q| resolution_error(quantum(q), white_noise(q)));
    ["qb1_rad", "qt1_rad", "qb2_rad", "qt2_rad"].into_iter().map(error).fold(0.0, f64::max) * finger.link_m
}

/// Name of a block in the results.
pub fn object(number: usize) -> String {
    format!("block-{number}")
}

impl<'a> Blocks<'a> {
    /// States and calmed signals of one recording.
    pub fn of(method: Method, recording: &'a Recording, thresholds: Option<Thresholds>) -> Result<Self, EstimateError> {
        let signals = task_signals(recording)?;
        let task = Definition::of(recording, Task::BlockStack)?;
        let segmentation = segment_signals_by(method, &signals, &task, thresholds)?;
        let segmentation = by_hand::put(segmentation, recording, &signals.time_s);
        let levels = Levels::of(&signals);
        let vertical: Vec<f64> = signals.velocity.iter().map(|v| v.y).collect();
        let acceleration_y = smooth(&signals.time_s, &vertical).slope;
        let width = smooth(&signals.time_s, &signals.grip_width_m);
        let normal = |finger: usize, i: usize| {
            signals.tips[finger].force.as_ref().map_or(0.0, |f| f[i].x) - levels.bias_n[finger].x
        };
        let grip: Vec<f64> = (0..signals.len()).map(|i| 0.5 * (normal(0, i) - normal(1, i))).collect();
        let grip = smooth(&signals.time_s, &grip).value;
        let bias_y = levels.bias_n[0].y + levels.bias_n[1].y;
        let lift: Vec<f64> = signals.net_force_n.iter().map(|f| f.y - bias_y).collect();
        let lift = smooth(&signals.time_s, &lift).value;
        let height: Vec<f64> = signals.position.iter().map(|p| p.y).collect();
        let height = smooth(&signals.time_s, &height).value;
        Ok(Self {
            resolution_m: unresolved(&signals, |tip| Some(&tip.position)).max(unresolved_by_joints_m(recording)),
            resolution_n: unresolved(&signals, |tip| tip.force.as_ref()),
            levels,
            segmentation,
            task,
            recording,
            acceleration_y,
            width: width.value,
            height,
            grip,
            lift,
            width_rate: width.slope,
            signals,
        })
    }

    /// Blocks that were seen carried.
    pub fn count(&self) -> usize {
        (1..=MOST_CARRIES).take_while(|n| !self.shown(MAIN, *n).is_empty()).count()
    }

    pub(super) fn samples(&self, subtasks: &[String]) -> Vec<usize> {
        subtasks.iter().flat_map(|s| self.segmentation.samples_of(s)).collect()
    }

    /// Samples of a block in the states that the task says show a parameter.
    pub fn shown(&self, parameter: &str, number: usize) -> Vec<usize> {
        self.samples(&self.task.showing(parameter, MAIN, number))
    }

    /// Samples in which a block is gripped and the smoothed channels have seen nothing else. Within half a window of
    /// the beginning or end of a touch they mix the way to the block with the grip on it, and pads would seem far too
    /// soft at first.
    pub fn gripped(&self, number: usize) -> Vec<usize> {
        let least_n = self.segmentation.thresholds.force_n;
        let presses =
            |finger: usize, i: usize| self.force(finger, i).x * if finger == 0 { 1.0 } else { -1.0 } > least_n;
        let n = self.signals.len();
        // Samples up to each one in which a finger does not press.
        let mut loose = vec![0_usize; n + 1];
        (0..n).for_each(|i| loose[i + 1] = loose[i] + usize::from(!(presses(0, i) && presses(1, i))));
        let apart = half_width(&self.signals.time_s) + 1;
        let settled = |i: &usize| loose[i.saturating_sub(apart)] == loose[(i + apart + 1).min(n)];
        self.shown("width_m", number).into_iter().filter(settled).collect()
    }

    /// Why a parameter cannot be found: no state of the task shows it.
    pub(super) fn unshown(&self, parameter: &str) -> Option<String> {
        let why = || format!("no state of the task {} shows {parameter}; add it to `shows` of one", self.task.name);
        (!self.task.is_shown(parameter)).then(why)
    }

    /// Samples a filter window apart: smoothed channels say nothing new in between, and errors counted from neighbours
    /// that share their noise are too small.
    pub fn rows(&self, samples: &[usize]) -> Vec<usize> {
        let window = 2 * half_width(&self.signals.time_s);
        let stride = window.min(samples.len() / LEAST_FIT_ROWS).max(1);
        samples.iter().copied().step_by(stride).collect()
    }

    /// Force of a finger without its bias, N.
    pub(super) fn force(&self, finger: usize, i: usize) -> Vec2 {
        let raw = self.signals.tips[finger].force.as_ref().map_or_else(Vec2::zeros, |f| f[i]);
        raw - self.levels.bias_n[finger]
    }

    pub(super) fn lift(&self, i: usize) -> f64 {
        self.force(0, i).y + self.force(1, i).y
    }

    /// Standard error of the sum of the vertical force biases, N, from the free phases.
    pub(super) fn bias_error(&self) -> f64 {
        let sums: Vec<f64> = self.levels.free.iter().map(|i| self.lift(*i)).collect();
        let constant = vec![vec![1.0; sums.len()]];
        least_squares(&constant, &sums, None).map_or(self.levels.force_noise_n, |fit| fit.std_errors[0])
    }

    /// Half the difference of the two fingers' height change between two sets of samples, m.
    pub fn finger_disagreement(&self, before: &[usize], after: &[usize]) -> f64 {
        let mean = |finger: usize, set: &[usize]| {
            set.iter().map(|i| self.signals.tips[finger].position[*i].y).sum::<f64>() / set.len() as f64
        };
        let change = |finger: usize| mean(finger, after) - mean(finger, before);
        0.5 * (change(0) - change(1)).abs()
    }
}

pub(super) fn mean_and_spread(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt())
}
