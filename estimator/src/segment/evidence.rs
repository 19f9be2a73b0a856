//! What the hidden Markov model sees of a recording: a few channels in units of the thresholds, and the rules' own answer.

use super::rules::{self, Quality, Sign};
use super::threshold::{Levels, Thresholds};
use super::{SystemState, motion::Motion};
use crate::signal::task::TaskSignals;
use haptics::Vec2;

/// Channels of a recording for [`super::markov`].
///
/// Every channel is asinh(signal / threshold): straight where the signal is within its threshold and so shows the noise, a
/// logarithm beyond, so that a firm grip and a firmer one look alike and an impact is no outlier.
pub struct Evidence {
    /// Channels of a sample.
    pub channels: usize,
    /// Sample after sample.
    pub values: Vec<f64>,
    /// The state of every sample by the rules alone.
    pub raw: Vec<SystemState>,
    /// The state that the rules name for mean channels; the second argument is the level (1: at the threshold) that counts as
    /// beyond it.
    pub judge: fn(&[f64], f64) -> SystemState,
}

/// A threshold of zero (a channel that never moves) must not divide.
const LEAST_THRESHOLD: f64 = 1e-12;

fn scaled(value: f64, threshold: f64) -> f64 {
    (value / threshold.max(LEAST_THRESHOLD)).asinh()
}

/// Blocks: grip force, net vertical force, largest force of all, horizontal and vertical speed.
pub fn of_blocks(calm: &TaskSignals, levels: &Levels, thresholds: &Thresholds) -> Evidence {
    let raw = rules::states(&rules::qualify(calm, levels, thresholds));
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
    Evidence { channels: 5, values, raw, judge: judge_block }
}

fn judge_block(mean: &[f64], level: f64) -> SystemState {
    let sign = |channel: usize| match mean.get(channel).copied().unwrap_or(0.0).sinh() {
        v if v > level => Sign::Plus,
        v if v < -level => Sign::Minus,
        _ => Sign::Zero,
    };
    rules::state(Quality {
        grip: sign(0),
        net_y: sign(1),
        no_contact: sign(2) != Sign::Plus,
        velocity_x: sign(3),
        velocity_y: sign(4),
    })
}

/// Crank or mechanism: speed, and load where one is measured.
pub fn of_motion(motion: &Motion) -> Evidence {
    let speeds = motion.speed.iter().map(|v| scaled(*v, motion.thresholds.velocity_m_s));
    match &motion.load {
        Some(load) => Evidence {
            channels: 2,
            values: speeds
                .zip(load)
                .flat_map(|(speed, load)| [speed, scaled(*load, motion.thresholds.force_n)])
                .collect(),
            raw: motion.states(),
            judge: judge_motion,
        },
        None => Evidence { channels: 1, values: speeds.collect(), raw: motion.states(), judge: judge_motion },
    }
}

fn judge_motion(mean: &[f64], level: f64) -> SystemState {
    let beyond = |channel: usize| mean.get(channel).is_none_or(|v| v.sinh() > level);
    match (beyond(1), beyond(0)) {
        (false, _) => SystemState::FreeMotion,
        (true, true) => SystemState::Turning,
        (true, false) => SystemState::Holding,
    }
}
