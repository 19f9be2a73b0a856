//! Needles: free, pressing, through, drawn out. The fit of the strokes tells the times ([`crate::identify::needle`]);
//! here they become states, and the channels of a hidden Markov model.

use super::evidence::{Evidence, Judge};
use super::threshold::percentile;
use crate::identify::needle;
use crate::identify::needle::channels::{Channels, channels};
use foundation::estimate::{EstimateError, Phase, StrokePhase};
use foundation::tasks::definition::Definition;
use foundation::tasks::{SystemState, Thresholds};
use haptics::recording::Recording;

/// Threshold of the model's channels, in multiples of the noise, or as a share of the signal's usual size, as for
/// blocks.
const NOISES: f64 = 5.0;
const SIGNAL_SHARE: f64 = 0.06;
const SPEED_SHARE: f64 = 0.06;
/// Depth below which the surface is not certainly passed, as a share of the depth that is reached.
const DEPTH_SHARE: f64 = 0.02;

/// The phases of a recording; nothing where no push into a sheet is seen.
pub fn phases(recording: &Recording) -> Result<Vec<StrokePhase>, EstimateError> {
    Ok(needle::fit(recording)?.constraints.into_iter().flat_map(|c| c.phases).collect())
}

/// The name of a phase in tasks.
fn name(phase: Phase) -> &'static str {
    match phase {
        Phase::Free => "free",
        Phase::Insertion => "insertion",
        Phase::Penetration => "penetration",
        Phase::Extraction => "extraction",
    }
}

/// The state of every sample; outside all phases the needle is free.
pub fn states(time_s: &[f64], phases: &[StrokePhase], of: impl Fn(&str) -> SystemState) -> Vec<SystemState> {
    let mut states = vec![of(name(Phase::Free)); time_s.len()];
    for phase in phases {
        let first = time_s.partition_point(|t| *t < phase.t0);
        let end = time_s.partition_point(|t| *t <= phase.t1);
        if first < end {
            states[first..end].fill(of(name(phase.phase)));
        }
    }
    states
}

/// Channels of a needle for a hidden Markov model: depth, force, speed inwards, and the additional force of an
/// untouched sheet. The thresholds that these are measured in come with them; nothing if no push into a sheet is seen.
pub fn evidence(
    recording: &Recording,
    time_s: &[f64],
    task: &Definition,
    given: Option<Thresholds>,
) -> Result<Option<(Evidence, Thresholds)>, EstimateError> {
    let Some(seen) = channels(recording)? else { return Ok(None) };
    let usual = |values: &[f64]| percentile(&mut values.iter().map(|v| v.abs()).collect::<Vec<_>>(), 0.95);
    let thresholds = task.thresholds(given, || Thresholds {
        force_n: (NOISES * seen.noise_n).max(SIGNAL_SHARE * usual(&seen.force_n)),
        velocity_m_s: SPEED_SHARE * usual(&seen.rate_m_s),
    });
    let deepest_m = seen.depth_m.iter().fold(0.0_f64, |most, depth| most.max(*depth));
    let raw = states(time_s, &seen.phases, |phase| task.state_of_phase(phase));
    let values = values(&seen, DEPTH_SHARE * deepest_m, &thresholds);
    let states = [Phase::Free, Phase::Insertion, Phase::Penetration, Phase::Extraction];
    let of = states.map(|phase| task.state_of_phase(name(phase)));
    let judge: Judge = Box::new(move |mean, level| {
        let of = |phase: Phase| of[phase as usize];
        match mean.iter().map(|v| v.sinh()).collect::<Vec<_>>()[..] {
            [depth, ..] if depth <= 0.0 => of(Phase::Free),
            [_, _, rate, _] if rate < -level => of(Phase::Extraction),
            [_, _, _, missing] if missing > level => of(Phase::Penetration),
            _ => of(Phase::Insertion),
        }
    });
    Ok(Some((Evidence { channels: 4, values, raw, judge }, thresholds)))
}

fn values(seen: &Channels, least_m: f64, thresholds: &Thresholds) -> Vec<f64> {
    let scaled = |value: f64, threshold: f64| (value / threshold.max(f64::MIN_POSITIVE)).asinh();
    let mut values = Vec::with_capacity(4 * seen.depth_m.len());
    for i in 0..seen.depth_m.len() {
        values.extend([
            scaled(seen.depth_m[i], least_m),
            scaled(seen.force_n[i], thresholds.force_n),
            scaled(seen.rate_m_s[i], thresholds.velocity_m_s),
            scaled(seen.missing_n[i], thresholds.force_n),
        ]);
    }
    values
}
