//! Channels that stand still, stand at a limit, or move in coarse steps.

use super::findings::{about, is_position, place};
use super::profile::{Profile, extremes, holds};
use crate::units;
use crate::units::Dimension;
use foundation::signal::noise::{white_noise, white_noise_under_fast_motion};
use haptics::recording::{Channel, Recording, Span, Warning};

/// Least number of samples of a plateau at the extreme value (`facts/diagnosis.md`, step 0).
const PLATEAU_SAMPLES: usize = 8;
/// Least ratio of that number to the one at any of the next values: a smooth peak without noise holds 2.4 times as
/// many.
const PLATEAU_EXCESS: f64 = 4.0;
/// The same ratio for noise larger than the steps, which thins a peak out towards its top.
const NOISY_EXCESS: f64 = 1.5;
/// Least excess of that number over the mean of the next values with such noise, in its standard deviations (counts by
/// chance).
const EXCESS_SIGMAS: f64 = 4.5;
/// Noise in steps from which it counts as larger than them.
const NOISY_STEPS: f64 = 1.0;
/// Number of next values that are compared: the last quanta of a noisy peak hold few samples each.
const NEXT_VALUES: usize = 4;
/// A channel that normally changes from sample to sample and then holds for this many samples is stuck.
const STUCK_SAMPLES: usize = 25;
/// Share of unchanged steps above which a channel is taken as coarsely quantised, and holding is normal.
const QUIET_SHARE: f64 = 0.2;
/// Share of a force channel that may stand at its limits; more is a channel that does not work.
const SATURATED_SHARE: f64 = 0.9;
/// The same share of a voltage or current, which may be switched, and of coarse steps, which may be those of dry friction in a
/// slow motion.
const RESTING_SHARE: f64 = 0.5;
/// A channel with fewer steps than this within its usual range is coarsely quantised: its quantum's standard deviation
/// (quantum/√12) is then above 1 % of that range.
const COARSE_LEVELS: f64 = 30.0;
/// Least gain of displacement from one third of a span to the next, as a share of the position's range. Choice: above the noise of a
/// position sensor.
const GAINED_SPEED: f64 = 0.02;
/// Least number of spans without force in which the mechanism gains speed. Choice: one or two are pushes from outside.
const ONE_SIDED_SPANS: usize = 3;
/// Fewer samples do not show a quantum.
const COARSE_SAMPLES: usize = 200;

/// True if a channel holds a value for as long as a stuck one.
pub fn has_holds(values: &[f64]) -> bool {
    !holds(values, STUCK_SAMPLES).is_empty()
}

/// A channel of the program that is constant, or that stops changing for a while other than at its `limit`.
pub fn stuck(recording: &Recording, channel: &Channel, profile: &Profile, limit: Option<&Warning>) -> Option<Warning> {
    let values = &channel.values;
    let first = *values.first()?;
    if values.len() < STUCK_SAMPLES {
        return None;
    }
    if profile.is_constant() {
        let text = format!("{} is {first} in every sample; check that it was connected", channel.name);
        return Some(about("stuck-channel", channel, vec![Span { first: 0, end: values.len() }], text));
    }
    if profile.unchanged + 1 < STUCK_SAMPLES {
        return None;
    }
    let holds = holds(values, STUCK_SAMPLES);
    let held: usize = holds.iter().map(|s| s.end - s.first - 1).sum();
    let moving = values.len() - 1 - held;
    // Besides its holds the channel must change at nearly every sample, and a zero is a tool that touches nothing.
    let quiet = (profile.unchanged - held) as f64 > QUIET_SHARE * moving as f64 || moving < STUCK_SAMPLES * holds.len();
    let at_limit =
        |hold: &Span| limit.is_some_and(|l| l.spans.iter().any(|s| s.first < hold.end && hold.first < s.end));
    let holds: Vec<Span> = holds.into_iter().filter(|s| values[s.first] != 0.0 && !at_limit(s)).collect();
    if quiet || holds.is_empty() || is_position(channel) && !moves_around(values, &holds) {
        return None;
    }
    let longest = holds.iter().map(|s| s.end - s.first).max().unwrap_or(0);
    let text = format!(
        "{} stops changing {} time(s), from {} on, for up to {longest} samples; leave these out",
        channel.name,
        holds.len(),
        place(recording, holds[0].first)
    );
    Some(about("stuck-channel", channel, holds, text))
}

