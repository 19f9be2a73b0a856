//! Measures of the hand's motion and force.

use super::smoothness::{log_dimensionless_jerk, sparc};
use foundation::estimate::EstimateError;
use foundation::signal::derive::interpolate;
use foundation::signal::filter::low_pass;
use foundation::signal::task::{TipSeries, is_two_fingered, task_signals, times, tip_series};
use haptics::Vec2;
use haptics::recording::Recording;
use schemars::JsonSchema;
use serde::Serialize;

/// Cut-off of the motion, Hz: above is tremor of sensors, which would lengthen every path.
pub const CUTOFF_HZ: f64 = 10.0;
/// Rate of the even grid of the motion, Hz.
const RATE_HZ: f64 = 100.0;
/// A finger that presses more than this touches something, N.
const TOUCH_N: f64 = 0.05;
/// A hand faster than this moves, m/s.
const MOVING_M_S: f64 = 0.005;

/// What can be said of the hand alone.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct HandMeasures {
    /// Length of the recording, s.
    pub duration_s: f64,
    /// Time in which the hand moved at more than 5 mm/s, s.
    pub moving_s: f64,
    /// Length of each tip's path, m.
    pub path_length_m: Vec<f64>,
    /// Width and height of the box that the tips stayed in, m.
    pub range_m: [f64; 2],
    /// Largest force of a finger, N; absent where no force was recorded.
    pub peak_force_n: Option<f64>,
    /// Root mean square of the larger finger's force while something was touched, N; absent where nothing was.
    pub rms_force_n: Option<f64>,
    /// Time in which a finger pressed more than the limit, s.
    pub over_limit_s: Option<f64>,
    /// The limit, N.
    pub limit_n: f64,
    /// Spectral arc length of the hand's speed ([`super::smoothness::sparc`]).
    pub sparc: Option<f64>,
    /// Log dimensionless jerk of the hand's speed ([`super::smoothness::log_dimensionless_jerk`]).
    pub log_dimensionless_jerk: Option<f64>,
}

/// Measures the hand in a recording of two fingers, or of one tool.
pub fn measure(recording: &Recording, limit_n: f64) -> Result<HandMeasures, EstimateError> {
    if recording.time_s.is_none() {
        let text = format!("{} has no clock, and a score needs one; state its rate in the sidecar", recording.name);
        return Err(EstimateError::Other(text));
    }
    let time_s = times(recording);
    let tips: Vec<TipSeries> = if is_two_fingered(recording) {
        task_signals(recording)?.tips.into()
    } else {
        vec![tip_series(recording, "")?]
    };
    let duration_s = time_s.last().zip(time_s.first()).map_or(0.0, |(last, first)| last - first);
    let paths: Vec<Vec<Vec2>> = tips.iter().map(|tip| calm_path(&time_s, &tip.position)).collect();
    let length = |path: &Vec<Vec2>| path.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
    let middle: Vec<Vec2> =
        (0..paths[0].len()).map(|i| paths.iter().map(|path| path[i]).sum::<Vec2>() / paths.len() as f64).collect();
    let speed: Vec<f64> = middle.windows(2).map(|pair| (pair[1] - pair[0]).norm() * RATE_HZ).collect();
    let forces = force_measures(&time_s, &tips, limit_n);
    Ok(HandMeasures {
        duration_s,
        moving_s: speed.iter().filter(|v| **v > MOVING_M_S).count() as f64 / RATE_HZ,
        path_length_m: paths.iter().map(length).collect(),
        range_m: range(&paths),
        peak_force_n: forces.map(|f| f.peak_n),
        rms_force_n: forces.and_then(|f| f.rms_n),
        over_limit_s: forces.map(|f| f.over_limit_s),
        limit_n,
        sparc: sparc(&speed, RATE_HZ),
        log_dimensionless_jerk: log_dimensionless_jerk(&speed, RATE_HZ),
    })
}

/// A path up to [`CUTOFF_HZ`] on an even grid.
fn calm_path(time_s: &[f64], position: &[Vec2]) -> Vec<Vec2> {
    let (Some(first), Some(last)) = (time_s.first(), time_s.last()) else { return Vec::new() };
    let count = ((last - first) * RATE_HZ) as usize + 1;
    let even_hz = (time_s.len() - 1) as f64 / (last - first).max(1e-9);
    let axis = |of: fn(&Vec2) -> f64| -> Vec<f64> {
        let values: Vec<f64> = position.iter().map(of).collect();
        // Filtered at the recording's own rate, then read at the grid: samples are even but for jitter.
        let calm = low_pass(&values, even_hz, CUTOFF_HZ);
        let grid: Vec<f64> = (0..count).map(|k| first + k as f64 / RATE_HZ).collect();
        interpolate(time_s, &calm, &grid)
    };
    axis(|p| p.x).into_iter().zip(axis(|p| p.y)).map(|(x, y)| Vec2::new(x, y)).collect()
}

fn range(paths: &[Vec<Vec2>]) -> [f64; 2] {
    let axis = |of: fn(&Vec2) -> f64| {
        let all = || paths.iter().flatten().map(of);
        all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
    };
    [axis(|p| p.x), axis(|p| p.y)]
}

#[derive(Clone, Copy)]
struct Forces {
    peak_n: f64,
    rms_n: Option<f64>,
    over_limit_s: f64,
}

/// Of the finger that presses more at the moment; `None` where a finger has no forces.
fn force_measures(time_s: &[f64], tips: &[TipSeries], limit_n: f64) -> Option<Forces> {
    let forces: Vec<&Vec<Vec2>> = tips.iter().map(|tip| tip.force.as_ref()).collect::<Option<_>>()?;
    let larger = |i: usize| forces.iter().map(|f| f[i].norm()).fold(0.0, f64::max);
    let (mut peak_n, mut square, mut touched_s, mut over_limit_s) = (0.0_f64, 0.0, 0.0, 0.0);
    for i in 0..time_s.len() {
        // Each sample stands for the time since the one before.
        let span_s = if i == 0 { 0.0 } else { time_s[i] - time_s[i - 1] };
        let force_n = larger(i);
        peak_n = peak_n.max(force_n);
        if force_n > TOUCH_N {
            square += span_s * force_n * force_n;
            touched_s += span_s;
        }
        if force_n > limit_n {
            over_limit_s += span_s;
        }
    }
    let rms_n = (touched_s > 0.0).then(|| (square / touched_s).sqrt());
    Some(Forces { peak_n, rms_n, over_limit_s })
}
