//! Values that no hand reaches, and single samples far from their neighbours.

use super::findings::{about, is_position, limited, place};
use super::profile::Profile;
use crate::units;
use foundation::signal::wrench::is_turned_sensor;
use haptics::recording::{Channel, Recording, Span, Warning};
use std::cell::LazyCell;
use std::ops::Range;

/// Distance of a value from the others, in multiples of their spread, from which it is no measurement.
const OUTLIER_SPREADS: f64 = 1e6;
/// Size in m, rad, N, or their rates from which a value is no measurement.
const IMPOSSIBLE: f64 = 1e9;
/// Least leap of a spike, away and back, in multiples of the largest other step around it.
const SPIKE_STEPS: f64 = 5.0;
/// Number of samples on either side that are compared.
const AROUND: usize = 32;
/// Number of other steps that may be as large, for another spike or two.
const FORGIVEN: usize = 4;
/// The same for far larger spikes, which come in clusters of up to seven within 64 samples, and on two neighbours.
const FORGIVEN_IN_CLUSTERS: usize = 12;
/// Least leap of a spike of a cluster, in multiples of the largest step that is not forgiven.
const CLUSTER_STEPS: f64 = 20.0;
/// Steps of less than this many times the mean of the steps around need no closer look.
const WORTH_A_LOOK: f64 = 2.5;
/// Another channel that leaps by this many times its usual step at the same sample has felt the same blow.
const FELT_STEPS: f64 = 2.0;
/// Largest number of samples of a spike: junk falls on two or three neighbours now and then.
const LONGEST: usize = 3;
/// Largest distance to which a spike comes back, as a share of its height.
const RETURN_SHARE: f64 = 0.3;
/// Least height of a spike, as a share of the channel's usual range.
const SPIKE_SHARE: f64 = 0.01;

/// Values that no hand and no mechanism reach, in SI units, or too far beyond the channel's own spread.
pub fn impossible(channel: &Channel, profile: &Profile) -> Option<Warning> {
    let middle = profile.quantile(0.5);
    // Nine tenths of the samples: a force that is zero most of the time still has a spread.
    let spread = profile.spread();
    let reach = if spread > 0.0 { (OUTLIER_SPREADS * spread).min(IMPOSSIBLE) } else { IMPOSSIBLE };
    let beyond = |v: f64| (v - middle).abs() > reach || v.abs() > IMPOSSIBLE;
    if !beyond(profile.low) && !beyond(profile.high) {
        return None;
    }
    let places: Vec<usize> = (0..channel.values.len()).filter(|&i| beyond(channel.values[i])).collect();
    let &first = places.first()?;
    let spans = places.iter().map(|&i| Span { first: i, end: i + 1 }).collect();
    let text = format!(
        "{} is {:e} in row {} and {} in all lie(s) impossibly far from the rest: every result that uses it is spoilt; correct or remove the row(s)",
        channel.name,
        channel.values[first],
        first + 1,
        places.len()
    );
    Some(about("outlier", channel, limited(spans), text))
}

/// Single samples that leap away from a signal that continues as if nothing had happened.
pub fn warning(
    recording: &Recording,
    channel: &Channel,
    profile: &Profile,
    impossible: Option<&Warning>,
) -> Option<Warning> {
    let mut found = places(recording, channel, profile);
    // Impossible values have been reported already.
    found.retain(|&i| impossible.is_none_or(|w| w.spans.iter().all(|s| s.first != i)));
    let &first = found.first()?;
    let whole = bridged(&channel.values, &found);
    let largest = found.iter().map(|&i| (channel.values[i] - whole[i]).abs()).fold(0.0, f64::max);
    let text = format!(
        "{} has {} sample(s) that are spikes, the first at {}, up to {largest:.4} {} away from their neighbours; leave them out or repair the channel",
        channel.name,
        found.len(),
        place(recording, first),
        channel.unit
    );
    let spans = found.iter().map(|&i| Span { first: i, end: i + 1 }).collect();
    Some(about("outlier", channel, limited(spans), text))
}

/// The recording with a line between its neighbours in the place of every spike, and a warning for each channel that had
/// one. `None` if none had.
pub fn repaired(recording: &Recording) -> Option<(Recording, Vec<Warning>)> {
    let channels = &recording.channels;
    let known: Vec<usize> = (0..channels.len()).filter(|&k| units::is_program_name(&channels[k].name)).collect();
    let work = |i: usize| without_spikes(recording, &channels[known[i]]);
    let found = super::parallel(known.len(), recording.len() * known.len(), work);
    if found.iter().all(Option::is_none) {
        return None;
    }
    let (mut other, mut said) = (recording.clone(), Vec::new());
    for (k, (values, warning)) in known.iter().zip(found).filter_map(|(k, one)| Some((*k, one?))) {
        other.channels[k].values = values;
        said.push(warning);
    }
    Some((other, said))
}

