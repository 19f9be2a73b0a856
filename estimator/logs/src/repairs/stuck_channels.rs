//! Rows in which a channel stands still although it should move: its sensor or its bus had stopped.

use crate::checks::{Profile, has_holds, is_position, saturated, stops, stuck};
use crate::units;
use haptics::recording::{Recording, Warning};

/// Leaves the rows out in which a channel of the program is stuck. The first of equal values was measured.
pub fn take_out(recording: &mut Recording) -> Vec<Warning> {
    let mut is_out = vec![false; recording.len()];
    let mut found = Vec::new();
    for channel in recording.channels.iter().filter(|channel| units::is_program_name(&channel.name)) {
        // The checks come behind the repairs: a profile is made here only where it is needed.
        let is_position = is_position(channel);
        if !is_position && !has_holds(&channel.values) {
            continue;
        }
        let profile = Profile::of(&channel.values);
        if profile.is_constant() {
            continue;
        }
        if let Some(at_stops) = stops(recording, channel, &profile) {
            at_stops.spans.iter().for_each(|span| is_out[span.first..span.end].fill(true));
            found.push(at_stops);
            continue;
        }
        let limit = saturated(recording, channel, &profile);
        let Some(mut warning) = stuck(recording, channel, &profile, limit.as_ref()) else { continue };
        for span in &warning.spans {
            is_out[span.first + 1..span.end].fill(true);
        }
        if let Some(seen) = warning.text.strip_suffix("leave these out") {
            warning.text = format!("{seen}these rows are left out");
        }
        found.push(warning);
    }
    if !found.is_empty() {
        super::leave_out(recording, &is_out, &mut found);
    }
    found
}
