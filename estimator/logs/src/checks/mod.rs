//! Faults in a recording that can be read all the same: gaps, stuck and copied channels, plateaus, jumps, spikes,
//! units.
//!
//! The thresholds are set so that the behaviour of real encoders and sensors (dwelling at a stop, coarse quanta, one
//! late cycle) is not reported: a warning that is often wrong is not read when it is right. `tests/tests/logs.rs`
//! measures both.

mod alternation;
mod clock;
mod findings;
mod held;
mod leaps;
mod profile;
mod repeats;
mod scale;
mod spikes;
mod stops;

pub use alternation::ALTERNATION;
pub(crate) use alternation::warnings as alternating;
pub(crate) use findings::{is_position, limited, place};
pub(crate) use held::{has_holds, saturated, stuck};
pub(crate) use profile::{Profile, extremes};
pub use repeats::copied;
pub use scale::UNIT;
pub use spikes::repaired;
pub(crate) use stops::stops;

use super::units;
use haptics::recording::{Channel, Recording, Warning};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Recordings with fewer values than this are looked at by one thread.
const SMALL: usize = 200_000;

/// All warnings about the samples of one recording, each with the samples it is about.
pub fn warnings(recording: &Recording) -> Vec<Warning> {
    warnings_of(recording, true)
}

/// [`warnings`], without those about spikes if they have been repaired.
pub fn warnings_of(recording: &Recording, with_spikes: bool) -> Vec<Warning> {
    let channels = &recording.channels;
    let own = parallel(channels.len(), recording.len() * channels.len(), |i| {
        of_channel(recording, &channels[i], with_spikes)
    });
    let (profiles, own): (Vec<Profile>, Vec<Vec<Warning>>) = own.into_iter().unzip();
    let about_all: [&(dyn Fn() -> Vec<Warning> + Sync); 6] = [
        &|| clock::warnings(recording),
        &|| leaps::warnings(recording),
        &|| alternation::warnings(recording),
        &|| held::coarse(recording, &profiles),
        &|| repeats::warnings(recording, &profiles),
        &|| scale::warnings(recording, &profiles),
    ];
    let all = parallel(about_all.len(), recording.len() * channels.len(), |i| about_all[i]());
    let mut parts = all.into_iter();
    let mut found = parts.next().unwrap_or_default();
    found.extend(own.into_iter().flatten());
    found.extend(parts.flatten());
    found
}

fn of_channel(recording: &Recording, channel: &Channel, with_spikes: bool) -> (Profile, Vec<Warning>) {
    let profile = Profile::of(&channel.values);
    let known = units::is_program_name(&channel.name);
    let mut found = Vec::new();
    let limit = saturated(recording, channel, &profile);
    if known {
        let impossible = spikes::impossible(channel, &profile);
        if with_spikes {
            found.extend(spikes::warning(recording, channel, &profile, impossible.as_ref()));
        }
        found.extend(impossible);
        found.extend(stuck(recording, channel, &profile, limit.as_ref()));
    }
    found.extend(limit);
    (profile, found)
}

/// `work` for 0 … `count` − 1, in that order, on all cores when there are `values` enough.
fn parallel<T: Send>(count: usize, values: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(count);
    if cores < 2 || values < SMALL {
        return (0..count).map(work).collect();
    }
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::with_capacity(count));
    let run = || {
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            if i >= count {
                return;
            }
            let result = work(i);
            done.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((i, result));
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..cores {
            // A thread that cannot be had is no loss: this one works too.
            let _ = std::thread::Builder::new().spawn_scoped(scope, run);
        }
        run();
    });
    let mut done = done.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    done.sort_by_key(|&(i, _)| i);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests;
