//! Leaps of a position: rows were lost there, or its zero was set.

use super::findings::{about, is_position, place};
use foundation::signal::gaps::gaps;
use haptics::recording::{Recording, Span, Warning};
use serde_json::json;

/// Least leap, in multiples of the largest other step within [`AROUND`] samples. Half of it also occurs where something snaps.
const LEAP: f64 = 10.0;
/// Samples on each side that show the usual step.
const AROUND: usize = 20;
/// Level of the quantile of all steps that a leap exceeds by the same factor.
const LEVEL: f64 = 0.99;
/// More leaps than this are the motion.
const MOST: usize = 3;

/// Doubts about leaps of positions, with the windows of time between them.
pub fn warnings(recording: &Recording) -> Vec<Warning> {
    let Some(time_s) = recording.time_s.as_deref().filter(|time| time.len() > 2 * AROUND) else { return Vec::new() };
    let known = gaps(time_s);
    let of_channel = |channel: &haptics::recording::Channel| {
        let leaps: Vec<usize> = leaps(&channel.values).into_iter().filter(|i| !known.contains(i)).collect();
        let first = *leaps.first().filter(|_| leaps.len() <= MOST)?;
        let text = format!(
            "{} leaps {} time(s), first by {:.4} {} after {}, while it moves smoothly before and behind: rows were lost there, or its \
             zero was set; read the parts on their own, with \"windows\" in the sidecar",
            channel.name,
            leaps.len(),
            channel.values[first + 1] - channel.values[first],
            channel.unit,
            place(recording, first)
        );
        let starts = std::iter::once(time_s[0]).chain(leaps.iter().map(|i| time_s[i + 1]));
        let ends = leaps.iter().map(|i| time_s[*i]).chain(time_s.last().copied());
        let windows: Vec<_> =
            starts.zip(ends).map(|(from_s, to_s)| json!({ "from_s": from_s, "to_s": to_s })).collect();
        let spans = leaps.iter().map(|&i| Span { first: i, end: i + 2 }).collect();
        let suggested = json!({ "windows": windows }).as_object().cloned();
        Some(Warning { suggested, ..about("leap", channel, spans, text) })
    };
    recording.channels.iter().filter(|channel| is_position(channel)).filter_map(of_channel).collect()
}

/// Samples after which a position leaps and stays.
fn leaps(values: &[f64]) -> Vec<usize> {
    let step = |i: usize| (values[i + 1] - values[i]).abs();
    let mut sorted: Vec<f64> = (0..values.len() - 1).map(step).collect();
    let at = (LEVEL * sorted.len() as f64) as usize;
    let high = *sorted.select_nth_unstable_by(at.min(values.len() - 2), f64::total_cmp).1;
    let stands_out = |i: &usize| {
        let others = || (i - AROUND..i + AROUND).filter(|k| k != i).map(step);
        high > 0.0 && step(*i) > LEAP * high && others().all(|other| step(*i) > LEAP * other)
    };
    (AROUND..values.len().saturating_sub(AROUND + 1)).filter(stands_out).collect()
}
