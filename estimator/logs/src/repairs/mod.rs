//! Repairs of a recording on loading: numbers that stand for no value, stamps in bursts, held samples, wrapped angles and counters, spikes. Each is told by a warning,
//! and `"as_recorded"` in the sidecar switches it off by its kind.

mod held_samples;
mod integrated;
mod sentinels;
mod stuck_channels;
mod wrapped_angles;
mod wrapped_counters;

use super::{bursts, checks};
use haptics::recording::{REPAIRS, Recording, Span, Warning};

/// A repair, with the warnings about it.
type Step = fn(&mut Recording) -> Vec<Warning>;

/// Repairs a recording; the warnings tell what was done.
pub fn repair(recording: &mut Recording) -> Vec<Warning> {
    let mut found = Vec::new();
    let steps: [(&str, Step); 6] = [
        (REPAIRS[0], sentinels::take_out),
        (bursts::BURSTS, |recording| bursts::spread(recording).into_iter().collect()),
        (REPAIRS[2], |recording| held_samples::take_out(recording).into_iter().collect()),
        (REPAIRS[3], wrapped_angles::unwrap),
        (REPAIRS[4], wrapped_counters::unwrap),
        (REPAIRS[5], stuck_channels::take_out),
    ];
    for (kind, step) in steps {
        if recording.meta.repairs(kind) {
            found.extend(step(recording));
        }
    }
    if recording.meta.repairs(REPAIRS[6])
        && let Some((other, said)) = checks::repaired(recording)
    {
        recording.channels = other.channels;
        found.extend(said);
    }
    found.extend(integrated::complete(recording));
    found
}

/// Adds a cycle behind every sample at which a signal leaps back to the other end of its range.
fn add_cycles(values: &mut [f64], cycle: f64, leaps: &[usize]) {
    let (mut cycles, mut before) = (0.0, 0.0);
    let mut leaps = leaps.iter().peekable();
    for (i, value) in values.iter_mut().enumerate() {
        let read = *value;
        if leaps.next_if(|at| **at == i).is_some() {
            cycles -= (read - before).signum();
        }
        before = read;
        *value = read + cycle * cycles;
    }
}

/// Leaves rows out; the spans of the warnings become the samples on both sides of them.
fn leave_out(recording: &mut Recording, is_out: &[bool], warnings: &mut [Warning]) {
    let kept: Vec<usize> = (0..is_out.len()).filter(|&row| !is_out[row]).collect();
    let before = |row: usize| kept.partition_point(|kept| *kept < row);
    for span in warnings.iter_mut().flat_map(|warning| &mut warning.spans) {
        let (first, end) = (before(span.first).saturating_sub(1), before(span.end) + 1);
        *span = Span { first, end: end.min(kept.len()) };
    }
    recording.keep(&kept);
}

#[cfg(test)]
mod tests;
