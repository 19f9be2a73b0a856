//! Autocorrelated noise of the rows: estimated as an autoregression, and removed from every column.

use super::layout::{Layout, Noise, Use};
use crate::diagnose::data::limits::LEAST_ROWS_OF_A_FIT;
use std::ops::Range;

/// Highest order of the autoregression that whitens the residual of a force.
/// Choice: not varied, because arrays have its length. An information criterion chooses among the orders up to it.
const LARGEST_ORDER: usize = 6;
/// Largest order of the autoregression for differenced data, whose noise is correlated over many rows.
/// Choice: no case of the ablation reads it.
const ORDER_OF_DIFFERENCES: usize = 24;
/// Least number of rows for each order of that autoregression.
/// Choice: no case of the ablation reads it.
const SHARE_OF_DIFFERENCES: usize = 12;

/// Autoregression that whitens a residual: coefficients of the lags from 1 on, chosen by BIC.
pub fn whitener(residual: &[f64], layout: &Layout, used: &[Use]) -> Vec<f64> {
    if layout.noise == Noise::OfDifferences {
        return whitener_of_differences(residual, layout, used);
    }
    let trains = |i: usize| matches!(used[i], Use::Always | Use::Fold(_));
    let mut lags = [0.0; LARGEST_ORDER + 1];
    let mut count = 0.0_f64;
    for i in 0..residual.len() {
        if !trains(i) {
            continue;
        }
        count += 1.0;
        for (lag, sum) in lags.iter_mut().enumerate() {
            if i >= lag && layout.segment[i - lag] == layout.segment[i] && trains(i - lag) {
                *sum += residual[i] * residual[i - lag];
            }
        }
    }
    if lags[0] <= 0.0 || count < LEAST_ROWS_OF_A_FIT as f64 {
        return Vec::new();
    }
    let mut best = (count * lags[0].ln(), Vec::new());
    levinson(&lags, &mut |coefficients, innovation| {
        let bic = count * innovation.ln() + coefficients.len() as f64 * count.ln();
        if bic < best.0 {
            best = (bic, coefficients.to_vec());
        }
    });
    best.1
}

/// Levinson's recursion: passes on the coefficients of every order from 1 on, with the residual power.
fn levinson(lags: &[f64], tell: &mut dyn FnMut(&[f64], f64)) {
    let (mut coefficients, mut innovation): (Vec<f64>, f64) = (Vec::new(), lags[0]);
    for order in 1..lags.len() {
        let predicted: f64 = coefficients.iter().zip(lags[1..order].iter().rev()).map(|(a, r)| a * r).sum();
        let reflection = ((lags[order] - predicted) / innovation).clamp(-0.999, 0.999);
        let before = coefficients.clone();
        for (a, b) in coefficients.iter_mut().zip(before.iter().rev()) {
            *a -= reflection * b;
        }
        coefficients.push(reflection);
        innovation *= 1.0 - reflection * reflection;
        tell(&coefficients, innovation);
    }
}

/// White noise added to that of the differences, as shares of its power.
/// Choice: no case of the ablation reads it.
const WHITE_BESIDE: [f64; 8] = [0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 100.0];
/// Restoring terms of a swinging position: second differences plus this share of the noise itself.
/// Choice: no case of the ablation reads it.
const RESTORING_SHARES: [f64; 7] = [0.0, 0.01, 0.03, 0.06, 0.1, 0.2, 0.4];

