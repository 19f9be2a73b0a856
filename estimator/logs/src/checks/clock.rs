//! Gaps, dropped samples and jumps of the clock.

use super::findings::{is_position, limited, place};
use foundation::signal::gaps::UsualStep;
use haptics::recording::{Recording, Span, Warning};

/// A step of at least this many periods has lost a sample; a late cycle (measured: up to 1.8) has not.
const DROPPED_PERIODS: f64 = 1.9;
/// Samples on either side of a jump that show how fast a position moves.
const AROUND: usize = 16;

/// Warnings about the time column.
pub fn warnings(recording: &Recording) -> Vec<Warning> {
    let Some(time) = &recording.time_s else { return Vec::new() };
    let Some(usual) = UsualStep::of(time) else { return Vec::new() };
    LongSteps::of(recording, time, usual)
        .texts(recording)
        .into_iter()
        .filter(|(_, _, spans)| !spans.is_empty())
        .map(|(kind, text, spans)| Warning {
            kind: kind.to_owned(),
            column: Some("t_s".to_owned()),
            spans: limited(spans),
            text,
            ..Warning::default()
        })
        .collect()
}

/// Steps of a clock that are longer than usual, by their reason.
#[derive(Default)]
struct LongSteps {
    gaps: Vec<Span>,
    jumps: Vec<Span>,
    dropped: Vec<Span>,
    /// Samples that were dropped.
    lost: f64,
    /// Length of the longest gap, s.
    longest_s: f64,
}

impl LongSteps {
    fn of(recording: &Recording, time: &[f64], usual: UsualStep) -> Self {
        let (median, high, gap_above) = (usual.median_s, usual.high_s, usual.gap_above_s());
        // On an uneven clock only a step far outside its own spread counts.
        let even = high <= 1.3 * median;
        let dropped_above = if even { DROPPED_PERIODS * median } else { f64::INFINITY };
        // The spans of a warning are in order.
        let is_told = |span: &Span| {
            let at = |of: &Warning| {
                of.spans.binary_search_by_key(&span.first, |known| known.first).is_ok_and(|at| of.spans[at] == *span)
            };
            recording.warnings.iter().any(at)
        };
        let mut found = Self::default();
        for (i, pair) in time.windows(2).enumerate() {
            let (step, span) = (pair[1] - pair[0], Span { first: i, end: i + 2 });
            // Rows that a repair left out are told by its warning.
            if step <= dropped_above.min(gap_above) || is_told(&span) {
                continue;
            }
            if step > gap_above && continues(recording, i, median, step) {
                found.jumps.push(span);
            } else if step > gap_above {
                found.longest_s = found.longest_s.max(step);
                found.gaps.push(span);
            } else {
                found.lost += (step / median).round() - 1.0;
                found.dropped.push(span);
            }
        }
        found
    }

    /// Kind, sentence and spans of each reason.
    fn texts(self, recording: &Recording) -> [(&'static str, String, Vec<Span>); 3] {
        let Self { gaps, jumps, dropped, lost, longest_s } = self;
        let first = |spans: &[Span]| spans.first().map_or(String::new(), |s| place(recording, s.first));
        let gap = format!(
            "{} gap(s) in the time, the first after {}, up to {longest_s:.3} s long; split the recording there",
            gaps.len(),
            first(&gaps)
        );
        let jump = format!(
            "the clock jumps {} time(s), first after {}, while the signals go on smoothly; check the time stamps",
            jumps.len(),
            first(&jumps)
        );
        let drop = format!(
            "{lost:.0} sample(s) dropped in {} place(s), first after {}; rates are taken across them",
            dropped.len(),
            first(&dropped)
        );
        [("gap", gap, gaps), ("clock-jump", jump, jumps), ("dropped-samples", drop, dropped)]
    }
}

/// True when positions that move pass from sample `i` to the next as if only one period had gone by: the clock jumped, not
/// the world.
fn continues(recording: &Recording, i: usize, period: f64, step: f64) -> bool {
    let mut moving = 0;
    for channel in recording.channels.iter().filter(|c| is_position(c)) {
        let values = &channel.values;
        if i < AROUND || i + 1 + AROUND >= values.len() {
            continue;
        }
        let (before, after) = (&values[i - AROUND..=i], &values[i + 1..=i + 1 + AROUND]);
        let net = |part: &[f64]| (part[AROUND] - part[0]).abs();
        let total = |part: &[f64]| part.windows(2).map(|w| (w[1] - w[0]).abs()).sum::<f64>();
        let speed = 0.5 * (net(before) + net(after)) / AROUND as f64;
        let jitter = 0.5 * (total(before) + total(after)) / AROUND as f64;
        // Only motion beyond its noise can show whether time went by.
        if speed <= 0.0 || speed * (AROUND as f64) < 4.0 * jitter {
            continue;
        }
        moving += 1;
        let across = (values[i + 1] - values[i]).abs();
        if across > speed + 4.0 * jitter || across > 0.5 * speed * step / period {
            return false;
        }
    }
    moving > 0
}
