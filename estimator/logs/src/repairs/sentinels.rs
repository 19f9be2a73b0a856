//! Rows without a measurement that hold a number in its place: −999, 65535, or 0 where a sensor dropped out.

use crate::checks::{extremes, is_position, limited, place};
use crate::units;
use haptics::recording::{Channel, Recording, Span, Warning};

/// Digits of numbers that stand for no value, whatever the power of ten: nines, the ends of integers of 15 to 32 bits, and the
/// numbers that the standard commands of instruments (SCPI) and simulators write.
const CODES: [f64; 13] = [
    999.0,
    9_999.0,
    99_999.0,
    32_767.0,
    32_768.0,
    65_535.0,
    8_388_607.0,
    16_777_215.0,
    2_147_483_647.0,
    4_294_967_295.0,
    9.9e37,
    9.91e37,
    1e30,
];
/// Least step to and from a number that stands for no value, in multiples of the step quantile. Half of it also occurs in
/// fast motion.
const LEAP: f64 = 10.0;
/// The same for a number in [`HELD_ROWS`] rows or more: a motion that leaps does not also rest there.
const LEAP_TO_HELD: f64 = 3.0;
const HELD_ROWS: usize = 3;
/// Level of the step quantile: one step in a hundred may be a spike or a gap.
const STEP_LEVEL: f64 = 0.99;
/// Largest share of rows that a number may replace. Beyond it, the number is the signal.
const MOST: f64 = 0.5;

/// Leaves the rows out in which a channel of the program holds a number that stands for no value.
pub fn take_out(recording: &mut Recording) -> Vec<Warning> {
    let mut is_out = vec![false; recording.len()];
    let mut found = Vec::new();
    for channel in recording.channels.iter().filter(|c| units::is_program_name(&c.name)) {
        let Some((value, spans)) = sentinel(channel) else { continue };
        let count: usize = spans.iter().map(|span| span.end - span.first).sum();
        for span in &spans {
            is_out[span.first..span.end].fill(true);
        }
        let text = format!(
            "{} is exactly {value} in {count} row(s), the first at {}: no sensor measured that, and these rows are left out",
            channel.name,
            place(recording, spans[0].first)
        );
        let (kind, column, spans) = ("sentinel".to_owned(), Some(channel.name.clone()), limited(spans));
        found.push(Warning { kind, column, spans, text, ..Warning::default() });
    }
    if !found.is_empty() {
        super::leave_out(recording, &is_out, &mut found);
        // Another number may stand for no value beside the first.
        found.extend(take_out(recording));
    }
    found
}

/// A number that stands for no value, with its rows.
fn sentinel(channel: &Channel) -> Option<(f64, Vec<Span>)> {
    let values = &channel.values;
    let (low, high, _) = extremes(values);
    // In a shorter recording, the step quantile is its largest step.
    let is_long = values.len() as f64 * (1.0 - STEP_LEVEL) >= 1.0;
    let zero = (is_long && is_position(channel) && values.contains(&0.0)).then_some(0.0);
    let candidates = [low, high].into_iter().filter(|v| is_code(*v)).chain(zero);
    candidates.into_iter().find_map(|value| {
        let spans = runs(values, value);
        let count: usize = spans.iter().map(|span| span.end - span.first).sum();
        if count as f64 > MOST * values.len() as f64 {
            return None;
        }
        let step = step_quantile(values, value);
        let fits = |span: &Span| {
            let leap = step * if span.end - span.first >= HELD_ROWS { LEAP_TO_HELD } else { LEAP };
            let is_far = |row: Option<usize>| row.and_then(|row| values.get(row)).map(|v| (v - value).abs() > leap);
            let (before, after) = (is_far(span.first.checked_sub(1)), is_far(Some(span.end)));
            // A zero at an end may be the start of a motion.
            before.unwrap_or(value != 0.0) && after.unwrap_or(value != 0.0)
        };
        // A motion may also pass zero; another number is the signal's own where it is not entered by a leap.
        let (far, near): (Vec<Span>, Vec<Span>) = spans.into_iter().partition(fits);
        (!far.is_empty() && (value == 0.0 || near.is_empty())).then_some((value, far))
    })
}

/// True for a code in some unit: SI value over number is a power of ten, or that of degrees.
fn is_code(value: f64) -> bool {
    let size = value.abs();
    let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * b;
    [size, size.to_degrees()].into_iter().any(|size| {
        let same = |code: &f64| {
            let power = (size / code).log10().round();
            power.abs() <= 9.0 && is_near(size / 10_f64.powi(power as i32), *code)
        };
        size > 0.0 && CODES.iter().any(same)
    })
}

/// Runs of rows with exactly this value.
fn runs(values: &[f64], value: f64) -> Vec<Span> {
    let mut spans: Vec<Span> = Vec::new();
    for row in (0..values.len()).filter(|&row| values[row] == value) {
        match spans.last_mut() {
            Some(last) if last.end == row => last.end = row + 1,
            _ => spans.push(Span { first: row, end: row + 1 }),
        }
    }
    spans
}

/// 99 % quantile of the absolute differences of successive values that differ, except those next to the value `without`.
/// Infinite if no other differ.
fn step_quantile(values: &[f64], without: f64) -> f64 {
    let pairs = values.windows(2).filter(|w| w[0] != without && w[1] != without && w[0] != w[1]);
    let mut steps: Vec<f64> = pairs.map(|w| (w[1] - w[0]).abs()).collect();
    let at = (STEP_LEVEL * steps.len() as f64) as usize;
    if at >= steps.len() { f64::INFINITY } else { *steps.select_nth_unstable_by(at, f64::total_cmp).1 }
}