/// The values of a channel with lines in the place of its spikes, and a warning. `None` without spikes.
fn without_spikes(recording: &Recording, channel: &Channel) -> Option<(Vec<f64>, Warning)> {
    let mut found = places(recording, channel, &Profile::of(&channel.values));
    let mut first = *found.first()?;
    let mut other = Channel { values: bridged(&channel.values, &found), ..channel.clone() };
    // A spike hides others beside it.
    loop {
        let before = found.len();
        found.extend(places(recording, &other, &Profile::of(&other.values)));
        found.sort_unstable();
        found.dedup();
        if found.len() == before {
            break;
        }
        first = found[0];
        other.values = bridged(&channel.values, &found);
    }
    let off = found.iter().map(|&i| (channel.values[i] - other.values[i]).abs()).fold(0.0, f64::max);
    let text = format!(
        "{} has {} sample(s) that are spikes, the first at {}, up to {off:.4} {} away from their neighbours, which take their place",
        channel.name,
        found.len(),
        place(recording, first),
        channel.unit
    );
    let spans = found.iter().map(|&i| Span { first: i, end: i + 1 }).collect();
    Some((other.values, about("outlier", channel, limited(spans), text)))
}

/// The values with lines in the place of some samples, none of which is the first or the last.
fn bridged(values: &[f64], left_out: &[usize]) -> Vec<f64> {
    let mut whole = values.to_vec();
    for run in left_out.chunk_by(|a, b| a + 1 == *b) {
        let (before, after) = (run[0] - 1, run[run.len() - 1] + 1);
        for &i in run {
            let share = (i - before) as f64 / (after - before) as f64;
            whole[i] = values[before] + share * (values[after] - values[before]);
        }
    }
    whole
}

/// Samples of the spikes of a channel. A leap that other channels feel too is a blow, and no fault of a sensor.
fn places(recording: &Recording, channel: &Channel, profile: &Profile) -> Vec<usize> {
    // Rows of a table of poses do not follow each other: one alone among others is a pose, not a spike.
    if recording.time_s.is_none() && is_turned_sensor(recording) {
        return Vec::new();
    }
    let mut found = spikes(&channel.values, is_position(channel), SPIKE_SHARE * profile.spread());
    found.retain(|&i| !felt_elsewhere(recording, channel, i));
    found
}

/// Indices of spikes of at least `least`.
fn spikes(values: &[f64], position: bool, least: f64) -> Vec<usize> {
    if values.len() < 2 * AROUND {
        return Vec::new();
    }
    let steps = values.len() - 1;
    // Most channels need no look at all of their steps.
    let quantum = LazyCell::new(|| smallest_step(values));
    let mut found = Vec::new();
    for first in (0..steps).step_by(AROUND) {
        let block = &values[first..(first + AROUND + 1).min(values.len())];
        let (sum, largest) = match block.first_chunk() {
            Some(whole) => steps_of(whole),
            None => block
                .windows(2)
                .map(|w| (w[1] - w[0]).abs())
                .fold((0.0, 0.0), |(s, m): (f64, f64), v| (s + v, m.max(v))),
        };
        let mean = sum / (block.len() - 1) as f64;
        // A spike and those that are forgiven beside it, among steps a fifth its size, stay above this.
        let floor = least.max(WORTH_A_LOOK * mean);
        if largest < floor {
            continue;
        }
        for (k, size) in block.windows(2).map(|w| (w[1] - w[0]).abs()).enumerate() {
            let at = first + k + 1;
            if size < floor || size <= 0.0 || found.last().is_some_and(|last| *last >= at) {
                continue;
            }
            let fits = |length: &usize| {
                at + length - 1 < steps && is_spike(values, at..at + length, (position, floor), &quantum)
            };
            if let Some(length) = (1..=LONGEST).find(fits) {
                found.extend(at..at + length);
            }
        }
    }
    found
}

/// Sum and largest of the steps in a block: in lanes, so that the compiler can use wide registers.
fn steps_of(block: &[f64; AROUND + 1]) -> (f64, f64) {
    const LANES: usize = 8;
    let (mut sums, mut largest) = ([0.0; LANES], [0.0; LANES]);
    for first in (0..AROUND).step_by(LANES) {
        for k in 0..LANES {
            let step = (block[first + k + 1] - block[first + k]).abs();
            sums[k] += step;
            largest[k] = if step > largest[k] { step } else { largest[k] };
        }
    }
    (sums.iter().sum(), largest.into_iter().fold(0.0, f64::max))
}

/// Smallest step of a channel that is not zero; infinite without one.
fn smallest_step(values: &[f64]) -> f64 {
    values.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|step| *step > 0.0).fold(f64::INFINITY, f64::min)
}

