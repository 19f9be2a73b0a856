//! Both joints of a chain as recorded: rates from one light filter, and every regressor of the model through one more.

use crate::identify::mechanism::regress::STICKING_SHARE;
use crate::identify::mechanism::resampling::Resampled;
use crate::identify::mechanism::signals::DERIVATIVE_NOISE;
use crate::identify::mechanism::signals::{direction, noise_blur, saturated, uninterrupted};
use foundation::estimate::EstimateError;
use foundation::signal::chain::{ANGLES, TORQUES};
use foundation::signal::derive::stencil;
use foundation::signal::filter::{MAX_CUTOFF_SHARE, derivative_noise, edge_samples, low_pass};
use haptics::law::object::{TWO_LINK, TwoLinkMotion};
use haptics::recording::Recording;
use std::f64::consts::TAU;

/// Number of rows in a period of the cut-off: closer neighbours repeat each other.
/// Choice: no case of the ablation reads it.
const ROWS_A_PERIOD: f64 = 4.0;

/// One segment of a recording without a gap.
pub struct Joints {
    /// Index of the recording.
    pub recording: usize,
    motion: Vec<TwoLinkMotion>,
    torque: [Vec<f64>; 2],
    usable: Vec<bool>,
    rate_hz: f64,
    /// Cut-off of the filter before rates are taken, Hz.
    pub light_hz: f64,
    gravity: f64,
    /// Probability that each joint sticks, 0 … 1, sample by sample.
    sticking: [Vec<f64>; 2],
    /// Place of the first sample in its recording, and of one sample, 0 … 1.
    place: (f64, f64),
}

/// Rows of one joint in one segment: the model's regressors and the torque.
pub struct JointRows {
    /// First joint: 0.
    pub joint: usize,
    /// One column a parameter.
    pub columns: Vec<Vec<f64>>,
    /// Torque, N m.
    pub torque: Vec<f64>,
    /// Share of the friction that may be missing because the joint sticks, squared.
    pub doubt: Vec<f64>,
    /// Place in the recording, 0 … 1.
    pub place: Vec<f64>,
}

/// All segments of one recording.
pub fn joints(recording: &Recording, index: usize) -> Result<Vec<Joints>, EstimateError> {
    let missing = |column: &str| EstimateError::MissingColumn {
        task: "a chain of two links".to_owned(),
        column: column.to_owned(),
        recording: recording.name.clone(),
    };
    let channel = |name: &str| recording.channel(name).ok_or_else(|| missing(name));
    let time = recording.time_s.as_deref().ok_or_else(|| EstimateError::Clockless {
        what: "inertias of a chain of two links".to_owned(),
        recording: recording.name.clone(),
    })?;
    let (angles, torques) = ([channel(ANGLES[0])?, channel(ANGLES[1])?], [channel(TORQUES[0])?, channel(TORQUES[1])?]);
    let flagged = saturated(recording, &TORQUES);
    let (spans, period) = uninterrupted(time, &recording.name)?;
    let total = time.len() as f64;
    let piece = |(first, end): (usize, usize)| {
        let even = Resampled::new(&time[first..end], period);
        let onto = |values: &[f64]| even.onto(&values[first..end]);
        let (position, torque) = (angles.map(onto), torques.map(onto));
        let noise = angles.map(|a| even.noise(&a[first..end]));
        let rate_hz = 1.0 / even.period_s;
        let light_hz = light(&position, noise, rate_hz);
        let smooth = position.map(|p| low_pass(&p, rate_hz, light_hz));
        let rates = [0, 1].map(|j: usize| stencil(&smooth[j], 1.0 / rate_hz).0);
        let rms = rates.each_ref().map(|r| root_mean_square(r));
        let blur = noise.map(|n| noise_blur(n * derivative_noise(rate_hz, light_hz, 1).sqrt()));
        let pair = |of: &[Vec<f64>; 2], i: usize| [of[0][i], of[1][i]];
        let n = even.grid.len();
        let motion = (0..n).map(|i| {
            let rate_rad_s = pair(&rates, i);
            let direction = [0, 1].map(|j: usize| direction(rate_rad_s[j], blur[j]));
            TwoLinkMotion { angle_rad: pair(&smooth, i), rate_rad_s, direction }
        });
        let slow =
            |j: usize| move |v: &f64| 1.0 / (1.0 + (v / (STICKING_SHARE * rms[j]).max(f64::MIN_POSITIVE)).powi(2));
        Joints {
            recording: index,
            motion: motion.collect(),
            torque,
            usable: even.flags(&time[first..end], &flagged[first..end]).into_iter().map(|f| !f).collect(),
            rate_hz,
            light_hz,
            gravity: recording.meta.gravity(),
            sticking: [0, 1].map(|j: usize| rates[j].iter().map(slow(j)).collect()),
            place: (first as f64 / total, (end - first) as f64 / (total * n as f64)),
        }
    };
    Ok(spans.into_iter().map(piece).collect())
}

