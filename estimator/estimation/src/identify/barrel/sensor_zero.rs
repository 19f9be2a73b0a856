//! The zero of the force sensors, and how it drifts: from the phases in which nothing is touched.

use super::signals::Signals;
use crate::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use haptics::Vec2;

/// Least length of a free phase before the first grip or after the last, s.
/// Choice: no case of the ablation reads it.
const LEAST_FREE_PHASE_S: f64 = 0.2;

/// The zero of both sensors together.
#[derive(Clone, Copy, Debug, Default)]
pub struct SensorZero {
    /// Zero at the requested time, beyond the mean that was already taken out, N.
    pub net_n: Vec2,
    /// Standard error of its vertical part, N.
    pub error_n: f64,
    /// Drift of the vertical part and its error, N/s; `None` where free phases do not lie on both sides.
    pub drift_n_s: Option<(f64, f64)>,
}

impl SensorZero {
    /// The zero at a time.
    pub fn at(signals: &Signals, time_s: f64) -> Result<Self, EstimateError> {
        let free = &signals.levels.free;
        let time = |i: &usize| signals.time_s[*i];
        let resolution_n = std::f64::consts::SQRT_2 * signals.resolution_n;
        if free.is_empty() {
            return Ok(Self { error_n: signals.levels.force_noise_n.hypot(resolution_n), ..Self::default() });
        }
        let held = signals.held();
        let (first, last) = (held.first().map_or(0.0, time), held.last().map_or(0.0, time));
        let lasts = |side: &dyn Fn(f64) -> bool| {
            let inside: Vec<f64> = free.iter().map(time).filter(|t| side(*t)).collect();
            inside.first().zip(inside.last()).is_some_and(|(a, b)| b - a > LEAST_FREE_PHASE_S)
        };
        let both = lasts(&|t| t < first) && lasts(&|t| t > last);
        // Unfiltered: a filter would carry a touch into the free samples beside it.
        let bias_n = (signals.levels.bias_n[0] + signals.levels.bias_n[1]).y;
        let lift: Vec<f64> = free.iter().map(|i| signals.task.net_force_n[*i].y - bias_n).collect();
        let since: Vec<f64> = free.iter().map(|i| time(i) - time_s).collect();
        let mut columns = vec![vec![1.0; lift.len()]];
        if both {
            columns.push(since);
        }
        let fit = least_squares(&columns, &lift, None)?;
        let span_s = (last - first).max(LEAST_FREE_PHASE_S);
        Ok(Self {
            net_n: Vec2::new(0.0, fit.values[0]),
            error_n: fit.std_errors[0].hypot(resolution_n),
            drift_n_s: both.then(|| (fit.values[1], fit.std_errors[1].hypot(resolution_n / span_s))),
        })
    }
}
