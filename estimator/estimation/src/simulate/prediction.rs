//! Predicted forces, and how well they agree with the measured ones.

use foundation::signal::task::times;
use haptics::recording::{Channel, Recording};
use schemars::JsonSchema;
use serde::Serialize;

/// Predicted forces at the recording's sample times.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Sample times, s (sample numbers for a clockless log).
    pub time_s: Vec<f64>,
    /// Predicted channels, named like the measured ones (`fx1_N`, `f_N`, …).
    pub predicted: Vec<Channel>,
    /// RMS of measured minus predicted by channel, where it was measured and something is predicted, in the channel's unit.
    pub residual_rms: Vec<(String, f64)>,
    /// The part of the forces that laws predict, where that is not all of them.
    pub part: Option<PredictedPart>,
    /// Inputs that no law predicts and that are taken from the recording: sentences.
    pub inputs: Vec<String>,
    /// Resting values of the sensors, by channel, N: the prediction while nothing is touched.
    pub bias_n: Vec<(String, f64)>,
}

/// How well the part of the forces that a world's laws predict agrees with what was measured.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct PredictedPart {
    /// Which part it is.
    pub what: String,
    /// RMS of measured minus predicted, N; absent where no force was measured.
    #[serde(rename = "rms_N")]
    pub rms_n: Option<f64>,
    /// Samples at which it is predicted.
    pub samples: usize,
    /// What the laws leave open, and how far off the prediction is there: this says nothing about the laws.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub left_open: Option<LeftOpen>,
}

/// Samples whose force is written, though no law determines it there.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct LeftOpen {
    /// Where, and why.
    pub what: String,
    /// RMS of measured minus predicted, N; absent where no force was measured.
    #[serde(rename = "rms_N")]
    pub rms_n: Option<f64>,
    /// How many.
    pub samples: usize,
}

/// Prediction of laws for a recorded motion that does not drive the world by itself.
pub(super) struct NeededForces {
    pub(super) channels: Vec<Channel>,
    /// True for samples whose forces are predicted; elsewhere they are the operator's own, as measured.
    pub(super) is_predicted: Vec<bool>,
    pub(super) part: PredictedPart,
    pub(super) inputs: Vec<String>,
    pub(super) bias_n: Vec<(String, f64)>,
}

/// Resting value of a sensor: the mean of the samples without a touch, if it is no chance; else 0.
pub(super) fn resting_level(values: &[f64], free: &[usize]) -> f64 {
    /// Standard errors of a mean of white noise; that of noise with a memory is some times larger.
    const SURE: f64 = 10.0;
    let count = free.len() as f64;
    if count < 2.0 {
        return 0.0;
    }
    let mean = free.iter().map(|i| values[*i]).sum::<f64>() / count;
    let variance = free.iter().map(|i| (values[*i] - mean).powi(2)).sum::<f64>() / (count - 1.0);
    if mean.abs() > SURE * (variance / count).sqrt() { mean } else { 0.0 }
}

/// RMS of a residual; `None` without samples.
pub(super) fn rms(left: impl Iterator<Item = f64>) -> Option<f64> {
    let (square, count) = left.fold((0.0, 0_usize), |(sum, n), r| (sum + r * r, n + 1));
    (count > 0).then(|| (square / count as f64).sqrt())
}

impl Simulation {
    /// The prediction as a recording of its own, with the measured channels beside it as `measured_<name>`.
    pub fn to_recording(&self, recording: &Recording) -> Recording {
        let mut channels = self.predicted.clone();
        for channel in &self.predicted {
            if let Some(measured) = recording.channel(&channel.name) {
                channels.push(Channel {
                    name: format!("measured_{}", channel.name),
                    unit: channel.unit.clone(),
                    values: measured.to_vec(),
                });
            }
        }
        Recording {
            name: format!("simulation of {}", recording.name),
            time_s: Some(self.time_s.clone()),
            channels,
            meta: recording.meta.clone(),
            ..Recording::default()
        }
    }
}

impl NeededForces {
    pub(super) fn beside(self, recording: &Recording) -> Simulation {
        let left = |channel: &Channel| {
            let measured = recording.channel(&channel.name)?;
            let both = measured.iter().zip(&channel.values).zip(&self.is_predicted);
            Some((channel.name.clone(), rms(both.filter(|(_, predicted)| **predicted).map(|((m, p), _)| m - p))?))
        };
        Simulation {
            time_s: times(recording),
            residual_rms: self.channels.iter().filter_map(left).collect(),
            predicted: self.channels,
            part: Some(self.part),
            inputs: self.inputs,
            bias_n: self.bias_n,
        }
    }
}
