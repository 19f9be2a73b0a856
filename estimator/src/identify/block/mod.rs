//! Weight, width, height and friction of stacked blocks (thesis, tables 5.2 to 5.4), with standard errors.
//!
//! The thesis's formulas are means over a segment. Here each is the intercept of a small regression, so that what disturbed the
//! thesis's numbers is taken out where the recording shows it: accelerations from the weight, the give of the pads from the
//! width (it grew 7 % too narrow there) and from the height. Where the recording does not show it, the standard error says so.

mod friction_coefficient;
mod height_slip_correction;
pub(crate) mod heights;
mod joint_fit;
mod leak;
mod needed;
mod pad_stiffness;
pub(crate) mod placement_time;
pub(crate) mod slip_detection;
mod width;

use super::bootstrap::block_bootstrap;
use super::linear::{LinearFit, least_squares};
use super::robust::{RobustFit, robust};
use crate::constraint::{Carry, carried};
use crate::estimate::{Constraint, Correlated, EstimateError, Fit, Parameter};
use crate::segment::definition::Definition;
use crate::segment::threshold::{Levels, percentile};
use crate::segment::{Method, Segmentation, SystemState, Thresholds, by_hand, segment_signals_by, subtasks};
use crate::signal::noise::{quantum, resolution_error, white_noise};
use crate::signal::task::{TaskSignals, TipSeries, half_width, smooth, task_signals};
use haptics::Vec2;
use haptics::recording::{Recording, Task};
use heights::Stacked;
pub use joint_fit::{Together, fit_together};
pub(crate) use needed::needed_forces;
use pad_stiffness::{Give, pad_parameter};
pub(crate) use width::{Hold, holds, width_under};

/// Relative error of a width whose pad compression could not be measured: the thesis's blocks came out 7 % too narrow.
const UNKNOWN_COMPRESSION: f64 = 0.07;
/// The grip must vary by this share of its mean for the pads' give to be told from the width.
const LEAST_GRIP_VARIATION: f64 = 0.05;

/// The states that show this one are those in which a block is carried; they number the blocks.
pub(crate) const MAIN: &str = "weight_N";

/// Everything that the block fit (and the diagnosis of blocks) works on.
pub(crate) struct Blocks<'a> {
    pub(crate) signals: TaskSignals,
    pub(crate) levels: Levels,
    pub(crate) segmentation: Segmentation,
    task: Definition,
    pub(crate) recording: &'a Recording,
    /// Error of a single position and of a single force by the resolution of the log, m and N: what no averaging removes.
    resolution_m: f64,
    resolution_n: f64,
    /// Vertical acceleration of the grip, m/s².
    pub(crate) acceleration_y: Vec<f64>,
    /// Grip width and height, mean normal and summed vertical force, all through one and the same smoothing filter, and
    /// the rate of the width: m, N, m/s. Noise in a force would otherwise flatten the slope of a position against it.
    pub(crate) width: Vec<f64>,
    pub(crate) height: Vec<f64>,
    pub(crate) grip: Vec<f64>,
    pub(crate) lift: Vec<f64>,
    pub(crate) width_rate: Vec<f64>,
}

/// Fits the blocks of one recording, with `thresholds` or those chosen from its noise. The segmentation that was used comes
/// with the fit.
pub fn fit(recording: &Recording, thresholds: Option<Thresholds>) -> Result<(Fit, Segmentation), EstimateError> {
    fit_by(Method::Threshold, recording, thresholds)
}

/// [`fit`] with the states of either method.
pub fn fit_by(
    method: Method,
    recording: &Recording,
    thresholds: Option<Thresholds>,
) -> Result<(Fit, Segmentation), EstimateError> {
    let blocks = Blocks::of(method, recording, thresholds)?;
    let fit = describe(&blocks)?;
    Ok((fit, blocks.segmentation))
}

/// Why there is nothing to fit, and what to do.
fn nothing(blocks: &Blocks<'_>) -> EstimateError {
    let name = &blocks.recording.name;
    let slides = blocks.segmentation.states.iter().any(|s| s.state == SystemState::SlidingOnGround);
    EstimateError::Other(if slides {
        format!(
            "the block in {name} is slid and never lifted, so what it weighs does not show in what the fingers feel: lift it once to fit it; a \
             diagnosis tells what resists it on the table"
        )
    } else {
        format!(
            "no block was carried in {name}: there is nothing to fit; check the task and the signs of the forces, and that a state of the \
             task with a subtask shows {MAIN}"
        )
    })
}