/// True when a position was on its way at the edges of a hold: a thing that came to rest has not got stuck.
fn moves_around(values: &[f64], holds: &[Span]) -> bool {
    let mut steps: Vec<f64> = values.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    let place = steps.len() * 95 / 100;
    let (_, typical, _) = steps.select_nth_unstable_by(place, f64::total_cmp);
    holds.iter().any(|&Span { first, end }| {
        if end < values.len() {
            // It comes back elsewhere, in one leap.
            return (values[end] - values[first]).abs() > 4.0 * *typical;
        }
        // It never comes back, and stopped at full speed.
        first >= 3 && (values[first] - values[first - 3]).abs() > 3.0 * 0.5 * *typical
    })
}

/// Pile-up at exactly the extreme value of a force, torque, voltage or current. Every span is listed: fits leave them out.
pub fn saturated(recording: &Recording, channel: &Channel, profile: &Profile) -> Option<Warning> {
    let sensed = units::find(&channel.unit)
        .is_some_and(|u| matches!(u.dimension, Dimension::Force | Dimension::Torque) || matches!(u.symbol, "V" | "A"));
    if !sensed || channel.values.len() < 2 * PLATEAU_SAMPLES || profile.is_constant() {
        return None;
    }
    let both = [(1.0, profile.high), (-1.0, -profile.low)].map(|side| rail(recording, channel, side));
    let mut spans: Vec<Span> = both.into_iter().flatten().flatten().collect();
    let first = *spans.iter().min_by_key(|s| s.first)?;
    spans.sort_by_key(|s| s.first);
    let samples: usize = spans.iter().map(|s| s.end - s.first).sum();
    // Coarse steps are told of their own.
    let may_rest = matches!(channel.unit.as_str(), "V" | "A") || is_coarse(profile);
    if samples as f64 > if may_rest { RESTING_SHARE } else { SATURATED_SHARE } * channel.values.len() as f64 {
        return None;
    }
    let value = channel.values[first.first].abs();
    let limit = if value > 0.0 {
        format!("its extreme value (±{value:.6} {})", channel.unit)
    } else {
        format!("0 {} while the mechanism gains speed on the side that is never measured", channel.unit)
    };
    let text = format!(
        "{} stands at exactly {limit} in {samples} samples, first at {}: the sensor was at its limit; they are left out of fits",
        channel.name,
        place(recording, first.first)
    );
    Some(about("saturation", channel, spans, text))
}

/// Spans in which `side`·value is exactly `top`, the largest, if they are too many for chance: in this channel on this
/// side, or in all that stop at the very same value.
fn rail(recording: &Recording, channel: &Channel, (side, top): (f64, f64)) -> Option<Vec<Span>> {
    let values = &channel.values;
    let own: [(&[f64], f64); 1] = [(values, side)];
    let at_top = values.iter().filter(|&&v| side * v == top).count();
    // A channel whose extreme is zero has an end, not a rail, unless the mechanism moves as if a force acted.
    if at_top == 0 || top == 0.0 && !measures_one_direction(recording, channel, side) {
        return None;
    }
    if !piles_up(&own) {
        let all = stopping_at(recording, channel, top);
        if all.len() < 2 || !piles_up(&all) {
            return None;
        }
    }
    Some(spans_at(values, side * top))
}

/// Spans of rows with exactly this value.
pub(super) fn spans_at(values: &[f64], value: f64) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for i in (0..values.len()).filter(|&i| values[i] == value) {
        match spans.last_mut().filter(|s| s.end == i) {
            Some(span) => span.end = i + 1,
            None => spans.push(Span { first: i, end: i + 1 }),
        }
    }
    spans
}

/// True if the force on a mechanism is never on one side of zero although the mechanism gains speed towards that side at exactly zero
/// force, and towards the other side it does not. A mechanism that was let go swings to both sides, or slows down.
fn measures_one_direction(recording: &Recording, channel: &Channel, side: f64) -> bool {
    if !matches!(channel.name.as_str(), "f_N" | "tau_Nm") {
        return false;
    }
    let Some(position) = ["q_m", "q_rad"].into_iter().find_map(|name| recording.channel(name)) else { return false };
    let (low, high, _) = extremes(position);
    let (mut towards, mut away, mut all) = (0, 0, 0);
    for Span { first, end } in
        holds(&channel.values, PLATEAU_SAMPLES).into_iter().filter(|s| channel.values[s.first] == 0.0)
    {
        // Displacements in the three thirds of the span: `side` is the side on which no force was measured.
        let at = |third: usize| side * position[first + third * (end - 1 - first) / 3];
        let [a, b, c] = [1, 2, 3].map(|third| at(third) - at(third - 1));
        let gains = |sign: f64| {
            let gained =
                |before: f64, after: f64| sign * after > 0.0 && sign * (after - before) > GAINED_SPEED * (high - low);
            gained(a, b) || gained(b, c)
        };
        all += 1;
        towards += usize::from(gains(1.0));
        away += usize::from(gains(-1.0));
    }
    towards >= ONE_SIDED_SPANS && 2 * towards > all && away * ONE_SIDED_SPANS <= towards
}

