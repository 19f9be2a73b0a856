//! Repairs of a recording on loading: stamps in bursts, held samples, wrapped angles, spikes. Each is told by a warning,
//! and `"as_recorded"` in the sidecar switches it off by its kind.

mod bursts;
mod held_samples;
mod wrapped_angles;

use super::checks;
use haptics::recording::{Recording, Warning};

/// Key of the sidecar that lists the kinds of repairs that are not made.
pub const AS_RECORDED: &str = "as_recorded";
/// Kinds of the repairs.
pub const KINDS: [&str; 4] = ["burst-stamps", "held-samples", "wrapped-angle", "spikes"];

/// A repair, with the warnings about it.
type Step = fn(&mut Recording) -> Vec<Warning>;

/// Repairs a recording; the warnings tell what was done.
pub fn repair(recording: &mut Recording) -> Vec<Warning> {
    let mut found = Vec::new();
    let wanted = |recording: &Recording, kind: &str| {
        let listed = recording.meta.other.get(AS_RECORDED).and_then(|list| list.as_array());
        !listed.is_some_and(|list| list.iter().any(|entry| entry == kind))
    };
    let steps: [(&str, Step); 3] = [
        (KINDS[0], |recording| bursts::spread(recording).into_iter().collect()),
        (KINDS[1], |recording| held_samples::take_out(recording).into_iter().collect()),
        (KINDS[2], wrapped_angles::unwrap),
    ];
    for (kind, step) in steps {
        if wanted(recording, kind) {
            found.extend(step(recording));
        }
    }
    if wanted(recording, KINDS[3])
        && let Some((other, said)) = checks::repaired(recording)
    {
        recording.channels = other.channels;
        found.extend(said);
    }
    found
}

#[cfg(test)]
mod tests;
