//! The times of a recording's rows: counters that ran over, epochs, and columns that have clocks of their own.

use super::csv::calendar;
use super::errors::LogError;
use super::mcap::resample;
use super::origin::{EPOCHS, Origin};
use super::plan::{Plan, Use};
use super::raw::{Cells, is_missing};
use super::row_order;
use super::table::Group;
use foundation::words::CLOCK_UNITS;
use haptics::recording::{Labels, Meta, Warning};
use serde_json::json;
use std::path::Path;

/// Times from which a number of seconds is none: three thousand years.
const NO_SECONDS: f64 = 1e11;
/// Ranges of stamps in ticks of 100 ns, 2000 to 2100, with the epochs that they count from: of Windows since 1601, of .NET since
/// the year 1.
const TICKS: [(&str, std::ops::Range<f64>); 2] = [("1601", 1.25e17..1.58e17), ("year 1", 6.3e17..6.63e17)];
/// With more rows a second than these, one of them lies in the second half of some second.
const ROWS_A_SECOND: usize = 4;
/// Length of a tick, s.
const TICK_S: f64 = 1e-7;
/// Ranges of days that stamps count, 1954 to 2119, with the epochs that they count from: of spreadsheets, and of MATLAB.
const DAYS: [(&str, std::ops::Range<f64>); 2] = [("1900", 2e4..8e4), ("year 0", 7.1e5..7.8e5)];
/// Rates at which motion is measured, Hz.
const RATES_HZ: std::ops::Range<f64> = 5.0..50_000.0;
/// Rate below which a clock is doubted even if its stamps are no whole numbers, Hz. Choice: a hundredth of the slowest motion; creep and
/// drift are recorded at 0.1 to 1 Hz.
const SLOWEST_HZ: f64 = 0.05;
/// Fewer stamps show no clock: they may count poses.
const FEWEST_STAMPS: usize = 50;
/// Length of a day, s.
pub const DAY_S: f64 = calendar::DAY_S as f64;
/// Numbers at which counters of 16, 31 and 32 bits run over.
const COUNTERS: [f64; 3] = [65_536.0, 2_147_483_648.0, 4_294_967_296.0];
/// A step over the end of a counter is that of its neighbours to this share.
const LIKE_OTHERS: f64 = 0.5;

/// Times of a group's rows.
#[derive(Default)]
pub struct Times {
    /// The times, s; none without a clock.
    pub time_s: Option<Vec<f64>>,
    /// Sentences about them.
    pub said: Vec<String>,
    /// Place of their zero, if the file states it.
    pub origin: Option<Origin>,
}

/// Times of a group's rows; made from `rate_hz` where there is no column.
pub fn times(group: &mut Group, plan: &Plan, meta: &Meta, headers: &[String], path: &Path) -> Result<Times, LogError> {
    let Some(column) = plan.time else {
        let rows = group.rows();
        let time_s = meta.rate_hz.map(|rate| (0..rows).map(|i| i as f64 / rate).collect());
        return Ok(Times { time_s, ..Times::default() });
    };
    let mut time = std::mem::take(&mut group.columns[column]);
    let mut said = Vec::new();
    let mut stamped = None;
    if let Some((fraction, unit_s)) = plan.fraction
        && let Some(first) = add_fraction(&mut time, &group.columns[fraction], unit_s)
    {
        let (whole, fraction) = (&headers[column], &headers[fraction]);
        said.push(format!("the time is the sum of the columns `{whole}` and `{fraction}`"));
        stamped = (first != 0.0).then_some(Origin { ns: (1e9 * first) as i64, is_dated: true });
    }
    let (factor, passed) = match plan.uses[column] {
        Use::Number { factor, .. } => (factor, unwrapped(&mut time, &COUNTERS.map(|count| count * factor))),
        Use::Stamp { form, .. } if !form.is_dated => (1.0, on_the_next_day(&mut time)),
        _ => (1.0, None),
    };
    said.extend(passed.map(|what| format!("the column `{}` {what}", headers[column])));
    let origin = stamped.or_else(|| origin(&time, plan.uses[column])).or(plan.origin);
    let (is_assumed, is_dated) = (plan.is_unit_assumed, time.first().is_some_and(|first| EPOCHS.contains(first)));
    let epoch = without_epoch(&mut time, factor);
    if epoch.is_none() && is_assumed && !is_dated && matches!(plan.uses[column], Use::Number { .. }) {
        said.push(format!("the column `{}` states no unit: its times are taken as seconds", headers[column]));
    }
    said.extend(epoch.map(|what| format!("the column `{}` {what}", headers[column])));
    if let Some(i) = time.windows(2).position(|w| w[1] <= w[0]) {
        let (row, line) = group.place(i + 1);
        let goes_back = time[i + 1] < time[i];
        return Err(LogError::Time {
            row,
            line,
            column: headers[column].clone(),
            goes_back,
            previous: time[i],
            time: time[i + 1],
            rate_hz: mean_rate(&time),
            advice: advice(&time, (goes_back, line == 0), meta.rate_hz).into(),
            path: path.to_path_buf(),
        });
    }
    Ok(Times { time_s: Some(time), said, origin })
}

