//! The way of a throw as a finger sees it: force rises to a peak and falls from there, linear on both sides; and the stop.

use super::signals::{Sample, Seen};
use crate::estimate::EstimateError;
use crate::identify::linear::{LinearFit, least_squares};
use nalgebra::{Matrix3, Vector3};

/// Steps of the search for the peak, and of the golden section after it.
const SEARCH: usize = 60;
const FINE: usize = 40;
/// Most samples that take part.
const MOST_ROWS: usize = 6000;
/// Fewest samples that show a rise and a fall.
const LEAST_ROWS: usize = 24;
/// Fewest that show a stop.
const LEAST_STOP: usize = 8;

/// Rise and fall. Columns of `around`: force at the peak, rise, fall, place of the peak.
#[derive(Clone, Debug)]
pub struct Way {
    /// Force, N, slope before and after, N/m, at the peak's place, m along the direction of travel.
    pub values: [f64; 4],
    /// Linearised fit around the answer.
    pub around: LinearFit,
    /// Samples that took part.
    pub samples: usize,
}

/// Where the stop begins for the fingertip, m along the direction of travel, and what finger and stop give, m/N; with errors.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Place without force and its error, m.
    pub end_m: (f64, f64),
    /// Give and its error, m/N.
    pub give_m_n: (f64, f64),
}

impl Way {
    /// Force at a place on the falling side, N, and its error.
    pub fn falling_n(&self, at_m: f64) -> (f64, f64) {
        let [peak_n, _, fall, place_m] = self.values;
        let x = at_m - place_m;
        let gradient = [1.0, 0.0, x, -fall];
        let c = &self.around.covariance;
        let variance: f64 =
            (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).map(|(i, j)| gradient[i] * gradient[j] * c[(i, j)]).sum();
        (peak_n + fall * x, variance.max(0.0).sqrt())
    }
}

/// `None` when too little is seen, or no fall after a rise.
pub fn way(seen: &Seen) -> Result<Option<Way>, EstimateError> {
    let count = seen.way.len();
    if count < LEAST_ROWS {
        return Ok(None);
    }
    let rows: Vec<Sample> = seen.way.iter().copied().step_by(count.div_ceil(MOST_ROWS)).collect();
    let (low, high) = rows.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), s| (l.min(s.at_m), h.max(s.at_m)));
    let at = |k: usize| low + (high - low) * k as f64 / SEARCH as f64;
    let cost = |place: f64| solve(&rows, place).map_or(f64::INFINITY, |(_, cost)| cost);
    let best = (1..SEARCH).min_by(|&a, &b| cost(at(a)).total_cmp(&cost(at(b)))).unwrap_or(1);
    let (mut left, mut right) = (at(best - 1), at(best + 1));
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..FINE {
        let (a, b) = (right - share * (right - left), left + share * (right - left));
        if cost(a) < cost(b) { right = b } else { left = a }
    }
    let place = 0.5 * (left + right);
    let Some((values, _)) = solve(&rows, place) else { return Ok(None) };
    let [peak, rise, fall] = [values[0], values[1], values[2]];
    let column = |f: &dyn Fn(f64) -> f64| rows.iter().map(|s| f(s.at_m - place)).collect::<Vec<f64>>();
    let columns = [
        column(&|_| 1.0),
        column(&|x| x.min(0.0)),
        column(&|x| x.max(0.0)),
        column(&|x| if x < 0.0 { -rise } else { -fall }),
    ];
    let force: Vec<f64> = rows.iter().map(|s| s.force_n).collect();
    // Around the answer the place's own column asks for no change: what is left are the errors.
    let around = least_squares(&columns, &force, None)?;
    let seen = around.identified.iter().all(|i| *i) && rise > 0.0 && fall < 0.0;
    Ok(seen.then_some(Way { values: [peak, rise, fall, place], around, samples: count }))
}

/// `None` when no stop was pressed. Place over force, not the other way round: places are the noisy ones on a hard stop.
pub fn stop(seen: &Seen) -> Result<Option<Stop>, EstimateError> {
    if seen.stop.len() < LEAST_STOP {
        return Ok(None);
    }
    let rows: Vec<Sample> = seen.stop.iter().copied().step_by(seen.stop.len().div_ceil(MOST_ROWS)).collect();
    let force: Vec<f64> = rows.iter().map(|s| s.force_n).collect();
    let place: Vec<f64> = rows.iter().map(|s| s.at_m).collect();
    let fit = least_squares(&[vec![1.0; rows.len()], force], &place, None)?;
    let seen = fit.identified.iter().all(|i| *i);
    let of = |k: usize| (fit.values[k], fit.std_errors[k]);
    Ok(seen.then(|| Stop { end_m: of(0), give_m_n: of(1) }))
}

/// Peak, rise and fall for a given place, and the sum of squares.
fn solve(rows: &[Sample], place: f64) -> Option<(Vector3<f64>, f64)> {
    let (mut normal, mut right, mut power) = (Matrix3::<f64>::zeros(), Vector3::<f64>::zeros(), 0.0);
    for s in rows {
        // Millimetres, so that all columns are of one size.
        let x = 1e3 * (s.at_m - place);
        let row = Vector3::new(1.0, x.min(0.0), x.max(0.0));
        normal += row * row.transpose();
        right += row * s.force_n;
        power += s.force_n * s.force_n;
    }
    let values = normal.cholesky()?.solve(&right);
    Some((Vector3::new(values[0], 1e3 * values[1], 1e3 * values[2]), power - values.dot(&right)))
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
                    Sample { at_m, force_n: truth(at_m) + 7e-3 * (f64::from(i) * 12.9898).sin() }
                })
                .collect(),
            ..Seen::default()
        };
        let found = way(&way_of(0.008)).expect("solves").expect("a peak");
        for (k, wanted) in [1.2, 250.0, -280.0, 0.004].into_iter().enumerate() {
            let error = found.around.std_errors[k];
            assert!((found.values[k] - wanted).abs() < 4.0 * error, "{k}: {} ± {error}", found.values[k]);
        }
        assert!(way(&way_of(0.003)).expect("solves").is_none(), "a rise alone has no peak");
    }
}
