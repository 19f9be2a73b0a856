//! Cranks, mechanisms and switches: speed and load, from which the rules tell not touched, held still and moved.

use super::SystemState;
use super::definition::Definition;
use super::rules::{Sign, beyond};
use super::subtasks::LEAST_SAMPLES;
use super::threshold::{Levels, Thresholds, choose, percentile};
use crate::estimate::EstimateError;
use crate::signal::task::{TaskSignals, TipSeries, calmed, is_two_fingered, task_signals, times, tip_series};
use haptics::Vec2;
use haptics::recording::Recording;

/// The signals that rest and motion are told from, one entry a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Sample times, s (sample numbers when the log is clockless).
    pub time_s: Vec<f64>,
    /// Speed without sign, m/s or rad/s.
    pub speed: Vec<f64>,
    /// Grip or force of the tool, N; absent for a coordinate without fingers.
    pub load: Option<Vec<f64>>,
    /// Thresholds for both.
    pub thresholds: Thresholds,
    /// Sentences about the forces at rest.
    pub warnings: Vec<String>,
}

impl Motion {
    /// The signals of a recording.
    pub fn of(recording: &Recording, given: Option<Thresholds>, task: &Definition) -> Result<Self, EstimateError> {
        let time_s = times(recording);
        if time_s.len() < LEAST_SAMPLES {
            return Err(EstimateError::TooFewSamples {
                recording: recording.name.clone(),
                samples: time_s.len(),
                what: " for a segmentation".to_owned(),
                needed: LEAST_SAMPLES,
            });
        }
        let (speed, load, thresholds, warnings) = if is_two_fingered(recording) {
            let signals = calmed(&task_signals(recording)?);
            let levels = Levels::of(&signals);
            let thresholds = task.thresholds(given, || choose(&signals, &levels));
            let load = push_without_bias(&signals, &levels);
            let speed: Vec<f64> = signals.velocity.iter().map(Vec2::norm).collect();
            (speed, Some(load), thresholds, levels.warnings())
        } else {
            single_tool(recording, given, task)?
        };
        Ok(Self { time_s, speed, load, thresholds, warnings })
    }

    /// The state of every sample by the task's rules alone.
    pub fn states(&self, task: &Definition) -> Vec<SystemState> {
        let (rules, leave) = (task.rules(), task.thresholds.leave);
        let tell = |before: &mut Sign, value: f64, limit: f64| {
            *before = beyond(*before, value, limit, leave);
            *before
        };
        let (mut load, mut speed) = (Sign::Zero, Sign::Zero);
        (0..self.time_s.len())
            .map(|i| {
                let load = self.load.as_ref().map(|l| tell(&mut load, l[i], self.thresholds.force_n));
                rules.state(&[load, Some(tell(&mut speed, self.speed[i], self.thresholds.velocity_m_s))])
            })
            .collect()
    }
}

/// The larger of the two fingers' forces: a switch is pushed, and a hand that pulls a crank harder than it squeezes still holds it.
fn push_without_bias(signals: &TaskSignals, levels: &Levels) -> Vec<f64> {
    let push = |finger: usize, i: usize| {
        signals.tips[finger].force.as_ref().map_or(0.0, |f| (f[i] - levels.bias_n[finger]).norm())
    };
    (0..signals.len()).map(|i| push(0, i).max(push(1, i))).collect()
}

type MotionSignals = (Vec<f64>, Option<Vec<f64>>, Thresholds, Vec<String>);

/// Speed and load of a single tool, or of a mechanism's coordinate.
fn single_tool(
    recording: &Recording,
    given: Option<Thresholds>,
    task: &Definition,
) -> Result<MotionSignals, EstimateError> {
    let coordinate = ["q_m", "q_rad"].into_iter().find_map(|name| recording.channel(name));
    let clockless =
        || EstimateError::Clockless { what: "telling rest from motion".to_owned(), recording: recording.name.clone() };
    let (speed, load) = if let Some(q) = coordinate {
        let measured = recording.channel("dq_m_s").or_else(|| recording.channel("dq_rad_s"));
        let rate = if let Some(rate) = measured {
            rate.to_vec()
        } else {
            let time = recording.time_s.as_ref().ok_or_else(clockless)?;
            crate::signal::task::smooth(time, q).slope
        };
        (rate.iter().map(|v| v.abs()).collect::<Vec<_>>(), None)
    } else {
        let TipSeries { velocity, force, .. } = tip_series(recording, "")?;
        let velocity = velocity.ok_or_else(clockless)?;
        let load = force.map(|f| f.iter().map(Vec2::norm).collect::<Vec<_>>());
        (velocity.iter().map(Vec2::norm).collect(), load)
    };
    let usual = percentile(&mut speed.clone(), 0.95);
    let usual_load = load.as_ref().map_or(0.0, |l| percentile(&mut l.clone(), 0.95));
    let thresholds = task.thresholds(given, || Thresholds { velocity_m_s: 0.1 * usual, force_n: 0.05 * usual_load });
    Ok((speed, load, thresholds, Vec::new()))
}
