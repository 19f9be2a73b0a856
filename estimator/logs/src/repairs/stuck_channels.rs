//! Rows in which a channel stands still although it should move: its sensor or its bus had stopped.

use crate::checks::{Profile, has_holds, saturated, stops, stuck};
use crate::units;
use haptics::recording::{Channel, Recording, Warning};

/// Leaves the rows out in which a channel of the program is stuck, and those at an end stop. The first of equal values was measured.
pub fn take_out(recording: &mut Recording) -> Vec<Warning> {
    let mut is_out = vec![false; recording.len()];
    let mut found = Vec::new();
    for channel in recording.channels.iter().filter(|channel| units::is_program_name(&channel.name)) {
        let Some(warning) = stops(recording, channel).or_else(|| held(recording, channel)) else { continue };
        warning.spans.iter().for_each(|span| is_out[span.first..span.end].fill(true));
        found.push(warning);
    }
    if !found.is_empty() {
        super::leave_out(recording, &is_out, &mut found);
    }
    found
}

/// The rows in which a channel is stuck, without the first of each span.
fn held(recording: &Recording, channel: &Channel) -> Option<Warning> {
    // The checks come behind the repairs: a profile is made here only where it is needed.
    let profile = has_holds(&channel.values).then(|| Profile::of(&channel.values)).filter(|p| !p.is_constant())?;
    let limit = saturated(recording, channel, &profile);
    let mut warning = stuck(recording, channel, &profile, limit.as_ref())?;
    warning.spans.iter_mut().for_each(|span| span.first += 1);
    if let Some(seen) = warning.text.strip_suffix("leave these out") {
        warning.text = format!("{seen}these rows are left out");
    }
    Some(warning)
}
