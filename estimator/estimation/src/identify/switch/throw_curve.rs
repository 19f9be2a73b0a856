//! The way of a throw as a finger sees it: force rises to a peak and falls from there, linear on both sides; and the stop.

use super::signals::{Sample, Seen};
use crate::identify::limits::{GOLDEN_STEPS, LEAST_LINE_ROWS, LEAST_SEGMENT_ROWS, SEARCH_STEPS};
use crate::regression::bootstrap::{Resampled, block_bootstrap};
use crate::regression::linear::{COLUMN_NOISE_UNCERTAINTY, LinearFit, least_squares};
use foundation::estimate::EstimateError;
use nalgebra::{DMatrix, DVector};

/// Largest number of samples in the fit.
/// Choice: halved or doubled, none of 21 answers changes.
const MOST_THROW_ROWS: usize = 6000;
/// Force by speed and mass of a knob on its way down that is not in the curve, as a share of the peak (one standard
/// deviation).
/// Choice: halved or doubled, none of 7 answers changes.
const FALLING: f64 = 0.017;
/// Force by speed and mass of a slow knob up to the peak that is not in the curve, as a share of the peak (one standard
/// deviation).
/// Choice: halved, 2 of 21 answers change; doubled, 1 of 21 answers change.
const MOVING: f64 = 0.013;

/// Rise and fall. Regressors of `around`: force at the peak, rise, fall, place of the peak. If they can be told from
/// the curve there follow the terms of the knob's own motion: damping, mass.
#[derive(Clone, Debug)]
pub struct Throw {
    /// Force, N, slope before and after, N/m, at the peak's place, m along the arc in the direction of travel.
    pub values: [f64; 4],
    /// Linearised fit around the answer.
    pub around: LinearFit,
    /// The errors of force, slopes and place by a block bootstrap of the samples; `None` where they are too few.
    pub resampled: Option<Resampled>,
    /// Force of the knob's own motion at the peak and while it falls over, N, if it could not be fitted.
    pub unmodelled_n: [f64; 2],
    /// Samples that took part.
    pub samples: usize,
}

/// Stop for the fingertip: its beginning, m along the arc in the direction of travel, and the give of finger and stop,
/// m/N; with errors.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Place without force and its error, m.
    pub end_m: (f64, f64),
    /// Give and its error, m/N.
    pub give_m_n: (f64, f64),
    /// Error of the place by a block bootstrap of the samples, m; `None` where they are too few.
    pub end_resampled_m: Option<f64>,
}

impl Throw {
    /// A curve whose own damping and mass are unknown.
    fn assumed_slow(self) -> Self {
        let peak_n = self.values[0].abs();
        Self { unmodelled_n: [MOVING * peak_n, FALLING * peak_n], ..self }
    }

    /// Force at a place on the falling side, N.
    pub fn falling_n(&self, at_m: f64) -> f64 {
        let [peak_n, _, fall, place_m] = self.values;
        peak_n + fall * (at_m - place_m)
    }

    /// Its standard error, N, with this covariance of the regressors of `around`.
    pub fn falling_error_n(&self, at_m: f64, covariance: &DMatrix<f64>) -> f64 {
        let gradient = [1.0, 0.0, at_m - self.values[3], -self.values[2]];
        let pairs = (0..4).flat_map(|i| (0..4).map(move |j| (i, j)));
        let variance: f64 = pairs.map(|(i, j)| gradient[i] * gradient[j] * covariance[(i, j)]).sum();
        variance.max(0.0).sqrt()
    }
}

/// `None` when too little is seen, or no fall after a rise.
pub fn throw(seen: &Seen) -> Result<Option<Throw>, EstimateError> {
    let count = seen.way.len();
    if count < LEAST_SEGMENT_ROWS {
        return Ok(None);
    }
    let rows: Vec<Sample> = seen.way.iter().copied().step_by(count.div_ceil(MOST_THROW_ROWS)).collect();
    let still = throw_with(&rows, None)?;
    let Some(moving) = throw_with(&rows, Some(seen.rate_noise))? else { return Ok(still.map(Throw::assumed_slow)) };
    // At one speed all the time, or in few samples, the force of the motion cannot be told from the curve.
    let told =
        still.as_ref().is_none_or(|s| moving.around.std_errors[0] < s.around.std_errors[0].hypot(MOVING * s.values[0]));
    Ok(if told { Some(moving) } else { still.map(Throw::assumed_slow) })
}