/// The highest cut-off at which both rates stand clear of their noise.
fn light(position: &[Vec<f64>; 2], noise: [f64; 2], rate_hz: f64) -> f64 {
    let highest = MAX_CUTOFF_SHARE * rate_hz;
    let lowest = 8.0 * rate_hz / position[0].len() as f64;
    let quiet = |cutoff_hz: &f64| {
        let loudest =
            position.iter().map(|p| root_mean_square(&stencil(&low_pass(p, rate_hz, *cutoff_hz), 1.0 / rate_hz).0));
        let left = noise.iter().map(|n| n * derivative_noise(rate_hz, *cutoff_hz, 1).sqrt());
        // A joint that stands still shows nothing but noise.
        loudest.zip(left).any(|(rate, noise)| noise <= DERIVATIVE_NOISE * rate)
    };
    let ladder = std::iter::successors(Some(highest), |c| Some(c * 0.8)).take_while(|c| *c > lowest);
    ladder.into_iter().find(quiet).unwrap_or(lowest.min(highest))
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

impl Joints {
    /// Root mean square of a joint's rate, rad/s.
    pub fn usual_rate(&self, joint: usize) -> f64 {
        root_mean_square(&self.motion.iter().map(|m| m.rate_rad_s[joint]).collect::<Vec<f64>>())
    }

    /// The frequency at which most of the motion takes place, Hz.
    pub fn motion_hz(&self) -> f64 {
        let of = |joint: usize| {
            let rate: Vec<f64> = self.motion.iter().map(|m| m.rate_rad_s[joint]).collect();
            let angle: Vec<f64> = self.motion.iter().map(|m| m.angle_rad[joint]).collect();
            let mean = angle.iter().sum::<f64>() / angle.len().max(1) as f64;
            let swing = root_mean_square(&angle.iter().map(|a| a - mean).collect::<Vec<f64>>());
            (root_mean_square(&rate), swing)
        };
        // Of the joint that moves most.
        let (rate, swing) = [of(0), of(1)].into_iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((0.0, 1.0));
        rate / (TAU * swing.max(f64::MIN_POSITIVE))
    }

    /// Columns and torque of one joint, all through one filter; momenta are differentiated after it.
    pub fn rows(&self, joint: usize, cutoff_hz: f64) -> JointRows {
        let n = self.motion.len();
        let filter = |values: &[f64]| low_pass(values, self.rate_hz, cutoff_hz);
        let edge = edge_samples(self.rate_hz, cutoff_hz).min(n / 2);
        let stride = ((self.rate_hz / (ROWS_A_PERIOD * cutoff_hz)) as usize).max(1);
        let kept: Vec<usize> = (edge..n - edge).filter(|&i| self.usable[i]).step_by(stride).collect();
        let pick = |values: Vec<f64>| kept.iter().map(|&i| values[i]).collect::<Vec<f64>>();
        let momenta: Vec<_> = self.motion.iter().map(|m| m.momenta()[joint]).collect();
        let torques: Vec<_> = self.motion.iter().map(|m| m.torques(self.gravity)[joint]).collect();
        let column = |k: usize| {
            let of = |rows: &[[f64; TWO_LINK.len()]]| rows.iter().map(|r| r[k]).collect::<Vec<f64>>();
            let (momentum, torque) = (of(&momenta), of(&torques));
            let all_zero = |values: &[f64]| values.iter().all(|v| *v == 0.0);
            let mut sum = if all_zero(&torque) { vec![0.0; n] } else { filter(&torque) };
            if !all_zero(&momentum) {
                let rate = stencil(&filter(&momentum), 1.0 / self.rate_hz).0;
                sum.iter_mut().zip(rate).for_each(|(s, r)| *s += r);
            }
            pick(sum)
        };
        let measured = low_pass(&self.torque[joint], self.rate_hz, self.light_hz);
        JointRows {
            joint,
            columns: (0..TWO_LINK.len()).map(column).collect(),
            torque: pick(filter(&measured)),
            doubt: pick(filter(&self.sticking[joint])).into_iter().map(|d| d * d).collect(),
            place: kept.iter().map(|&i| self.place.0 + self.place.1 * i as f64).collect(),
        }
    }
}
