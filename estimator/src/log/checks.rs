//! What looks wrong in a recording that can be read all the same: gaps, stuck and copied channels, plateaus, jumps.
//!
//! The thresholds are set so that what real encoders and sensors do (dwelling at a stop, coarse quanta, one late cycle) is
//! not reported.

use super::plan::Plan;
use super::units::{self, Dimension};
use haptics::recording::{Channel, Recording, Span, Warning};

/// A step of more than this many periods is a gap, below it a few samples were dropped.
const GAP_PERIODS: f64 = 10.0;
/// A step of at least this many periods has lost a sample; a late cycle (measured: up to 1.8) has not.
const DROPPED_PERIODS: f64 = 1.9;
/// Plateau at the extreme value: at least this many samples (`facts/diagnosis.md`, step 0).
const PLATEAU_SAMPLES: usize = 8;
/// … and this many times as many as at the next value, where quanta are coarse.
const PLATEAU_EXCESS: usize = 4;
/// A channel that normally changes from sample to sample and then holds for this many samples is stuck.
const STUCK_SAMPLES: usize = 25;
/// Share of unchanged steps above which a channel is taken as coarsely quantised, and holding is normal.
const QUIET_SHARE: f64 = 0.2;
/// A value this many times the spread of the others away from them is no measurement …
const OUTLIER_SPREADS: f64 = 1e6;
/// … nor is one of this size in m, rad, N, or their rates.
const IMPOSSIBLE: f64 = 1e9;
/// Share of a force channel that may stand at its limit; more is a channel that does not work.
const SATURATED_SHARE: f64 = 0.9;
/// … and of a voltage or current, which may be switched.
const SWITCHED_SHARE: f64 = 0.5;
/// No more spans than this are listed.
const MAX_SPANS: usize = 50;

/// All warnings about the samples of one recording.
pub fn warnings(recording: &Recording) -> Vec<Warning> {
    let mut found = Vec::new();
    if let Some(time) = &recording.time_s {
        found.extend(clock(time, recording));
    }
    for channel in &recording.channels {
        let known = units::is_program_name(&channel.name);
        let limit = saturated(channel);
        found.extend(if known { outliers(channel) } else { None });
        found.extend(if known { stuck(channel, limit.as_ref()) } else { None });
        found.extend(limit);
    }
    found
}

/// Values that no hand and no mechanism reach, in SI units, or too far beyond the channel's own spread.
fn outliers(channel: &Channel) -> Option<Warning> {
    let mut sorted = channel.values.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let n = sorted.len();
    let middle = *sorted.get(n / 2)?;
    // Nine tenths of the samples: a force that is zero most of the time still has a spread.
    let spread = sorted[n - 1 - n / 20] - sorted[n / 20];
    let reach = if spread > 0.0 { (OUTLIER_SPREADS * spread).min(IMPOSSIBLE) } else { IMPOSSIBLE };
    let beyond = |v: f64| (v - middle).abs() > reach || v.abs() > IMPOSSIBLE;
    let places: Vec<usize> = (0..n).filter(|&i| beyond(channel.values[i])).collect();
    let &first = places.first()?;
    let spans = places.iter().map(|&i| Span { first: i, end: i + 1 }).collect();
    Some(Warning {
        kind: "outlier".to_owned(),
        column: Some(channel.name.clone()),
        spans: limited(spans),
        text: format!(
            "{} is {:e} in row {} and {} in all lie(s) impossibly far from the rest: every result that uses it is spoilt; correct or remove the row(s)",
            channel.name,
            channel.values[first],
            first + 1,
            places.len()
        ),
    })
}

/// Warnings about channels that another trial of the same file repeats: `copies` from the fingerprints.
pub fn copied(recording: &Recording, plan: &Plan, copies: &[(usize, String, String, usize)]) -> Vec<Warning> {
    let selected: Vec<&str> = plan.select.iter().map(|w| w.text.as_str()).collect();
    let mine = |trial: &str| {
        let parts: Vec<&str> = trial.split(" / ").collect();
        recording.trial.as_deref().is_none_or(|t| parts.contains(&t)) && selected.iter().all(|s| parts.contains(s))
    };
    let mut found = Vec::new();
    for (watched, a, b, rows) in copies {
        let Some(other) = [(a, b), (b, a)].into_iter().find(|(own, _)| mine(own)).map(|(_, other)| other) else {
            continue;
        };
        let column = plan.watched[*watched];
        let Some(target) = plan.targets.iter().find(|t| t.column == column) else { continue };
        found.push(Warning {
            kind: "copied-channel".to_owned(),
            column: Some(target.name.clone()),
            spans: vec![Span { first: 0, end: (*rows).min(recording.len()) }],
            text: format!(
                "{} is the same as in trial {other} over {rows} samples: one of the two was not measured; do not use it",
                target.name
            ),
        });
    }
    found
}

