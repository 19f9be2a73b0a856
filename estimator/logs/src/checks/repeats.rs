//! Rows that were written twice, and channels that are a copy of another one.

use super::findings::{limited, place};
use super::profile::{Profile, holds};
use crate::fingerprint::Shared;
use crate::plan::Plan;
use crate::units;
use foundation::signal::thinned::thinned;
use haptics::recording::{Channel, Recording, Span, Warning};
use std::collections::HashMap;

/// More equal rows than this in a row are a rest or a stuck recorder, not a repeated sample.
const MOST_REPEATS: usize = 5;
/// Least number of samples over which a copy is equal.
const COPY_SAMPLES: usize = 100;
/// Least share of those samples that move.
const COPY_MOVES: f64 = 0.5;
/// Rows that are compared before looking closer: one in so many.
const STRIDE: usize = 16;
/// Largest delay at which a copy is looked for, samples.
const MOST_DELAY: usize = 200;
/// A channel whose second differences are smaller than this share of its steps carries no noise that it could share.
const ROUGHNESS: f64 = 0.2;
/// Two channels share their noise when a straight line explains one by the other this well.
const SAME_NOISE: f64 = 1e-8;

/// Repeated rows and copied channels of one recording.
pub fn warnings(recording: &Recording, profiles: &[Profile]) -> Vec<Warning> {
    let known: Vec<usize> = (0..recording.channels.len())
        .filter(|&i| units::is_program_name(&recording.channels[i].name) && !profiles[i].is_constant())
        .collect();
    let mut found: Vec<Warning> = repeated_rows(recording, profiles, &known).into_iter().collect();
    let pairs = Pairs::of(recording, &known);
    for (k, &a) in known.iter().enumerate() {
        for (j, &b) in known.iter().enumerate().skip(k + 1) {
            let (one, other) = (&recording.channels[a], &recording.channels[b]);
            found.extend(copy(recording, one, other, pairs.equal(k, j)));
        }
    }
    found.extend(copies_beside(recording, profiles, &known));
    found
}

/// Channels that are equal, at least one of them without a name of the program's: over the whole recording, or a force some samples
/// later. A force or a torque of the program's is the one that was not measured: a position is often recorded twice.
fn copies_beside(recording: &Recording, profiles: &[Profile], known: &[usize]) -> Vec<Warning> {
    let channels = &recording.channels;
    let is_force = |k: usize| known.contains(&k) && matches!(channels[k].unit.as_str(), "N" | "Nm");
    let mut first_of: HashMap<Vec<u64>, usize> = HashMap::new();
    let mut found = Vec::new();
    for k in (0..channels.len()).filter(|&k| !profiles[k].is_constant() && moves(&channels[k].values)) {
        let some: Vec<u64> = thinned(recording.len()).map(|row| channels[k].values[row].to_bits()).collect();
        let first = *first_of.entry(some).or_insert(k);
        let is_told = known.contains(&first) && known.contains(&k);
        if first == k || is_told || channels[first].values != channels[k].values {
            continue;
        }
        let (copy, source) = if is_force(first) { (first, k) } else { (k, first) };
        let whole = Span { first: 0, end: recording.len() };
        found.push(copied_from(recording, [copy, source].map(|k| &channels[k]), "the same as", whole));
    }
    for force in (0..channels.len()).filter(|&k| is_force(k)) {
        let others = (0..channels.len()).filter(|k| !known.contains(k));
        let late = others.filter_map(|k| Some((k, delayed(&channels[k].values, &channels[force].values)?)));
        let late = late.filter(|(_, (delay, _))| *delay != 0);
        let pair = |k: usize| [force, k].map(|k| &channels[k]);
        found.extend(late.map(|(k, (delay, span))| copied_from(recording, pair(k), &in_words(delay), span)));
    }
    found
}