/// All that one recording shows.
fn describe(blocks: &Blocks<'_>) -> Result<Fit, EstimateError> {
    let (count, recording) = (blocks.count(), blocks.recording);
    if count == 0 {
        return Err(nothing(blocks));
    }
    let mut parameters = Vec::new();
    let mut weights_n = Vec::new();
    let mut correlated = Vec::new();
    let mut warnings = blocks.segmentation.warnings.clone();
    let pad = blocks.pad_stiffness(count);
    for number in 1..=count {
        let weight = blocks.weight(number)?;
        correlated.extend(weight_and_mass(&weight[0], &weight[1]));
        weights_n.push(weight[0].value.unwrap_or(0.0));
        parameters.extend(weight);
        parameters.push(blocks.width(number, &pad)?);
    }
    if let Some(why) = blocks.unshown("height_m") {
        parameters.extend((1..=count).map(|n| Parameter::unidentified(&object(n), "height_m", 0, &why)));
    } else {
        let stacked = [Stacked::new(blocks, &weights_n)];
        warnings.extend(stacked[0].warnings());
        parameters.extend(heights::heights(&stacked)?);
    }
    parameters.push(pad);
    let masses_kg: Vec<f64> = weights_n.iter().map(|w| w / recording.meta.gravity()).collect();
    for number in 1..=count {
        parameters.extend(blocks.friction(number));
        parameters.extend(leak::leak(blocks, number, count, &masses_kg));
    }
    // Read by object: all of block 1, all of block 2, then the pads.
    parameters.sort_by(|a, b| a.object.cmp(&b.object));
    Ok(Fit {
        task: Task::BlockStack.name().to_owned(),
        parameters,
        constraints: (1..=count).filter_map(|number| blocks.constraint(number)).collect(),
        correlated,
        warnings,
        ..Fit::default()
    })
}

/// What the resolution leaves unknown of a mean, the largest among the components of a series of both fingers.
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

/// What the steps of the joint encoders leave unknown of a tip's mean position, m; 0 for a log of tip positions.
fn unresolved_by_joints_m(recording: &Recording) -> f64 {
    let finger = recording.meta.hand().fingers[0];
    let error = |name: &str| recording.channel(name).map_or(0.0, |q| resolution_error(quantum(q), white_noise(q)));
    ["qb1_rad", "qt1_rad", "qb2_rad", "qt2_rad"].into_iter().map(error).fold(0.0, f64::max) * finger.link_m
}

/// They are one thing: what is stated of either holds for both.
fn weight_and_mass(weight: &Parameter, mass: &Parameter) -> Option<Correlated> {
    let (a, b) = (weight.std_error?, mass.std_error?);
    Some(Correlated {
        parameters: vec![weight.full_name(), mass.full_name()],
        values: vec![weight.value?, mass.value?],
        covariance: vec![vec![a * a, a * b], vec![a * b, b * b]],
        shown_below: vec![f64::INFINITY; 2],
    })
}

pub(crate) fn object(number: usize) -> String {
    format!("block-{number}")
}

fn unseen(samples: &[usize]) -> Option<String> {
    samples.is_empty().then(|| "no sample of a state that shows it belongs to this block".to_owned())
}

