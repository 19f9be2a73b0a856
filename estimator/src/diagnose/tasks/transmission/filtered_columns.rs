//! Regressors of laws with memory or a jump, computed at the recording's own rate and then passed through the filter of
//! the channels. Computed on the rows they would keep corners that the filtered rows have lost.

use crate::diagnose::data::interpolation::{mean_step_s, slope_noise};
use crate::diagnose::data::limits::SIGNIFICANT;
use foundation::signal::task::{half_width, smooth, smooth_value};

/// Speed below which its sign is uncertain, as a share of the largest speed.
/// Choice: no case of the ablation reads it.
const LEAST_SPEED: f64 = 1e-3;

/// The input of one recording at its own rate.
pub struct Fine {
    time_s: Vec<f64>,
    /// Filtered position and speed, rad or m, and per second.
    input: Vec<f64>,
    rate: Vec<f64>,
    /// Noise of the speed.
    rate_noise: f64,
    /// Speed over which a direction goes from one to the other.
    blur: f64,
    /// Number of samples per row.
    every: usize,
}

impl Fine {
    pub fn new(time_s: &[f64], input: &[f64], every: usize) -> Self {
        let through = smooth(time_s, input);
        let rate_noise = slope_noise(input, half_width(time_s), mean_step_s(time_s));
        let fastest = through.slope.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let blur = (SIGNIFICANT * rate_noise).max(LEAST_SPEED * fastest).max(f64::MIN_POSITIVE);
        Self { time_s: time_s.to_vec(), input: through.value, rate: through.slope, rate_noise, blur, every }
    }

    /// Noise of the speed, per second.
    pub fn rate_noise(&self) -> f64 {
        self.rate_noise
    }

    /// Values of a series at the rows, through their filter.
    fn rows(&self, series: &[f64]) -> Vec<f64> {
        smooth_value(&self.time_s, series).into_iter().step_by(self.every).collect()
    }

    /// The direction of motion, −1 … 1, with intermediate values in rows over a reversal.
    pub fn direction(&self) -> Vec<f64> {
        let signs: Vec<f64> = self.rate.iter().map(|v| (v / self.blur).tanh()).collect();
        self.rows(&signs)
    }

    /// Lost motion of the output behind a gap of twice `half` (the play operator).
    pub fn lost(&self, half: f64) -> Vec<f64> {
        let mut place = self.input[0];
        let series: Vec<f64> = self
            .input
            .iter()
            .map(|q| {
                place = place.clamp(q - half, q + half);
                place - q
            })
            .collect();
        self.rows(&series)
    }

    /// Dahl's state: −1 … 1, bending over `way` before it slides.
    pub fn bent(&self, way: f64) -> Vec<f64> {
        let (mut state, mut before) = (0.0_f64, self.input[0]);
        let series: Vec<f64> = self
            .input
            .iter()
            .map(|q| {
                let step = q - before;
                before = *q;
                // Its exact course over a step of one direction.
                if step != 0.0 {
                    let to = step.signum();
                    state = to + (state - to) * (-step.abs() / way).exp();
                }
                state
            })
            .collect();
        self.rows(&series)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Back-and-forth strokes of one second, at 200 Hz.
    fn strokes() -> (Vec<f64>, Vec<f64>) {
        let time_s: Vec<f64> = (0..800).map(|i| 0.005 * f64::from(i)).collect();
        let input = time_s.iter().map(|t| 0.5 * (std::f64::consts::TAU * t).sin()).collect();
        (time_s, input)
    }

    #[test]
    fn a_gap_is_seen_through_the_filter_that_the_output_went_through() {
        let (time_s, input) = strokes();
        let mut place = input[0];
        let output: Vec<f64> = input
            .iter()
            .map(|q| {
                place = place.clamp(q - 0.02, q + 0.02);
                place
            })
            .collect();
        let [input_rows, output_rows] = [&input, &output].map(|v| smooth_value(&time_s, v));
        let lost = Fine::new(&time_s, &input, 1).lost(0.02);
        let off = lost.iter().zip(output_rows.iter().zip(&input_rows)).skip(100).map(|(l, (o, q))| l - (o - q));
        // Worked out on filtered rows the corners at the reversals are some 1e-4 off.
        let worst = off.fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(worst < 3e-5, "{worst}");
    }

    #[test]
    fn a_direction_is_sure_but_where_a_row_looks_over_a_reversal() {
        let (time_s, input) = strokes();
        let sure = Fine::new(&time_s, &input, 1).direction();
        let unsure = sure.iter().filter(|d| d.abs() < 0.99).count();
        assert!((8..80).contains(&unsure), "{unsure} of 800 at eight reversals");
    }
}