/// The warning about a channel that is a copy of another one. `how`: words such as *the same as*.
fn copied_from(recording: &Recording, [copy, source]: [&Channel; 2], how: &str, span: Span) -> Warning {
    let [copy, source] = [copy, source].map(|channel| channel.name.as_str());
    let stretch = if span.end - span.first == recording.len() {
        "over the whole recording".to_owned()
    } else {
        format!("from {} on, over {} samples", place(recording, span.first), span.end - span.first)
    };
    Warning {
        kind: "copied-channel".to_owned(),
        column: Some(copy.to_owned()),
        spans: vec![span],
        text: format!("{copy} is {how} {source} {stretch}: one of the two was not measured; do not use it"),
        ..Warning::default()
    }
}

/// Words for a copy that is some samples late; early, if they are negative.
fn in_words(delay: isize) -> String {
    let (count, order) = (delay.unsigned_abs(), if delay > 0 { "late" } else { "early" });
    format!("the same, {count} samples {order}, as")
}

/// Samples either side of a place that tell how lively a channel is there.
const AROUND: usize = 8;
/// Classes of liveliness: powers of two below the liveliest.
const CLASSES: usize = 24;
/// Expected number of repeats by chance in a whole recording that may be taken for faults.
const BY_CHANCE: f64 = 0.02;

/// Probability that a channel repeats a value by itself, given its liveliness just there.
///
/// A slow, quantised channel repeats often and a fast or noisy one never. The estimate is the share of repeats among
/// all samples of the recording with about the same liveliness of the channel.
struct Habit {
    class: Vec<u8>,
    chance: [f64; CLASSES],
}

impl Habit {
    fn of(values: &[f64]) -> Self {
        let steps: Vec<f64> = values.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
        let mut sum = vec![0.0; steps.len() + 1];
        for (i, step) in steps.iter().enumerate() {
            sum[i + 1] = sum[i] + step;
        }
        let mean = |i: usize| {
            let (low, high) = (i.saturating_sub(AROUND), (i + AROUND + 1).min(steps.len()));
            (sum[high] - sum[low]) / (high - low) as f64
        };
        let liveliest = (0..steps.len()).map(mean).fold(0.0, f64::max);
        let class_of = |mean: f64| ((liveliest / mean).log2().floor()).clamp(0.0, CLASSES as f64 - 1.0) as u8;
        let class: Vec<u8> = (0..steps.len()).map(|i| class_of(mean(i))).collect();
        let (mut all, mut held) = ([1.0; CLASSES], [0.5; CLASSES]);
        for (&class, &step) in class.iter().zip(&steps) {
            all[usize::from(class)] += 1.0;
            held[usize::from(class)] += f64::from(u8::from(step == 0.0));
        }
        Self { class, chance: std::array::from_fn(|k| held[k] / all[k]) }
    }

    /// Probability that sample `i`, at least 1, repeats the one before.
    fn repeats(&self, i: usize) -> f64 {
        self.class.get(i - 1).map_or(1.0, |&class| self.chance[usize::from(class)])
    }
}

/// Samples that repeat the one before in every channel, where the channels' habits make that next to impossible.
fn repeated_rows(recording: &Recording, profiles: &[Profile], known: &[usize]) -> Option<Warning> {
    let lively = *known.iter().min_by_key(|&&i| profiles[i].unchanged)?;
    if known.len() < 2 || profiles[lively].unchanged == 0 {
        return None;
    }
    let values = |c: usize| recording.channels[c].values.as_slice();
    let same = |i: usize| known.iter().all(|&c| values(c)[i] == values(c)[i - 1]);
    let mut spans: Vec<Span> = holds(values(lively), 2)
        .into_iter()
        .filter(|s| s.end - s.first <= MOST_REPEATS + 1 && (s.first + 1..s.end).all(same))
        .map(|s| Span { first: s.first + 1, end: s.end })
        .collect();
    if spans.is_empty() {
        return None;
    }
    let habits: Vec<Habit> = known.iter().map(|&c| Habit::of(values(c))).collect();
    let by_itself = |s: &Span| habits.iter().map(|habit| habit.repeats(s.first)).product::<f64>();
    spans.retain(|s| by_itself(s) * recording.len() as f64 <= BY_CHANCE);
    let first = spans.first()?;
    let text = format!(
        "{} sample(s) repeat the one before in every measured channel, the first at {}: they were written again instead of measured; leave them out",
        spans.iter().map(|s| s.end - s.first).sum::<usize>(),
        place(recording, first.first)
    );
    Some(Warning {
        kind: "duplicate-samples".to_owned(),
        column: None,
        spans: limited(spans),
        text,
        ..Warning::default()
    })
}

