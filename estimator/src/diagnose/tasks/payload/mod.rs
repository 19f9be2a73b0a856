//! Diagnosis of a force/torque sensor with a load: which part carries its reading, and between two sets, what changed.

mod changed;
mod evidence;
mod one;

use crate::diagnose::findings::Findings;
use foundation::estimate::EstimateError;
use haptics::recording::Recording;

/// Diagnoses one set of poses, or compares two.
///
/// # Errors
/// One sentence for more than two sets, and that of a set without orientation or force.
pub fn payload(recordings: &[Recording]) -> Result<Findings, EstimateError> {
    match recordings {
        [one] => one::diagnosed(one),
        [before, after] => changed::diagnosed(before, after),
        all => Err(EstimateError::Other(format!(
            "the diagnosis of a sensor's load compares two recordings, and there are {}; name two of them",
            all.len()
        ))),
    }
}
