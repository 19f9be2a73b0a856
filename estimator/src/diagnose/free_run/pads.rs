//! Compliant pads under a measured force: their damping delays the displacement after the force.

use super::channel::{Forward, columns, consecutive};
use crate::diagnose::contract::RolloutOf;
use crate::diagnose::selection::comparison::ChannelFit;

/// A channel of positions, with the rate of the position among the regressors of its model.
pub struct Pads {
    time_s: Vec<f64>,
    stretch: Vec<usize>,
    period_s: f64,
    /// Index of the rate among the model's regressors.
    rate: usize,
}

impl Pads {
    pub fn new(time_s: &[f64], stretch: &[usize], period_s: f64, rate: usize) -> Self {
        Self { time_s: time_s.to_vec(), stretch: stretch.to_vec(), period_s, rate }
    }
}

impl Forward for Pads {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Position, "m")
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        let all: Vec<usize> = (0..self.time_s.len()).collect();
        consecutive(&all, &|i| self.time_s[i], self.period_s, &|a, b| self.stretch[a] == self.stretch[b])
    }

    /// place = give of the force + lag · rate, stepped where each step ends: a lag that runs ahead of the force is
    /// noise, and none.
    fn errors(
        &self,
        study: &ChannelFit,
        window: &[usize],
        picks: &[usize],
        values: &[f64],
    ) -> Result<(f64, f64), String> {
        let lag_s = (-values[self.rate]).max(0.0);
        let given: Vec<(&[f64], f64)> = columns(study, picks, values)
            .enumerate()
            .filter(|(k, _)| *k != self.rate)
            .map(|(_, column)| column)
            .collect();
        let mut place = study.y[window[0]];
        let (mut sum, mut count) = (0.0, 0.0);
        for pair in window.windows(2) {
            let step_s = (self.time_s[pair[1]] - self.time_s[pair[0]]).max(1e-9);
            let given = given.iter().map(|(column, value)| value * column[pair[1]]).sum::<f64>();
            place = (given + lag_s / step_s * place) / (1.0 + lag_s / step_s);
            sum += (place - study.y[pair[1]]).powi(2);
            count += 1.0;
        }
        Ok((sum, count))
    }
}
