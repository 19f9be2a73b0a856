//! Needles: free, pressing, through, drawn out. What happens when is told by the fit of the strokes
//! ([`crate::identify::needle`]); here it becomes states.

use super::SystemState;
use crate::estimate::{EstimateError, Phase, StrokePhase};
use crate::identify::needle;
use haptics::recording::Recording;

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