/// Sides of the channels in the same unit that reach exactly as far as `top`: sensors of one kind have the same limit to both sides.
fn stopping_at<'a>(recording: &'a Recording, channel: &Channel, top: f64) -> Vec<(&'a [f64], f64)> {
    let same = recording.channels.iter().filter(|c| c.unit == channel.unit);
    let sides = same.flat_map(|c| [1.0, -1.0].map(|side| (c.values.as_slice(), side)));
    sides.filter(|(values, side)| values.iter().map(|v| side * v).fold(f64::NEG_INFINITY, f64::max) == top).collect()
}

/// The largest values on these sides of these channels, from the top, with the number of samples at each.
fn top_levels(sides: &[(&[f64], f64)]) -> [(f64, usize); 1 + NEXT_VALUES] {
    let mut levels = [(f64::NEG_INFINITY, 0); 1 + NEXT_VALUES];
    for (values, side) in sides {
        for value in values.iter().map(|v| side * v) {
            // Few values reach so far.
            if value < levels[NEXT_VALUES].0 {
                continue;
            }
            match levels.iter().position(|(level, _)| value >= *level) {
                Some(at) if levels[at].0 == value => levels[at].1 += 1,
                Some(at) => {
                    levels[at..].rotate_right(1);
                    levels[at] = (value, 1);
                }
                None => {}
            }
        }
    }
    levels
}

/// True if more samples stand at exactly the largest value on these sides than chance puts there.
pub(super) fn piles_up(sides: &[(&[f64], f64)]) -> bool {
    let [(_, at_top), next @ ..] = top_levels(sides);
    if at_top < PLATEAU_SAMPLES {
        return false;
    }
    let counts = next.map(|(_, count)| count as f64);
    let (most, mean) = (counts.into_iter().fold(0.0, f64::max), counts.iter().sum::<f64>() / counts.len() as f64);
    let many = at_top as f64;
    let step = (next[0].0 - next[NEXT_VALUES - 1].0) / (NEXT_VALUES - 1) as f64;
    let is_noisy = || sides.iter().all(|(values, _)| white_noise(values) > NOISY_STEPS * step);
    many >= PLATEAU_EXCESS * most
        || many > NOISY_EXCESS * most && many > mean + EXCESS_SIGMAS * mean.sqrt() && is_noisy()
}

/// True if the quantum of a channel is large against its own usual range.
pub(super) fn is_coarse(profile: &Profile) -> bool {
    quantum(profile).is_some_and(|quantum| quantum * COARSE_LEVELS >= profile.spread())
}

/// Channels whose quantum is large against the usual range of all channels in their unit.
pub fn coarse(recording: &Recording, profiles: &[Profile]) -> Vec<Warning> {
    let channels = || recording.channels.iter().zip(profiles).filter(|(c, _)| units::is_program_name(&c.name));
    channels()
        .filter_map(|(channel, profile)| {
            let quantum = quantum(profile)?;
            let same = channels().filter(|(c, _)| c.unit == channel.unit);
            let range = same.map(|(_, p)| p.spread()).fold(0.0, f64::max);
            if channel.values.len() < COARSE_SAMPLES || quantum * COARSE_LEVELS < range {
                return None;
            }
            // Noise larger than the steps carries the finer detail across them: means of many samples have it.
            if white_noise_under_fast_motion(&channel.values) > NOISY_STEPS * quantum {
                return None;
            }
            let text = format!(
                "{} moves in steps of {quantum:.4e} {}, {:.0} % of its usual range: finer detail was not measured, and derivatives of it are mostly noise",
                channel.name,
                channel.unit,
                100.0 * quantum / profile.spread()
            );
            let all = Span { first: 0, end: channel.values.len() };
            Some(about("quantised", channel, vec![all], text))
        })
        .collect()
}

/// The step that all values are whole multiples of apart, when there are few enough of them to tell.
fn quantum(profile: &Profile) -> Option<f64> {
    const MOST_LEVELS: usize = 512;
    if profile.spread() <= 0.0 {
        return None;
    }
    let mut levels = profile.sorted.clone();
    levels.dedup();
    // A channel of two values is switched, not quantised.
    if levels.len() < 3 || levels.len() > MOST_LEVELS {
        return None;
    }
    let gaps = || levels.windows(2).map(|w| w[1] - w[0]);
    let quantum = gaps().fold(f64::INFINITY, f64::min);
    let even = gaps().all(|gap| (gap / quantum - (gap / quantum).round()).abs() < 0.02);
    even.then_some(quantum)
}