fn limited(mut spans: Vec<Span>) -> Vec<Span> {
    spans.truncate(MAX_SPANS);
    spans
}

/// Gaps, dropped samples and jumps of the clock.
fn clock(time: &[f64], recording: &Recording) -> Vec<Warning> {
    let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).collect();
    if steps.len() < 8 {
        return Vec::new();
    }
    let ordered = {
        let mut sorted = steps.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        sorted
    };
    let (median, high) = (ordered[ordered.len() / 2], ordered[ordered.len() * 95 / 100]);
    // On an uneven clock only what is far outside its own spread counts.
    let even = high <= 1.3 * median;
    let dropped_above = if even { DROPPED_PERIODS * median } else { f64::INFINITY };
    let gap_above = (GAP_PERIODS * median).max(5.0 * high);
    let (mut gaps, mut jumps, mut dropped, mut lost) = (Vec::new(), Vec::new(), Vec::new(), 0.0);
    for (i, step) in steps.drain(..).enumerate() {
        let span = Span { first: i, end: i + 2 };
        if step > gap_above && continues(recording, i, median, step) {
            jumps.push(span);
        } else if step > gap_above {
            gaps.push(span);
        } else if step > dropped_above {
            lost += (step / median).round() - 1.0;
            dropped.push(span);
        }
    }
    let at = |spans: &[Span]| spans.first().map_or(0.0, |s| time[s.first]);
    let longest = ordered.last().copied().unwrap_or(0.0);
    let warning = |kind: &str, spans: Vec<Span>, text: String| {
        (!spans.is_empty()).then(|| Warning {
            kind: kind.to_owned(),
            column: Some("t_s".to_owned()),
            spans: limited(spans),
            text,
        })
    };
    let texts = [
        format!(
            "{} gap(s) in the time, the first after {:.3} s, up to {longest:.3} s long; split the recording there",
            gaps.len(),
            at(&gaps)
        ),
        format!(
            "the clock jumps {} time(s), first after {:.3} s, while the signals go on smoothly; check the time stamps",
            jumps.len(),
            at(&jumps)
        ),
        format!(
            "{lost:.0} sample(s) dropped in {} place(s), first after {:.3} s; rates are taken across them",
            dropped.len(),
            at(&dropped)
        ),
    ];
    let [gap, jump, drop] = texts;
    [warning("gap", gaps, gap), warning("clock-jump", jumps, jump), warning("dropped-samples", dropped, drop)]
        .into_iter()
        .flatten()
        .collect()
}

/// True when positions that move pass from sample `i` to the next as if only one period had gone by: the clock jumped, not
/// the world.
fn continues(recording: &Recording, i: usize, period: f64, step: f64) -> bool {
    let mut moving = 0;
    for channel in recording.channels.iter().filter(|c| is_position(c)) {
        let values = &channel.values;
        if i == 0 || i + 2 >= values.len() {
            continue;
        }
        let around = 0.5 * ((values[i] - values[i - 1]).abs() + (values[i + 2] - values[i + 1]).abs());
        let across = (values[i + 1] - values[i]).abs();
        if around <= 0.0 {
            continue;
        }
        moving += 1;
        // Smoothly: within a factor of three of one step, and far from what the stated time would need.
        if across > 3.0 * around || across > 0.3 * around * step / period {
            return false;
        }
    }
    moving > 0
}

fn is_position(channel: &Channel) -> bool {
    units::is_program_name(&channel.name) && matches!(channel.unit.as_str(), "m" | "rad")
}

