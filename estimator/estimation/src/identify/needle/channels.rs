//! Channels of a needle recording for a hidden Markov model: depth beyond the surface, force, speed inwards, and the
//! deficit of the force against an untouched sheet.

use super::sheet::{LEAST_LOADING, Sheet};
use super::strokes::{self, quiet_force};
use super::{phases, signals};
use foundation::estimate::{EstimateError, StrokePhase};
use foundation::signal::noise::white_noise;
use foundation::signal::task::{half_width, smooth, times};
use haptics::recording::Recording;

/// One entry a sample; a needle that is not held is outside and loaded by nothing.
#[derive(Clone, Debug)]
pub struct Channels {
    /// Way beyond the undisturbed surface, m; negative outside.
    pub depth_m: Vec<f64>,
    /// Force along the needle, N, without that outside.
    pub force_n: Vec<f64>,
    /// Speed inwards, m/s.
    pub rate_m_s: Vec<f64>,
    /// Force of an untouched sheet at this depth less the measured one, N.
    pub missing_n: Vec<f64>,
    /// White noise of the calmed force, N.
    pub noise_n: f64,
    /// Phases of the strokes.
    pub phases: Vec<StrokePhase>,
}

/// Reads a recording; nothing where no push into an untouched sheet is seen.
pub fn channels(recording: &Recording) -> Result<Option<Channels>, EstimateError> {
    let along = signals::along(recording)?;
    let pushes = strokes::pushes(&along);
    if pushes.iter().map(|p| p.samples.len()).sum::<usize>() < LEAST_LOADING {
        return Ok(None);
    }
    let sheet = Sheet::of(&along, &pushes)?;
    let surface_m = sheet.loading.surface_m;
    let time_s = times(recording);
    let (depth, force) = (smooth(&time_s, &along.depth_m), smooth(&time_s, &along.force_n));
    let quiet = quiet_force(&along);
    let mut held = vec![false; time_s.len()];
    along.holds.iter().for_each(|hold| held[hold.clone()].fill(true));
    // Outside by as much as the needle is ever pushed in.
    let outside_m = -depth.value.iter().fold(0.0_f64, |most, d| most.max(d - surface_m));
    let when_held = |i: usize, value: f64, else_: f64| if held[i] { value } else { else_ };
    let each = |of: &dyn Fn(usize) -> f64| (0..time_s.len()).map(of).collect::<Vec<f64>>();
    let window = (2 * half_width(&time_s) + 1) as f64;
    Ok(Some(Channels {
        depth_m: each(&|i| when_held(i, depth.value[i] - surface_m, outside_m)),
        force_n: each(&|i| when_held(i, force.value[i] - quiet, 0.0)),
        rate_m_s: each(&|i| when_held(i, depth.slope[i], 0.0)),
        missing_n: each(&|i| when_held(i, sheet.loading.force_n(depth.value[i]) - (force.value[i] - quiet), 0.0)),
        noise_n: white_noise(&along.force_n) / window.sqrt(),
        phases: phases::phases(&along, &pushes, &sheet.loading, recording),
    }))
}