impl<'a> Blocks<'a> {
    /// States and calmed signals of one recording.
    pub(crate) fn of(
        method: Method,
        recording: &'a Recording,
        thresholds: Option<Thresholds>,
    ) -> Result<Self, EstimateError> {
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
    pub(crate) fn count(&self) -> usize {
        (1..=subtasks::MOST_CARRIES).take_while(|n| !self.shown(MAIN, *n).is_empty()).count()
    }

    fn samples(&self, subtasks: &[String]) -> Vec<usize> {
        subtasks.iter().flat_map(|s| self.segmentation.samples_of(s)).collect()
    }

    /// Samples of a block in the states that the task says show a parameter.
    pub(crate) fn shown(&self, parameter: &str, number: usize) -> Vec<usize> {
        self.samples(&self.task.showing(parameter, MAIN, number))
    }

    /// Samples in which a block is gripped and the smoothed channels have seen nothing else: within half a window of where a finger touches or lets
    /// go they mix the way to the block with the grip on it, and pads would seem far too soft at first.
    pub(crate) fn gripped(&self, number: usize) -> Vec<usize> {
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
    fn unshown(&self, parameter: &str) -> Option<String> {
        let why = || format!("no state of the task {} shows {parameter}; add it to `shows` of one", self.task.name);
        (!self.task.is_shown(parameter)).then(why)
    }

    /// Samples a filter window apart: smoothed channels say nothing new in between, and errors counted from neighbours that
    /// share their noise come out too small.
    pub(crate) fn rows(&self, samples: &[usize]) -> Vec<usize> {
        const LEAST_ROWS: usize = 12;
        let window = 2 * half_width(&self.signals.time_s);
        let stride = window.min(samples.len() / LEAST_ROWS).max(1);
        samples.iter().copied().step_by(stride).collect()
    }

    /// Force of a finger without its bias, N.
    fn force(&self, finger: usize, i: usize) -> Vec2 {
        let raw = self.signals.tips[finger].force.as_ref().map_or_else(Vec2::zeros, |f| f[i]);
        raw - self.levels.bias_n[finger]
    }

    fn lift(&self, i: usize) -> f64 {
        self.force(0, i).y + self.force(1, i).y
    }

    /// Standard error of the sum of the vertical force biases, N, from the free phases.
    fn bias_error(&self) -> f64 {
        let sums: Vec<f64> = self.levels.free.iter().map(|i| self.lift(*i)).collect();
        let constant = vec![vec![1.0; sums.len()]];
        least_squares(&constant, &sums, None).map_or(self.levels.force_noise_n, |fit| fit.std_errors[0])
    }

    /// Whether anything but the hand held a block while it was carried.
    fn constraint(&self, number: usize) -> Option<Constraint> {
        carried(&Carry {
            object: &object(number),
            recording: &self.recording.name,
            signals: &self.signals,
            samples: &self.shown(MAIN, number),
            bias_n: self.levels.bias_n[0] + self.levels.bias_n[1],
            bias_error_n: self.bias_error().hypot(std::f64::consts::SQRT_2 * self.resolution_n),
            gravity: self.recording.meta.gravity(),
        })
    }

    /// Weight: mean of the summed vertical forces over the carry, accelerations taken out.
    fn weight(&self, number: usize) -> Result<[Parameter; 2], EstimateError> {
        let samples = self.shown(MAIN, number);
        let rows = self.rows(&samples);
        let lift: Vec<f64> = rows.iter().map(|i| self.lift[*i]).collect();
        let acceleration: Vec<f64> = rows.iter().map(|i| self.acceleration_y[*i]).collect();
        let columns = [vec![1.0; rows.len()], acceleration];
        let RobustFit { fit, weights, left_out } = robust(&columns, &lift, None)?;
        let systematic = self.bias_error().hypot(std::f64::consts::SQRT_2 * self.resolution_n);
        let error = fit.std_errors[0].hypot(systematic);
        let resampled = block_bootstrap(&columns, &lift, weights.as_deref(), &fit).map(|b| b[0].hypot(systematic));
        let gravity = self.recording.meta.gravity();
        let (name, n) = (object(number), samples.len());
        let ringing = if left_out > 0.0 {
            format!("; the contacts rang in {:.1} % of the samples, which do not count", 100.0 * left_out)
        } else {
            String::new()
        };
        let how = format!(
            "mean of the summed vertical tip forces while carried, 5 % at each end left out, accelerations and the free-motion bias \
             taken out{ringing}"
        );
        let mass = "weight divided by gravity";
        Ok([
            Parameter::identified(&name, "weight_N", fit.values[0], error, n, &how).with_bootstrap(resampled),
            Parameter::identified(&name, "mass_kg", fit.values[0] / gravity, error / gravity, n, mass)
                .with_bootstrap(resampled.map(|b| b / gravity)),
        ])
    }

    /// Stiffness of one pad: both give under the grip, so the width falls by 2 F / k. Blocks averaged by their errors.
    fn pad_stiffness(&self, count: usize) -> Parameter {
        let gives = (1..=count).filter_map(|number| self.pads(number).ok()?).map(|pads| Give {
            m_per_n: pads.give_m_per_n,
            error: pads.give_error,
            resampled: pads.resampled.map(|(_, give)| give),
            rows: pads.rows,
        });
        pad_parameter("stiffness_N_m", gives, "the grip varied too little to tell the pads' give")
    }

    /// Half the difference of the two fingers' height change between two sets of samples, m.
    pub(crate) fn finger_disagreement(&self, before: &[usize], after: &[usize]) -> f64 {
        let mean = |finger: usize, set: &[usize]| {
            set.iter().map(|i| self.signals.tips[finger].position[*i].y).sum::<f64>() / set.len() as f64
        };
        let change = |finger: usize| mean(finger, after) - mean(finger, before);
        0.5 * (change(0) - change(1)).abs()
    }

    /// Largest ratio of tangential to normal tip force while grasped: a lower bound of the friction coefficient.
    fn friction(&self, number: usize) -> [Parameter; 2] {
        let name = object(number);
        if let Some(why) = self.unshown("friction_lower_bound") {
            return ["friction_lower_bound", "friction"].map(|f| Parameter::unidentified(&name, f, 0, &why));
        }
        let samples = self.shown("friction_lower_bound", number);
        let (mean_grip, _) = mean_and_spread(&samples.iter().map(|i| self.grip[*i]).collect::<Vec<_>>());
        let noise = self.levels.force_noise_n;
        // Below this grip the ratio is noise.
        let least = (10.0 * noise).max(0.25 * mean_grip);
        let mut best: Option<(f64, f64)> = None;
        for finger in 0..2 {
            for i in &samples {
                let force = self.mean_force(finger, *i);
                let normal = if finger == 0 { force.x } else { -force.x };
                if normal > least {
                    let ratio = force.y.abs() / normal;
                    let error = noise * ratio.hypot(1.0) / normal;
                    // What is certainly reached counts: the largest of many noisy ratios would overshoot.
                    if best.is_none_or(|(r, e)| ratio - 2.0 * error > r - 2.0 * e) {
                        best = Some((ratio, error));
                    }
                }
            }
        }
        let held = best.map_or(0.0, |(ratio, error)| ratio - 2.0 * error);
        let slip = match self.slip(number, held) {
            Some(slip) => {
                let how = format!(
                    "shear over normal force of both fingers at the onset of a slip, the first at {:.2} s",
                    slip.at_s
                );
                Parameter::identified(&name, "friction", slip.coefficient, slip.error, slip.samples, &how)
                    .with_bootstrap(slip.resampled)
            }
            None => Parameter::unidentified(
                &name,
                "friction",
                samples.len(),
                "the fingers never slipped: only a lower bound is given; loosen the pinch until the block slides",
            ),
        };
        let bound = match best {
            Some((ratio, error)) => Parameter::identified(
                &name,
                "friction_lower_bound",
                // The largest of many noisy ratios lies about one error too high.
                (ratio - error).max(0.0),
                error,
                samples.len(),
                "largest ratio of vertical to horizontal tip force while grasped; true friction is at least this",
            ),
            None => Parameter::unidentified(&name, "friction_lower_bound", 0, "the grip was never firm enough to tell"),
        };
        [bound, slip]
    }

    /// Friction where the fingers slipped on a block, from gripping it to shortly after it was put down or lost.
    fn slip(&self, number: usize, ratio: f64) -> Option<friction_coefficient::Slip> {
        const NOISES: f64 = 8.0;
        const AFTER_S: f64 = 0.3;
        let carried = self.shown(MAIN, number);
        let mut lifts: Vec<f64> = carried.iter().map(|i| self.lift[*i]).collect();
        // The middle one: a slip at the end of the carry does not count.
        let weight_n = percentile(&mut lifts, 0.5);
        let grasp = self.shown("friction", number);
        let time = &self.signals.time_s;
        let end = time.partition_point(|t| *t < grasp.last().map_or(0.0, |i| time[*i]) + AFTER_S);
        let least_grip_n = NOISES * self.levels.force_noise_n;
        friction_coefficient::slip(
            self,
            *grasp.first()?,
            end,
            friction_coefficient::Held { weight_n, least_grip_n, ratio },
        )
    }

    /// Tip force averaged over 60 ms about a sample, N: sensor noise falls, friction does not change that fast.
    fn mean_force(&self, finger: usize, i: usize) -> Vec2 {
        const HALF_S: f64 = 0.03;
        let time = &self.signals.time_s;
        let first = time[..i].partition_point(|t| *t < time[i] - HALF_S);
        let mut end = i + 1;
        while end < time.len() && time[end] <= time[i] + HALF_S {
            end += 1;
        }
        (first..end).map(|j| self.force(finger, j)).sum::<Vec2>() / (end - first) as f64
    }
}

/// Least squares of `rhs` on a constant and `columns` (each centred on nothing: the constant is the value where all are zero).
fn intercept(rhs: &[f64], columns: &[Vec<f64>]) -> Result<LinearFit, EstimateError> {
    let mut all = vec![vec![1.0; rhs.len()]];
    all.extend_from_slice(columns);
    least_squares(&all, rhs, None)
}

fn mean_and_spread(values: &[f64]) -> (f64, f64) {
    let n = values.len().max(1) as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / n).sqrt())
}