/// A channel of the program that is constant, or that stops changing for a while other than at its `limit`.
fn stuck(channel: &Channel, limit: Option<&Warning>) -> Option<Warning> {
    let values = &channel.values;
    let first = *values.first()?;
    if values.len() < STUCK_SAMPLES {
        return None;
    }
    let warning = |spans: Vec<Span>, text: String| {
        Some(Warning {
            kind: "stuck-channel".to_owned(),
            column: Some(channel.name.clone()),
            spans: limited(spans),
            text,
        })
    };
    if values.iter().all(|&v| v == first) {
        let text = format!("{} is {first} in every sample; check that it was connected", channel.name);
        return warning(vec![Span { first: 0, end: values.len() }], text);
    }
    let unchanged = values.windows(2).filter(|w| w[0] == w[1]).count();
    let holds: Vec<Span> = runs(values).into_iter().filter(|s| s.end - s.first >= STUCK_SAMPLES).collect();
    let held: usize = holds.iter().map(|s| s.end - s.first - 1).sum();
    let moving = values.len() - 1 - held;
    // Besides its holds the channel must change at nearly every sample, and a zero is a tool that touches nothing.
    let quiet = (unchanged - held) as f64 > QUIET_SHARE * moving as f64 || moving < STUCK_SAMPLES;
    let at_limit =
        |hold: &Span| limit.is_some_and(|l| l.spans.iter().any(|s| s.first < hold.end && hold.first < s.end));
    let holds: Vec<Span> = holds.into_iter().filter(|s| values[s.first] != 0.0 && !at_limit(s)).collect();
    if quiet || holds.is_empty() || is_position(channel) && !moves_around(values, &holds) {
        return None;
    }
    let longest = holds.iter().map(|s| s.end - s.first).max().unwrap_or(0);
    let text = format!(
        "{} stops changing {} time(s), from sample {} on, for up to {longest} samples; leave these out",
        channel.name,
        holds.len(),
        holds[0].first
    );
    warning(holds, text)
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

/// Maximal runs of equal values.
fn runs(values: &[f64]) -> Vec<Span> {
    let mut found = Vec::new();
    let mut first = 0;
    for i in 1..=values.len() {
        if i == values.len() || values[i] != values[first] {
            found.push(Span { first, end: i });
            first = i;
        }
    }
    found
}

/// Pile-up at exactly the extreme value of a force, torque, voltage or current.
fn saturated(channel: &Channel) -> Option<Warning> {
    let sensed = units::find(&channel.unit)
        .is_some_and(|u| matches!(u.dimension, Dimension::Force | Dimension::Torque) || matches!(u.symbol, "V" | "A"));
    if !sensed || channel.values.len() < 2 * PLATEAU_SAMPLES {
        return None;
    }
    let share = if matches!(channel.unit.as_str(), "V" | "A") { SWITCHED_SHARE } else { SATURATED_SHARE };
    let both = [1.0, -1.0].map(|side| rail(&channel.values, side, share));
    let mut spans: Vec<Span> = both.iter().flatten().flatten().copied().collect();
    if spans.is_empty() {
        return None;
    }
    spans.sort_by_key(|s| s.first);
    let samples: usize = spans.iter().map(|s| s.end - s.first).sum();
    let level = spans.first().map_or(0.0, |s| channel.values[s.first].abs());
    Some(Warning {
        kind: "saturation".to_owned(),
        column: Some(channel.name.clone()),
        text: format!(
            "{} stands at exactly its extreme value (±{level:.6} {}) in {samples} samples: the sensor was at its limit; they are left out of fits",
            channel.name, channel.unit
        ),
        spans: limited(spans),
    })
}

/// Spans where `side`·value is exactly the largest, when they are too many for chance.
fn rail(values: &[f64], side: f64, share: f64) -> Option<Vec<Span>> {
    let top = values.iter().map(|v| side * v).fold(f64::NEG_INFINITY, f64::max);
    let next = values.iter().map(|v| side * v).filter(|&v| v < top).fold(f64::NEG_INFINITY, f64::max);
    let count = |level: f64| values.iter().filter(|&&v| side * v == level).count();
    // A channel whose extreme is zero has an end, not a rail; one that is constant is stuck.
    if top == 0.0 || !next.is_finite() || count(top) < PLATEAU_SAMPLES.max(PLATEAU_EXCESS * count(next)) {
        return None;
    }
    let spans: Vec<Span> = runs(values).into_iter().filter(|s| side * values[s.first] == top).collect();
    // Most of the record at one value is a stuck or switched channel.
    let held: usize = spans.iter().map(|s| s.end - s.first).sum();
    (held as f64 <= share * values.len() as f64).then_some(spans)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn channel(name: &str, values: Vec<f64>) -> Channel {
        let unit = units::split(name).map_or(String::new(), |(_, u)| u.si.to_owned());
        Channel { name: name.to_owned(), unit, values }
    }

    fn wave(n: usize) -> Vec<f64> {
        (0..n).map(|i| (i as f64 * 0.05).sin() + 1e-3 * (i as f64 * 17.3).sin()).collect()
    }

    fn recording(time_s: Vec<f64>, channels: Vec<Channel>) -> Recording {
        Recording { time_s: Some(time_s), channels, ..Recording::default() }
    }

    fn kinds(warnings: &[Warning]) -> Vec<&str> {
        warnings.iter().map(|w| w.kind.as_str()).collect()
    }

    #[test]
    fn a_clean_recording_has_no_warnings() {
        let time = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        assert!(warnings(&recording(time, vec![channel("q_m", wave(1000)), channel("f_N", wave(1000))])).is_empty());
    }

    #[test]
    fn gaps_dropped_samples_and_jumps_are_told_apart() {
        let mut time: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.01).collect();
        time[100..].iter_mut().for_each(|t| *t += 0.02);
        let q = |time: &[f64]| channel("q_m", time.iter().map(|t| (3.0 * t).sin()).collect());
        let dropped = warnings(&recording(time.clone(), vec![q(&time)]));
        assert_eq!(kinds(&dropped), ["dropped-samples"]);
        assert_eq!(dropped[0].spans, [Span { first: 99, end: 101 }]);
        assert!(dropped[0].text.starts_with("2 sample(s)"));

        time[200..].iter_mut().for_each(|t| *t += 0.5);
        assert_eq!(kinds(&warnings(&recording(time.clone(), vec![q(&time)]))), ["gap", "dropped-samples"]);

        let mut late: Vec<f64> = (0..400).map(|i| f64::from(i) * 0.01).collect();
        let smooth = q(&late);
        late[200..].iter_mut().for_each(|t| *t += 5.0);
        assert_eq!(kinds(&warnings(&recording(late, vec![smooth]))), ["clock-jump"]);
    }

    #[test]
    fn stuck_channels_are_found_and_rest_is_not_one() {
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        let mut force = wave(1000);
        let held = force[300];
        force[300..420].fill(held);
        let found = warnings(&recording(time.clone(), vec![channel("f_N", force)]));
        assert_eq!((kinds(&found), found[0].spans[0]), (vec!["stuck-channel"], Span { first: 300, end: 420 }));
        assert_eq!(
            kinds(&warnings(&recording(time.clone(), vec![channel("fx_N", vec![0.7; 1000])]))),
            ["stuck-channel"]
        );
        // A slide that comes to rest, stays, and leaves slowly again.
        let rest: Vec<f64> = (0..1000)
            .map(|i: i32| f64::from((i - 300).min(0) + (i - 700).max(0)) * 1e-4 + f64::from(i % 2) * 0.0)
            .collect();
        assert!(warnings(&recording(time, vec![channel("q_m", rest)])).is_empty());
    }

    #[test]
    fn an_impossible_value_is_named_with_its_row() {
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        let mut force = wave(1000);
        force[50] = 1e300;
        let found = warnings(&recording(time.clone(), vec![channel("fx1_N", force)]));
        assert_eq!(kinds(&found), ["outlier"]);
        assert!(found[0].text.contains("fx1_N is 1e300 in row 51"), "{}", found[0].text);
        // Mostly zero, then a blow: that is what contact looks like.
        let blow: Vec<f64> = (0..1000).map(|i| if i > 980 { 30.0 + f64::from(i % 7) } else { 0.0 }).collect();
        assert!(!kinds(&warnings(&recording(time, vec![channel("fx1_N", blow)]))).contains(&"outlier"));
    }

    #[test]
    fn long_clipping_is_a_limit_and_not_a_stuck_channel() {
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        // A grip force that is beyond the sensor for six tenths of the recording.
        let grip: Vec<f64> = (0..1000)
            .map(|i: i32| (0.8 - (f64::from(i - 500) / 350.0).powi(2) + 1e-3 * (f64::from(i) * 17.3).sin()).min(0.1))
            .collect();
        let found = warnings(&recording(time, vec![channel("fx1_N", grip)]));
        assert_eq!(kinds(&found), ["saturation"]);
    }

    #[test]
    fn a_clipped_force_is_saturated_and_a_quantised_one_is_not() {
        let time: Vec<f64> = (0..1000).map(|i| f64::from(i) * 1e-3).collect();
        let clipped: Vec<f64> = wave(1000).into_iter().map(|v| v.clamp(-0.9, 0.9)).collect();
        let found = warnings(&recording(time.clone(), vec![channel("f_N", clipped)]));
        assert!(kinds(&found).contains(&"saturation"), "{found:?}");
        let coarse: Vec<f64> = wave(1000).into_iter().map(|v| (v * 20.0).round() / 20.0).collect();
        assert!(warnings(&recording(time, vec![channel("f_N", coarse)])).is_empty());
    }
}
