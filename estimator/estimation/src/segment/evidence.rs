//! Input of the hidden Markov model: a few channels of a recording in units of the thresholds, and the rules' own
//! answer.

use super::motion::Motion;
use super::rules::{self, Quality};
use super::threshold::Levels;
use foundation::signal::task::TaskSignals;
use foundation::tasks::definition::Definition;
use foundation::tasks::{Sign, SystemState, Thresholds};
use haptics::Vec2;

/// See [`Evidence::judge`].
pub type Judge = Box<dyn Fn(&[f64], f64) -> SystemState>;

/// Channels of a recording for [`super::markov`].
///
/// Every channel is asinh(signal / threshold): linear within the threshold, which shows the noise, and logarithmic
/// beyond. A firm grip and a firmer one therefore look alike, and an impact is no outlier.
pub struct Evidence {
    /// Channels of a sample.
    pub channels: usize,
    /// Sample after sample.
    pub values: Vec<f64>,
    /// The state of every sample by the rules alone.
    pub raw: Vec<SystemState>,
    /// The state that the rules name for mean channels; the second argument is the level (1: at the threshold) that counts as
    /// beyond it.
    pub judge: Judge,
}

/// A threshold of zero (a channel that never moves) must not divide.
const LEAST_THRESHOLD: f64 = 1e-12;

fn scaled(value: f64, threshold: f64) -> f64 {
    (value / threshold.max(LEAST_THRESHOLD)).asinh()
}

/// Blocks: grip force, net vertical force, largest force of all, horizontal and vertical speed.
pub fn of_blocks(calm: &TaskSignals, levels: &Levels, thresholds: &Thresholds, task: &Definition) -> Evidence {
    let rules = task.rules();
    let raw = rules::states(&rules::qualify(calm, levels, thresholds, task.thresholds.leave), &rules);
    let force = |finger: usize, i: usize| {
        calm.tips[finger].force.as_ref().map_or_else(Vec2::zeros, |f| f[i]) - levels.bias_n[finger]
    };
    let mut values = Vec::with_capacity(5 * calm.len());
    for i in 0..calm.len() {
        let (f1, f2, velocity) = (force(0, i), force(1, i), calm.velocity[i]);
        let largest = f1.amax().max(f2.amax());
        values.extend([f1.x.min(-f2.x), (f1 + f2).y, largest].map(|f| scaled(f, thresholds.force_n)));
        values.extend([velocity.x.abs(), velocity.y.abs()].map(|v| scaled(v, thresholds.velocity_m_s)));
    }
    Evidence { channels: 5, values, raw, judge: Box::new(move |mean, level| rules.state(&block(mean, level).values())) }
}

/// The qualitative values of mean channels.
fn block(mean: &[f64], level: f64) -> Quality {
    let sign = |channel: usize| match mean.get(channel).copied().unwrap_or(0.0).sinh() {
        v if v > level => Sign::Plus,
        v if v < -level => Sign::Minus,
        _ => Sign::Zero,
    };
    Quality {
        grip: sign(0),
        net_y: sign(1),
        no_contact: sign(2) != Sign::Plus,
        velocity_x: sign(3),
        velocity_y: sign(4),
    }
}

/// Crank or mechanism: speed, and load where one is measured.
pub fn of_motion(motion: &Motion, task: &Definition) -> Evidence {
    let rules = task.rules();
    let speeds = motion.speed.iter().map(|v| scaled(*v, motion.thresholds.velocity_m_s));
    let raw = motion.states(task);
    let judge: Judge = Box::new(move |mean, level| {
        let beyond = |channel: usize| mean.get(channel).map(|v| if v.sinh() > level { Sign::Plus } else { Sign::Zero });
        rules.state(&[beyond(1), beyond(0)])
    });
    match &motion.load {
        Some(load) => {
            let loads = load.iter().map(|load| scaled(*load, motion.thresholds.force_n));
            let values = speeds.zip(loads).flat_map(|(speed, load)| [speed, load]).collect();
            Evidence { channels: 2, values, raw, judge }
        }
        None => Evidence { channels: 1, values: speeds.collect(), raw, judge },
    }
}