/// Autoregression of what differences of white noise leave: the one of its kind that leaves least. One estimated from
/// few rows would fill up the gap that the noise has at low frequencies, where everything that swings is.
fn whitener_of_differences(residual: &[f64], layout: &Layout, used: &[Use]) -> Vec<f64> {
    let order = (residual.len() / SHARE_OF_DIFFERENCES).min(ORDER_OF_DIFFERENCES);
    let second = RESTORING_SHARES.map(|back| vec![1.0, back - 2.0, 1.0]);
    let kinds = second.into_iter().chain([vec![1.0, -1.0]]);
    let flat = vec![1.0; residual.len()];
    let mut best: (f64, Vec<f64>) = (f64::INFINITY, Vec::new());
    for (weights, white) in kinds.flat_map(|weights| WHITE_BESIDE.map(|white| (weights.clone(), white))) {
        let mut lags = vec![0.0; order + 1];
        for (lag, sum) in lags.iter_mut().enumerate() {
            *sum = weights.iter().skip(lag).zip(&weights).map(|(a, b)| a * b).sum();
        }
        lags[0] *= 1.0 + white;
        let mut coefficients = Vec::new();
        levinson(&lags, &mut |found, _| coefficients = found.to_vec());
        let left = Whitening::new(&layout.segment, &flat, &coefficients).of(residual);
        let trains = (0..left.len()).filter(|i| matches!(used[*i], Use::Always | Use::Fold(_)));
        let power: f64 = trains.map(|i| left[i] * left[i]).sum();
        if power < best.0 {
            best = (power, coefficients);
        }
    }
    best.1
}

/// Passes columns through weights and an autoregression. A row without its whole past is left out: its result is zero.
pub struct Whitening<'a> {
    weight: &'a [f64],
    coefficients: &'a [f64],
    /// Rows with their whole past.
    whole: Vec<Range<usize>>,
}

impl<'a> Whitening<'a> {
    /// `stretch`: segment of each row. `weight`: factor by which each row's noise is reduced. `coefficients`: of the
    /// lags from 1 on.
    pub fn new(stretch: &[usize], weight: &'a [f64], coefficients: &'a [f64]) -> Self {
        let mut whole = Vec::new();
        let mut first = 0;
        for rows in stretch.chunk_by(|a, b| a == b) {
            let end = first + rows.len();
            if rows.len() > coefficients.len() {
                whole.push(first + coefficients.len()..end);
            }
            first = end;
        }
        Self { weight, coefficients, whole }
    }

    /// True for rows that remain after whitening.
    pub fn leaves(&self) -> Vec<bool> {
        let mut leaves = vec![false; self.weight.len()];
        self.whole.iter().for_each(|range| leaves[range.clone()].fill(true));
        leaves
    }

    /// One whitened column, an entry per row.
    pub fn of(&self, values: &[f64]) -> Vec<f64> {
        let weighted: Vec<f64> = values.iter().zip(self.weight).map(|(value, weight)| value * weight).collect();
        if self.coefficients.is_empty() {
            return weighted;
        }
        let mut out = vec![0.0; values.len()];
        for range in &self.whole {
            let white = &mut out[range.clone()];
            white.copy_from_slice(&weighted[range.clone()]);
            for (lag, coefficient) in (1..).zip(self.coefficients) {
                let past = &weighted[range.start - lag..range.end - lag];
                white.iter_mut().zip(past).for_each(|(white, past)| *white -= coefficient * past);
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stretch_is_whitened_by_its_own_past_and_its_first_rows_are_left_out() {
        let weight = [1.0, 1.0, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0];
        let values = [1.0, 2.0, 4.0, 8.0, 5.0, 6.0, 3.0, 3.0, 9.0];
        let stretch = [0, 0, 0, 0, 1, 1, 2, 2, 2];
        let coefficients = [0.5, 0.25];
        let white = Whitening::new(&stretch, &weight, &coefficients);
        assert_eq!(white.leaves(), [false, false, true, true, false, false, false, false, true]);
        assert_eq!(
            white.of(&values),
            [0.0, 0.0, 2.0 - 1.0 - 0.25, 8.0 - 1.0 - 0.5, 0.0, 0.0, 0.0, 0.0, 9.0 - 1.5 - 0.75]
        );
        let plain = Whitening::new(&stretch, &weight, &[]);
        assert!(plain.leaves().iter().all(|leaves| *leaves));
        assert_eq!(plain.of(&values)[..4], [1.0, 2.0, 2.0, 8.0]);
    }
}