/// Places of equal, moving values of two channels: one look at all of them, place by place, instead of one a pair.
struct Pairs {
    count: usize,
    places: Vec<Vec<usize>>,
}

impl Pairs {
    fn of(recording: &Recording, known: &[usize]) -> Self {
        let count = known.len();
        let mut places = vec![Vec::new(); count * count];
        let columns: Vec<&[f64]> = known.iter().map(|&c| recording.channels[c].values.as_slice()).collect();
        let mut here = vec![0.0; count];
        for i in (STRIDE..recording.len()).step_by(STRIDE) {
            for (value, column) in here.iter_mut().zip(&columns) {
                *value = column[i];
            }
            for (a, &value) in here.iter().enumerate() {
                for (b, &other) in here.iter().enumerate().skip(a + 1) {
                    if value == other && value != columns[a][i - 1] {
                        places[a * count + b].push(i);
                    }
                }
            }
        }
        Self { count, places }
    }

    /// Places where the known channels `a` < `b` are equal and move.
    fn equal(&self, a: usize, b: usize) -> &[usize] {
        &self.places[a * self.count + b]
    }
}

/// `other` as a copy of `one`: equal, equal but later, or scaled and shifted with the same noise.
fn copy(recording: &Recording, one: &Channel, other: &Channel, equal: &[usize]) -> Option<Warning> {
    let (a, b) = (one.values.as_slice(), other.values.as_slice());
    let (span, how) = if let Some(span) = equal_stretch(a, b, equal) {
        (span, "the same as".to_owned())
    } else if let Some((delay, span)) = delayed(a, b) {
        (span, in_words(delay))
    } else {
        let (factor, offset) = same_noise(a, b)?;
        (Span { first: 0, end: b.len() }, format!("to all digits {factor:.6} times, plus {offset:.4},"))
    };
    Some(copied_from(recording, [other, one], &how, span))
}

/// The longest segment in which `a` and `b` are equal and move, out of those that hold one of `probes`.
fn equal_stretch(a: &[f64], b: &[f64], probes: &[usize]) -> Option<Span> {
    let n = a.len().min(b.len());
    let mut best: Option<Span> = None;
    for &probe in probes {
        if best.is_some_and(|s| s.end > probe) {
            continue;
        }
        let first = (0..probe).rev().find(|&i| a[i] != b[i]).map_or(0, |i| i + 1);
        let end = (probe..n).find(|&i| a[i] != b[i]).unwrap_or(n);
        if best.is_none_or(|s| end - first > s.end - s.first) {
            best = Some(Span { first, end });
        }
    }
    best.filter(|s| moves(&a[s.first..s.end]))
}

fn moves(values: &[f64]) -> bool {
    let changes = values.windows(2).filter(|w| w[0] != w[1]).count();
    values.len() >= COPY_SAMPLES && changes as f64 >= COPY_MOVES * values.len() as f64
}