/// Adds the fraction of a second to whole seconds. Returns the second from which the times then count: one since 1970, or 0;
/// none for columns that are no such pair.
fn add_fraction(time: &mut [f64], fraction: &[f64], unit_s: f64) -> Option<f64> {
    let is_fraction = fraction.len() == time.len() && fraction.iter().all(|part| (0.0..1.0).contains(&(part * unit_s)));
    if !is_fraction || time.iter().any(|t| t.fract() != 0.0) {
        return None;
    }
    // A fraction passes through all of the second; counts of samples or of another unit end early.
    let seconds = time.windows(2).filter(|w| w[1] != w[0]).count();
    let largest = fraction.iter().fold(0.0, |largest: f64, part| largest.max(part * unit_s));
    if seconds > 1 && time.len() > ROWS_A_SECOND * seconds && largest < 0.5 {
        return None;
    }
    let first = time.first().copied().filter(|first| EPOCHS.contains(first)).unwrap_or(0.0);
    for (t, part) in time.iter_mut().zip(fraction) {
        *t = *t - first + part * unit_s;
    }
    Some(first)
}

/// Zero of a clock, as its column states it: of numbers, the start of 1970 if they can be seconds since then.
fn origin(time: &[f64], clock: Use) -> Option<Origin> {
    let first = *time.first()?;
    match clock {
        Use::Stamp { origin_ns, form } => Some(Origin { ns: origin_ns, is_dated: form.is_dated }),
        Use::Number { factor, .. } => match stamp_unit(first, factor) {
            Some((_, unit)) => Some(Origin { ns: (first * (unit * 1e9)) as i64, is_dated: true }),
            None => EPOCHS.contains(&first).then_some(Origin { ns: 0, is_dated: true }),
        },
        Use::Ignore => None,
    }
}

/// Name and length, s, of the unit of stamps since 1970 that can be no seconds.
fn stamp_unit(first: f64, factor: f64) -> Option<(&'static str, f64)> {
    let is_large = first.abs() >= NO_SECONDS && factor == 1.0 && !is_tick(first);
    CLOCK_UNITS.into_iter().find(|(_, unit)| is_large && EPOCHS.contains(&(first * unit)))
}

/// True for a stamp in ticks of 100 ns, which the reader converts.
pub fn is_tick(stamp: f64) -> bool {
    TICKS.iter().any(|(_, range)| range.contains(&stamp))
}

/// Spans after which a clock starts again and time goes on, in its own numbers times their factor.
pub fn cycles(clock: Use) -> Vec<f64> {
    match clock {
        Use::Number { factor, .. } => COUNTERS.map(|count| count * factor).to_vec(),
        _ => vec![DAY_S],
    }
}

/// The cycle by which a step back is an `usual` one.
pub fn cycle_of(step: f64, usual: f64, cycles: &[f64]) -> Option<f64> {
    cycles.iter().copied().find(|cycle| (step + cycle - usual).abs() <= LIKE_OTHERS * usual)
}