/// True if the samples `run` leap away together by `least` or more, and the next one is back. `quantum`: smallest step of the channel.
fn is_spike(
    values: &[f64],
    run: Range<usize>,
    (position, least): (bool, f64),
    quantum: &LazyCell<f64, impl FnOnce() -> f64>,
) -> bool {
    let (at, end) = (run.start, run.end);
    let (there, back) = (values[at] - values[at - 1], values[end] - values[end - 1]);
    let height = there.abs().min(back.abs());
    if there * back >= 0.0 || height < least || (values[end] - values[at - 1]).abs() > RETURN_SHARE * height {
        return false;
    }
    // Three samples of a blow differ, those of a spike hardly.
    if run.len() == LONGEST && values[run.clone()].iter().any(|v| (v - values[at]).abs() > RETURN_SHARE * height) {
        return false;
    }
    let is_small = |step: f64| SPIKE_STEPS * step.abs() < height;
    // The top of a slope has one at its side; a spike has a sample as far away as itself there only if that is another one.
    let before = (at.saturating_sub(LONGEST + 2)..at - 1).map(|i| values[at - 1] - values[i]);
    let after = (end + 1..(end + LONGEST + 2).min(values.len())).map(|i| values[end] - values[i]);
    if !is_quiet(before, is_small) || !is_quiet(after, is_small) {
        return false;
    }
    let usual = usual_step(values, at, FORGIVEN);
    // A force out of nothing may be a touch; a position that stands still does not leap. Beside equal values, the smallest step of the
    // channel may be a coarse one.
    let rest = usual > 0.0 || position || values[at - 1] != 0.0 && is_small(**quantum);
    let is_alone = run.len() == 1 && height > SPIKE_STEPS * usual;
    rest && (is_alone || height > CLUSTER_STEPS * usual_step(values, at, FORGIVEN_IN_CLUSTERS))
}

/// True for a side of a spike with a sample near it, and for one without samples.
fn is_quiet(mut steps: impl ExactSizeIterator<Item = f64>, is_small: impl Fn(f64) -> bool) -> bool {
    steps.len() == 0 || steps.any(is_small)
}

/// Largest step around a sample, without the two steps at the sample itself and so many others, but at least the smallest
/// one that is a step.
fn usual_step(values: &[f64], at: usize, forgiven: usize) -> f64 {
    let (mut others, mut quantum) = ([0.0; FORGIVEN_IN_CLUSTERS + 1], f64::INFINITY);
    let (first, end) = (at.saturating_sub(AROUND), (at + AROUND).min(values.len() - 1));
    for i in (first..end).filter(|&i| i + 1 != at && i != at) {
        let mut step = (values[i + 1] - values[i]).abs();
        if step > 0.0 {
            quantum = quantum.min(step);
        }
        for slot in &mut others {
            if step > *slot {
                std::mem::swap(slot, &mut step);
            }
        }
    }
    if quantum.is_finite() { others[forgiven].max(quantum) } else { 0.0 }
}

/// True when another channel leaps at the same sample too.
fn felt_elsewhere(recording: &Recording, channel: &Channel, at: usize) -> bool {
    recording.channels.iter().filter(|c| c.name != channel.name && units::is_program_name(&c.name)).any(|other| {
        let values = &other.values;
        let leap = (values[at] - values[at - 1]).abs().max((values[at + 1] - values[at]).abs());
        leap > FELT_STEPS * usual_step(values, at, FORGIVEN)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const AT: usize = 150;

    /// A slow force with some samples from [`AT`] on replaced.
    fn with(samples: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = (0..300_u32).map(|i| -1.0 + 1e-3 * f64::from(i % 7)).collect();
        values[AT..AT + samples.len()].copy_from_slice(samples);
        values
    }

    #[test]
    fn a_spike_stands_alone_and_the_top_of_a_slope_does_not() {
        let found = |values: &[f64]| spikes(values, false, 0.01);
        assert_eq!(found(&with(&[1.0])), [AT]);
        assert_eq!(found(&with(&[1.0, 1.01])), [AT, AT + 1]);
        assert_eq!(found(&with(&[1.0, 1.01, 0.99])), [AT, AT + 1, AT + 2]);
        assert_eq!(found(&with(&[0.2, 1.4, 0.0])), [0; 0]);
        // Two with one sample between them.
        assert_eq!(found(&with(&[1.0, -1.0, 1.0])), [AT, AT + 2]);
        assert_eq!(found(&with(&[-0.7, -0.4, 0.0, -0.45, -0.75])), [0; 0]);
    }

    #[test]
    fn a_flicker_of_the_smallest_step_is_no_spike() {
        let coarse = |quiet: f64| {
            let mut values: Vec<f64> = (0..300_u32).map(|i| 4.0 + f64::from(i / 100) * quiet).collect();
            values[AT] += 1.0;
            values
        };
        assert_eq!(spikes(&coarse(1.0), false, 0.01), [0; 0]);
        assert_eq!(spikes(&coarse(0.1), false, 0.01), [AT]);
    }
}