/// Delay in samples by which `b` repeats `a`, and where.
fn delayed(a: &[f64], b: &[f64]) -> Option<(isize, Span)> {
    let n = a.len().min(b.len());
    if n < 2 * MOST_DELAY + 4 * COPY_SAMPLES {
        return None;
    }
    // A pattern that moves, out of the middle.
    let middle =
        (n / 2..n - MOST_DELAY - COPY_SAMPLES).step_by(COPY_SAMPLES).find(|&i| moves(&a[i..i + COPY_SAMPLES]))?;
    let pattern = &a[middle..middle + COPY_SAMPLES];
    let place = (middle - MOST_DELAY..=middle + MOST_DELAY)
        .find(|&i| b[i] == pattern[0] && b.get(i..i + COPY_SAMPLES) == Some(pattern))?;
    let delay = place.cast_signed() - middle.cast_signed();
    let at = |i: usize| (i.cast_signed() - delay) as usize;
    let (low, high) = (delay.max(0) as usize, (n.cast_signed() + delay.min(0)) as usize);
    let first = (low..place).rev().find(|&i| b[i] != a[at(i)]).map_or(low, |i| i + 1);
    let end = (place..high).find(|&i| b[i] != a[at(i)]).unwrap_or(high);
    Some((delay, Span { first, end }))
}

/// Factor and offset that make `b` out of `a` to all digits, noise and all. Smooth signals have no noise to share: those
/// of a hand that moves symmetrically are mirror images without being copies.
fn same_noise(a: &[f64], b: &[f64]) -> Option<(f64, f64)> {
    const PIECE: usize = 512;
    let n = a.len().min(b.len());
    let piece = PIECE.min(n);
    if n < COPY_SAMPLES {
        return None;
    }
    // A part first: nearly all pairs end here.
    let first = (n - piece) / 2;
    line(&a[first..first + piece], &b[first..first + piece])?;
    line(&a[..n], &b[..n])
}

fn line(a: &[f64], b: &[f64]) -> Option<(f64, f64)> {
    let n = a.len() as f64;
    let mean = |v: &[f64]| v.iter().sum::<f64>() / n;
    let (mean_a, mean_b) = (mean(a), mean(b));
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    for (x, y) in a.iter().zip(b) {
        let (x, y) = (x - mean_a, y - mean_b);
        (aa, ab, bb) = (aa + x * x, ab + x * y, bb + y * y);
    }
    if aa <= 0.0 || bb <= 0.0 || bb - ab * ab / aa > SAME_NOISE * bb {
        return None;
    }
    let (mut steps, mut bends) = (0.0, 0.0);
    for w in a.windows(3) {
        steps += (w[2] - w[1]).powi(2);
        bends += (w[2] - 2.0 * w[1] + w[0]).powi(2);
    }
    let changes = a.windows(2).filter(|w| w[0] != w[1]).count() as f64;
    // Steps of coarse quanta are rough, and few.
    let rough = bends > ROUGHNESS * ROUGHNESS * steps && changes >= COPY_MOVES * n;
    // The bends must be noise that the line's misfit would show.
    let noise = bends / (6.0 * n);
    let misfit = (bb - ab * ab / aa).max(0.0) / n;
    let factor = ab / aa;
    (rough && misfit < 1e-3 * noise * factor * factor).then_some((factor, mean_b - factor * mean_a))
}

/// Warnings about channels that another trial of the same file repeats: `copies` from the fingerprints.
pub fn copied(recording: &Recording, plan: &Plan, copies: &[Shared]) -> Vec<Warning> {
    let is_mine = |trial: &str| {
        let parts: Vec<&str> = trial.split(" / ").collect();
        recording.trial.as_deref().is_none_or(|t| parts.contains(&t))
            && plan.select.iter().all(|w| w.texts.iter().any(|s| parts.contains(&s.as_str())))
    };
    let mut found = Vec::new();
    for Shared { column, trials: [a, b] } in copies {
        let mine = [(a, b), (b, a)].into_iter().find(|(own, _)| is_mine(&own.0));
        let target = plan.targets.iter().find(|t| t.column == *column);
        let (Some(((_, spans), (other, _))), Some(target)) = (mine, target) else { continue };
        let rows: usize = spans.iter().map(|span| span.end - span.first).sum();
        found.push(Warning {
            kind: "copied-channel".to_owned(),
            column: Some(target.name.clone()),
            spans: spans.iter().copied().filter(|span| span.end <= recording.len()).collect(),
            text: format!(
                "{} is the same as in trial {other} over {rows} samples: one of the two was not measured; do not use it",
                target.name
            ), ..Warning::default() });
    }
    found
}