/// Median of the steps forward; none when there is none.
pub fn usual_step(time: &[f64]) -> Option<f64> {
    let mut steps: Vec<f64> = time.windows(2).map(|w| w[1] - w[0]).filter(|step| *step > 0.0).collect();
    let middle = steps.len() / 2;
    (!steps.is_empty()).then(|| *steps.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Rows a second of times that stand still at times and never go back: those between the first change and the last one.
fn mean_rate(time: &[f64]) -> Option<f64> {
    let changes = |row: &usize| time[*row] != time[*row - 1];
    let (first, last) = ((1..time.len()).find(changes)?, (1..time.len()).rfind(changes)?);
    let (from, to) = if first < last { (first, last) } else { (0, time.len() - 1) };
    let rate = (to - from) as f64 / (time[to] - time[from]);
    (rate > 0.0 && time.windows(2).all(|w| w[1] >= w[0])).then_some(rate)
}

/// A way out for times that do not increase.
fn advice(time: &[f64], (goes_back, in_container): (bool, bool), rate_hz: Option<f64>) -> String {
    let repeats = time.windows(2).filter(|w| w[1] == w[0]).count();
    let no_clock = "\"columns\": {\"t_s\": null}";
    match rate_hz {
        Some(rate) => {
            format!("if this column is no clock, state {no_clock} in the sidecar, and rate_hz ({rate}) holds")
        }
        None if 4 * repeats > time.len() => {
            format!("the stamps are too coarse for a clock: state {no_clock} and the rate, \"rate_hz\", in the sidecar")
        }
        // Nobody removes a row of an MCAP or Parquet file.
        None if in_container => {
            format!("map another clock to `t_s`, or state {no_clock} and \"rate_hz\" in the sidecar")
        }
        None if goes_back && let Some(how) = row_order::fault(time) => {
            format!("{how}, and no recording starts again: sort the rows by this column")
        }
        None if goes_back => {
            "if several recordings stand one after the other, tell them apart with a `trial` column".to_owned()
        }
        None => format!("remove the repeated row, or state {no_clock} and \"rate_hz\" in the sidecar"),
    }
}

/// Adds a cycle wherever a counter ran over.
fn unwrapped(time: &mut [f64], cycles: &[f64]) -> Option<String> {
    let falls = time.windows(2).any(|w| w[1] < w[0]);
    let usual = falls.then(|| usual_step(time)).flatten()?;
    let (mut added, mut times, mut first) = (0.0, 0, 0);
    for i in 1..time.len() {
        let step = time[i] + added - time[i - 1];
        if step < 0.0 {
            let Some(cycle) = cycle_of(step, usual, cycles) else { continue };
            (added, times, first) = (added + cycle, times + 1, if first == 0 { i } else { first });
        }
        time[i] += added;
    }
    (times > 0).then(|| format!("runs over {times} time(s), first in row {}: its times go on from there", first + 1))
}

/// Adds a day wherever a time of the day falls back by more than half a day.
fn on_the_next_day(time: &mut [f64]) -> Option<String> {
    let (mut days, mut first, mut last) = (0.0, None, f64::NEG_INFINITY);
    for (row, t) in time.iter_mut().enumerate() {
        if last - *t > 0.5 * DAY_S {
            days += 1.0;
            first = first.or(Some(row + 1));
        }
        last = *t;
        *t += days * DAY_S;
    }
    first.map(|row| format!("passes midnight {days} time(s), first in row {row}: its times go on on the next day"))
}

/// Turns stamps since an epoch that can be no seconds into seconds since the first row.
fn without_epoch(time: &mut [f64], factor: f64) -> Option<String> {
    let first = *time.first()?;
    let of = |epochs: [(&'static str, std::ops::Range<f64>); 2]| {
        epochs.into_iter().find(|(_, range)| factor == 1.0 && range.contains(&first)).map(|(epoch, _)| epoch)
    };
    let is_motion = |unit: f64| usual_step(time).is_some_and(|step| RATES_HZ.contains(&(unit * step).recip()));
    let (name, unit, epoch) = match (of(TICKS), of(DAYS)) {
        (Some(epoch), _) => ("ticks of 100 ns", TICK_S, epoch),
        // Seconds since the start of a machine have such values, too, and other steps.
        (_, Some(epoch)) if is_motion(DAY_S) && !is_motion(1.0) => ("days", DAY_S, epoch),
        _ => stamp_unit(first, factor).map(|(name, unit)| (name, unit, "1970"))?,
    };
    for t in time.iter_mut() {
        *t = (*t - first) * unit;
    }
    Some(format!("counts {name} since {epoch}, not seconds: its times are seconds since the first row"))
}

/// Doubt about the unit of a clock that is too fast for a measurement of motion, or too slow: far too slow unless its stamps are whole
/// numbers.
/// `stated_s`: seconds of the unit that the file states, 1 without one; `undone`: the scale in a sidecar that makes seconds of it.
pub fn unit_doubt(time: &[f64], (stated_s, undone): (f64, f64)) -> Option<Warning> {
    let is_whole = time.iter().all(|t| t.fract() == 0.0);
    let is_far_too_slow = time.first().zip(time.last()).is_some_and(|(a, b)| SLOWEST_HZ * (b - a) > time.len() as f64);
    let may_be_slow = is_whole || is_far_too_slow;
    // The usual step of a long recording takes a while: it is needed for few of them.
    if time.len() < FEWEST_STAMPS || stated_s >= 1.0 && !may_be_slow {
        return None;
    }
    let rate_hz = usual_step(time)?.recip();
    let (kind, column) = (super::checks::UNIT.to_owned(), Some("t_s".to_owned()));
    if stated_s < 1.0 && rate_hz > RATES_HZ.end && RATES_HZ.contains(&(rate_hz * stated_s)) {
        let text = format!(
            "the times run at {} Hz in the unit that the file states, too fast for a motion; as seconds they run at {} Hz: if \
             they are, state \"scale\": {{\"t_s\": {}}} in the sidecar",
            shown(rate_hz),
            shown(rate_hz * stated_s),
            undone
        );
        let suggested = json!({ "scale": { "t_s": undone } }).as_object().cloned();
        return Some(Warning { kind, column, text, suggested, ..Warning::default() });
    }
    if !may_be_slow {
        return None;
    }
    let (name, unit) = CLOCK_UNITS.into_iter().find(|(_, unit)| RATES_HZ.contains(&(rate_hz / unit)))?;
    let text = format!(
        "the times {}run at {} Hz; as {name} they run at {} Hz: if they are, state \"scale\": \
         {{\"t_s\": {unit:e}}} in the sidecar, and if they count samples, \"columns\": {{\"t_s\": null}} and \"rate_hz\"",
        if is_whole { "are whole numbers and " } else { "" },
        shown(rate_hz),
        shown(rate_hz / unit)
    );
    let suggested = json!({ "scale": { "t_s": unit } }).as_object().cloned();
    Some(Warning { kind, column, text, suggested, ..Warning::default() })
}

/// A rate in four decimals, or in two digits when it is slow.
fn shown(rate_hz: f64) -> String {
    if rate_hz < 1e-3 { format!("{rate_hz:.1e}") } else { ((rate_hz * 1e4).round() / 1e4).to_string() }
}

/// First and last time that the rows of all columns span; none if they have no time in common.
fn common_times(time: &[f64], clocks: &[(usize, Vec<usize>)]) -> Option<(f64, f64)> {
    let ends = |(_, rows): &(usize, Vec<usize>)| Some((time[*rows.first()?], time[*rows.last()?]));
    let narrowed = |(a, b): (f64, f64), (first, last): (f64, f64)| (a.max(first), b.min(last));
    let common = clocks.iter().try_fold((f64::NEG_INFINITY, f64::INFINITY), |all, one| Some(narrowed(all, ends(one)?)));
    common.filter(|(first, last)| first <= last)
}

/// Puts needed columns that have values in some rows only on the clock of the one with fewest. An error for one without any.
pub fn on_one_clock(
    group: &mut Group,
    plan: &Plan,
    sparse: &[usize],
    (headers, path): (&[String], &Path),
) -> Result<Vec<String>, LogError> {
    let Some(time) = plan.time.map(|column| group.columns[column].clone()) else { return Ok(Vec::new()) };
    let needed: Vec<usize> = plan.targets.iter().map(|t| t.column).filter(|c| !group.columns[*c].is_empty()).collect();
    let rows_of = |column: usize| -> Vec<usize> {
        (0..time.len()).filter(|&row| !is_missing(group.columns[column][row])).collect()
    };
    let is_sparse = |column: &usize| sparse.contains(column) && group.columns[*column].iter().any(|v| is_missing(*v));
    // Nothing is made up between the samples of the slowest channel.
    let Some(base) = needed.iter().copied().min_by_key(|&column| rows_of(column).len()) else { return Ok(Vec::new()) };
    if !needed.iter().any(is_sparse) || time.windows(2).any(|w| w[1] <= w[0]) {
        return Ok(Vec::new());
    }
    let at = |rows: &[usize]| rows.iter().map(|&row| time[row]).collect::<Vec<f64>>();
    let clocks: Vec<(usize, Vec<usize>)> = needed.iter().map(|&column| (column, rows_of(column))).collect();
    let Some((first, last)) = common_times(&time, &clocks) else {
        let ((row, line), column) = (group.place(0), headers[base].clone());
        return Err(LogError::NoValues { row, line, column, path: path.to_path_buf() });
    };
    let kept: Vec<usize> = rows_of(base).into_iter().filter(|&row| (first..=last).contains(&time[row])).collect();
    let to = at(&kept);
    let mut said = Vec::new();
    let mut columns = vec![Vec::new(); group.columns.len()];
    for (column, rows) in clocks {
        let values = rows.iter().map(|&row| group.columns[column][row]).collect();
        let from = at(&rows);
        if rows != rows_of(base) {
            said.push(resample::describe(&headers[column], &from, &to));
        }
        columns[column] = match resample::onto(&to, &from, &Cells::Numbers(values)) {
            Cells::Numbers(values) => values,
            Cells::Text(_) => Vec::new(),
        };
    }
    if let Some(column) = plan.time {
        columns[column] = to;
    }
    let base_name = &headers[base];
    for text in &mut said {
        *text = format!("the clock is that of `{base_name}`; {text}");
    }
    let labels: Labels =
        if group.labels.is_empty() { Labels::default() } else { group.labels.gathered(kept.iter().copied()) };
    *group = Group::new(columns, labels);
    Ok(said)
}