/// `noise`: of rate and acceleration, if the knob's own motion is fitted.
fn throw_with(rows: &[Sample], noise: Option<[f64; 2]>) -> Result<Option<Throw>, EstimateError> {
    let moving = noise.is_some();
    let (low, high) = rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s.at_m), h.max(s.at_m)));
    let at = |k: usize| low + (high - low) * k as f64 / SEARCH_STEPS as f64;
    let cost = |place: f64| solve(rows, place, moving).map_or(f64::INFINITY, |(_, cost)| cost);
    let best = (1..SEARCH_STEPS).min_by(|&a, &b| cost(at(a)).total_cmp(&cost(at(b)))).unwrap_or(1);
    let (mut left, mut right) = (at(best - 1), at(best + 1));
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..GOLDEN_STEPS {
        let (a, b) = (right - share * (right - left), left + share * (right - left));
        if cost(a) < cost(b) { right = b } else { left = a }
    }
    let place = 0.5 * (left + right);
    let Some((values, _)) = solve(rows, place, moving) else { return Ok(None) };
    let [peak, rise, fall] = [values[0], values[1], values[2]];
    let column = |f: &dyn Fn(f64) -> f64| rows.iter().map(|s| f(s.at_m - place)).collect::<Vec<f64>>();
    let mut columns = vec![
        column(&|_| 1.0),
        column(&|x| x.min(0.0)),
        column(&|x| x.max(0.0)),
        column(&|x| if x < 0.0 { -rise } else { -fall }),
    ];
    if moving {
        columns.push(rows.iter().map(|s| s.rate_m_s).collect());
        columns.push(rows.iter().map(|s| s.acceleration).collect());
    }
    let force: Vec<f64> = rows.iter().map(|s| s.force_n).collect();
    // Around the answer the place's own regressor asks for no change: this fit serves the errors.
    let mut around = least_squares(&columns, &force, None)?;
    let mut resampled = block_bootstrap(&columns, &force, None, &around);
    let mut values = [peak, rise, fall, place];
    if let Some(noise) = noise {
        let (rate, count) = (values.len(), around.values.len());
        let mut power = DMatrix::zeros(count, count);
        (0..2).for_each(|k| power[(rate + k, rate + k)] = rows.len() as f64 * noise[k] * noise[k]);
        let before = around.std_errors.clone();
        around = around.without_attenuation(&power, COLUMN_NOISE_UNCERTAINTY);
        // The correction enlarges both kinds of errors by the same factor.
        let costs: Vec<f64> = around.std_errors.iter().zip(before).map(|(after, before)| after / before).collect();
        resampled = resampled.map(|drawn| drawn.scaled(&costs));
        values = [around.values[0], around.values[1], around.values[2], place + around.values[3]];
    }
    let seen = around.identified.iter().all(|i| *i) && values[1] > 0.0 && values[2] < 0.0;
    Ok(seen.then_some(Throw { values, around, resampled, unmodelled_n: [0.0; 2], samples: rows.len() }))
}

/// `None` when no stop was pressed. Place over force, not the other way round: places are the noisy ones on a hard stop.
pub fn stop(seen: &Seen) -> Result<Option<Stop>, EstimateError> {
    if seen.stop.len() < LEAST_LINE_ROWS {
        return Ok(None);
    }
    let rows: Vec<Sample> = seen.stop.iter().copied().step_by(seen.stop.len().div_ceil(MOST_THROW_ROWS)).collect();
    let force: Vec<f64> = rows.iter().map(|s| s.force_n).collect();
    let place: Vec<f64> = rows.iter().map(|s| s.at_m).collect();
    let columns = [vec![1.0; rows.len()], force];
    let fit = least_squares(&columns, &place, None)?;
    let end_resampled_m = block_bootstrap(&columns, &place, None, &fit).map(|r| r[0]);
    let seen = fit.identified.iter().all(|i| *i);
    let of = |k: usize| (fit.values[k], fit.std_errors[k]);
    Ok(seen.then(|| Stop { end_m: of(0), give_m_n: of(1), end_resampled_m }))
}

/// Peak, rise and fall for a given place (and, for a knob that is `moving`, damping and mass beside them), and the sum of squares.
fn solve(rows: &[Sample], place: f64, moving: bool) -> Option<(DVector<f64>, f64)> {
    let count = if moving { 5 } else { 3 };
    let (mut normal, mut right, mut power) = (DMatrix::<f64>::zeros(count, count), DVector::<f64>::zeros(count), 0.0);
    for s in rows {
        let x = s.at_m - place;
        let row = [1.0, x.min(0.0), x.max(0.0), s.rate_m_s, s.acceleration];
        for i in 0..count {
            for j in 0..count {
                normal[(i, j)] += row[i] * row[j];
            }
            right[i] += row[i] * s.force_n;
        }
        power += s.force_n * s.force_n;
    }
    // The factors do not depend on the units of the columns.
    let values = normal.cholesky()?.solve(&right);
    let cost = power - values.dot(&right);
    Some((values, cost))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rise_and_fall_with_known_numbers_come_back() {
        let truth = |x: f64| 1.2 + if x < 0.004 { 250.0 * (x - 0.004) } else { -280.0 * (x - 0.004) };
        let way_of = |last: f64| Seen {
            way: (0..2000)
                .map(|i| {
                    let at_m = last * f64::from(i) / 2000.0;
                    let force_n = truth(at_m) + 7e-3 * (f64::from(i) * 12.9898).sin();
                    Sample { at_m, force_n, rate_m_s: 0.02, acceleration: 0.0 }
                })
                .collect(),
            ..Seen::default()
        };
        let found = throw(&way_of(0.008)).expect("solves").expect("a peak");
        for (k, wanted) in [1.2, 250.0, -280.0, 0.004].into_iter().enumerate() {
            let error = found.around.std_errors[k];
            assert!((found.values[k] - wanted).abs() < 4.0 * error, "{k}: {} ± {error}", found.values[k]);
        }
        assert!(throw(&way_of(0.003)).expect("solves").is_none(), "a rise alone has no peak");
    }
}
