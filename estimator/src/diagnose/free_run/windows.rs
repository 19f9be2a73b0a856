//! Gain of a cause in a free-run simulation, from the measured state over short windows.
//!
//! A model with inertia is driven by the measured force, and its position is compared. A model without one (a light
//! crank, a sheet) would follow every error of the force at once. There a simulated hand holds the object and follows
//! the measured motion, and its force is compared. The integrator is that of the servo's worlds.

use crate::diagnose::contract::{Rollout, RolloutOf};
use crate::diagnose::data::limits::FEWEST;
use crate::diagnose::selection::held_out_gain;
use crate::diagnose::selection::held_out_gain::{DRAWS, LEAST_CHANGE_SHARE};

/// Longest window, s. Windows are shorter at the end of a block, but at least half of it.
/// Choice: halved or doubled, none of 55 answers changes.
pub const ROLLOUT_WINDOW_S: f64 = 0.5;
/// Reasons why there is no free run.
pub const NO_LAW: &str = "no law of a world runs it";
pub const TOO_FEW: &str = "too few uninterrupted pieces were there to run it over";
pub const NOT_FAITHFUL: &str = "the laws of a world do not give the force that was found";
pub const AT_AN_INSTANT: &str = "it is one instant: nothing of it runs on";
pub const PUT_BACK: &str = "the forces are put back to their motion before anything is run";
/// The simulated model already contains the cause.
const THE_SAME: &str = "where the model can be run forward, it runs the same without it";
pub const NO_CLOCK: &str = "a path without a clock cannot be run forward in time";
/// The relation is static: it has no state to simulate.
pub const AT_ONCE: &str =
    "here one measured quantity follows from the others at once: sample by sample is forward in time";

/// Compared quantity, its unit and its windows.
pub struct Compared<'a> {
    pub of: RolloutOf,
    pub unit: &'a str,
    pub window_s: f64,
    /// True if the windows took part in the choice of the causes.
    pub in_turn: bool,
}

/// Sum of the squared errors over a window, and their number.
pub type Errors = (f64, f64);

/// Windows of at most `most` rows of which each goes on from the one before, but none with fewer than `least`. `order`
/// has the rows by time.
pub fn windows(order: &[usize], [least, most]: [usize; 2], goes_on: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
    let runs = order.chunk_by(|a, b| goes_on(*a, *b)).flat_map(|run| run.chunks(most));
    runs.filter(|window| window.len() >= least).map(<[usize]>::to_vec).collect()
}

/// Rollout of the errors without and with a cause, window by window.
pub fn told(what: &Compared<'_>, windows: &[[Errors; 2]]) -> Result<Rollout, String> {
    if windows.len() < FEWEST {
        return Err(TOO_FEW.to_owned());
    }
    let all: Vec<usize> = (0..windows.len()).collect();
    let mean = |side: usize, drawn: &[usize]| {
        let (sum, count) = drawn.iter().map(|w| windows[*w][side]).fold((0.0, 0.0), |(s, n), e| (s + e.0, n + e.1));
        sum / f64::max(count, 1.0)
    };
    let share = |drawn: &[usize]| 1.0 - mean(1, drawn) / mean(0, drawn).max(1e-300);
    let [rms_before, rms_after] = [0, 1].map(|side| mean(side, &all).sqrt());
    if !(rms_before.is_finite() && rms_after.is_finite()) {
        return Err("the laws do not stay where anything was measured".to_owned());
    }
    if (rms_before - rms_after).abs() < LEAST_CHANGE_SHARE * rms_before {
        return Err(THE_SAME.to_owned());
    }
    Ok(Rollout {
        of: what.of,
        unit: what.unit.to_owned(),
        window_s: what.window_s,
        windows: windows.len(),
        rms_before,
        rms_after,
        share: share(&all),
        interval: held_out_gain::bootstrap(all.len(), DRAWS, &share),
        in_turn: what.in_turn,
    })
}
