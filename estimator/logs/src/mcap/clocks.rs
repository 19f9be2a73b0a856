//! Clock of the table, and resampling of topics with different clocks onto it.

use super::names;
use super::parts::{self, Clock, Part, seconds};
use super::resample;
use super::source::{Source, note};
use super::stamps::is_increasing;
use crate::errors::LogError;
use crate::raw::{Cells, Raw};
use haptics::recording::{Meta, RESAMPLED, Warning};
use std::path::Path;

/// An extra topic may shorten the recording by this share; one that shortens it more is left out.
const MAX_CUT: f64 = 0.05;
/// Start of 1990 in nanoseconds since 1970: nobody measured with these formats before.
const FIRST_DATE_NS: i64 = 631_152_000_000_000_000;

/// Makes one table of all topics.
pub fn one_table(sources: Vec<Source>, meta: &Meta, notes: &mut Vec<Warning>, path: &Path) -> Result<Raw, LogError> {
    let parts::Prepared { mut parts, meta, renamed } = parts::of(sources, meta, notes, path)?;
    let raw = match (parts.pop(), parts.is_empty()) {
        (Some(part), true) => single(part, &meta, notes, path)?,
        (part, _) => {
            parts.extend(part);
            several(parts, &meta, notes, path)?
        }
    };
    Ok(Raw { renamed, ..raw })
}

/// A file with one topic: its rows as they are, on its own clock.
fn single(mut part: Part, meta: &Meta, notes: &mut Vec<Warning>, path: &Path) -> Result<Raw, LogError> {
    let timed = part.names.iter().any(|n| {
        names::time_factor(&n.short).is_some()
            || meta.columns.get("t_s").is_some_and(|t| *t == n.short || *t == n.full)
            || (meta.rate_hz.is_none() && matches!(n.short.as_str(), "time_s" | "timestamp_s"))
    });
    let mut raw = Raw::default();
    if !timed && !part.source.clockless {
        let clock = if part.offers(Clock::Stamp) { Clock::Stamp } else { Clock::Log };
        match (part.settle(clock, meta, notes), meta.rate_hz) {
            (Ok(()), _) => {
                let stamps = part.stamps(clock);
                let base = stamps.first().copied().unwrap_or(0);
                raw.origin_ns = dated(base);
                let times = Cells::Numbers(seconds(&stamps, base));
                raw.push(("t_s".to_owned(), String::new()), String::new(), times);
                let text = format!("the time is {} of {}, from the first message on", clock.words(), part.source.name);
                notes.push(note("clock", text));
            }
            (Err(why), Some(rate)) => {
                notes.push(note("clock", format!("{why}; the time is made from the sidecar's rate_hz, {rate}")));
            }
            (Err(why), None) => return Err(LogError::NoClock { why, path: path.to_path_buf() }),
        }
    }
    for ((name, unit), cells) in part.names.into_iter().zip(part.units).zip(part.source.topic.columns) {
        raw.push((name.short, name.full), unit, cells);
    }
    Ok(raw)
}

/// Files with several topics: all that are needed come onto the clock of the motion.
fn several(parts: Vec<Part>, meta: &Meta, notes: &mut Vec<Warning>, path: &Path) -> Result<Raw, LogError> {
    let refused = |why: String| LogError::Clocks { why, path: path.to_path_buf() };
    if let Some(time) = meta.columns.get("t_s") {
        return one_with_mapped_time(parts, time, meta, notes, &refused, path);
    }
    let needed = || parts.iter().filter(|p| p.needed);
    let clock = [Clock::Field, Clock::Stamp, Clock::Log]
        .into_iter()
        .find(|&c| needed().all(|p| p.offers(c)))
        .unwrap_or(Clock::Log);
    if meta.rate_hz.is_some() && needed().count() == 1 && !needed().all(|p| p.runs(clock)) {
        return one_at_a_rate(parts, meta, notes, path);
    }
    let base = needed().filter_map(|p| p.stamps(clock).first().copied()).min().unwrap_or(0);
    let mut timed = Vec::new();
    for mut part in parts {
        let settled = if part.offers(clock) { part.settle(clock, meta, notes) } else { Err(String::new()) };
        let time = part.time_s(clock, base);
        let name = &part.source.name;
        if settled.is_ok() && time.len() > 1 && is_increasing(&time) && time.iter().all(|t| t.is_finite()) {
            timed.push((part, time));
        } else if part.needed {
            let why = format!("{} stands still or goes backwards in {name}", clock.words());
            return Err(refused(settled.err().filter(|why| !why.is_empty()).unwrap_or(why)));
        } else {
            let text = format!("the topic {name} is not used: it has no {} that runs on", clock.words());
            notes.push(note("topic", text));
        }
    }
    let master = master(&timed, meta);
    let (first, last) = common_range(&mut timed, master, notes, &refused)?;
    let raw = merge(timed, master, (first, last), clock, notes, &refused)?;
    Ok(Raw { origin_ns: dated(base).filter(|_| clock != Clock::Field), ..raw })
}

/// The zero of stamps, ns since 1970, if they can be such: those of a clock that starts with a device are small.
fn dated(base_ns: i64) -> Option<i64> {
    (base_ns > FIRST_DATE_NS).then_some(base_ns)
}

/// A time that the sidecar picks from one topic says nothing about the others.
fn one_with_mapped_time(
    parts: Vec<Part>,
    time: &str,
    meta: &Meta,
    notes: &mut Vec<Warning>,
    refused: &dyn Fn(String) -> LogError,
    path: &Path,
) -> Result<Raw, LogError> {
    let (mut needed, others): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|p| p.needed);
    let (Some(part), true) = (needed.pop(), needed.is_empty()) else {
        return Err(refused(format!(
            "t_s is mapped to `{time}`, a field of one topic; leave it out, and the messages' own clocks are used"
        )));
    };
    for other in others {
        let text = format!("the topic {} is not used: `{time}` is no clock of it", other.source.name);
        notes.push(note("topic", text));
    }
    single(part, meta, notes, path)
}

/// The one topic that is needed, where its clock stands still and the sidecar gives a rate.
fn one_at_a_rate(parts: Vec<Part>, meta: &Meta, notes: &mut Vec<Warning>, path: &Path) -> Result<Raw, LogError> {
    let (mut needed, others): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|p| p.needed);
    for other in others {
        notes.push(note("topic", format!("the topic {} is not used: rate_hz is no clock of it", other.source.name)));
    }
    needed.pop().map_or_else(|| Ok(Raw::default()), |part| single(part, meta, notes, path))
}

/// The topic whose clock is kept: the slowest that has motion; without motion the slowest of the needed ones.
fn master(timed: &[(Part, Vec<f64>)], meta: &Meta) -> usize {
    let slowest = |of: &dyn Fn(&Part) -> bool| {
        let candidates = timed.iter().enumerate().filter(|(_, (p, _))| of(p));
        candidates.max_by(|a, b| resample::period(&a.1.1).total_cmp(&resample::period(&b.1.1))).map(|(i, _)| i)
    };
    slowest(&|p| p.needed && p.has_motion(meta)).or_else(|| slowest(&|p| p.needed)).unwrap_or(0)
}

/// The span that all needed topics cover; extra topics that would cut much off are taken out of `timed`.
fn common_range(
    timed: &mut [(Part, Vec<f64>)],
    master: usize,
    notes: &mut Vec<Warning>,
    refused: &dyn Fn(String) -> LogError,
) -> Result<(f64, f64), LogError> {
    let ends = |time: &[f64]| (time[0], time[time.len() - 1]);
    let (mut first, mut last) = ends(&timed[master].1);
    for (part, time) in timed.iter().filter(|(p, _)| p.needed) {
        let (start, end) = ends(time);
        (first, last) = (first.max(start), last.min(end));
        if first >= last {
            return Err(refused(format!("{} shares no time with the others", part.source.name)));
        }
    }
    let length = last - first;
    for (part, time) in timed.iter_mut().filter(|(p, _)| !p.needed) {
        let (start, end) = ends(time);
        if (start - first).max(last - end) > MAX_CUT * length {
            let text = format!("the topic {} is not used: it covers too little of the recording", part.source.name);
            notes.push(note("topic", text));
            part.source.topic.forget(|_| true);
            part.names.clear();
        }
    }
    for (_, time) in timed.iter().filter(|(p, _)| !p.needed && !p.names.is_empty()) {
        let (start, end) = ends(time);
        (first, last) = (first.max(start), last.min(end));
    }
    Ok((first, last))
}

fn merge(
    timed: Vec<(Part, Vec<f64>)>,
    master: usize,
    (first, last): (f64, f64),
    clock: Clock,
    notes: &mut Vec<Warning>,
    refused: &dyn Fn(String) -> LogError,
) -> Result<Raw, LogError> {
    let whole = timed[master].1.clone();
    let keep: Vec<usize> = (0..whole.len()).filter(|&i| whole[i] >= first && whole[i] <= last).collect();
    if keep.len() < 2 {
        return Err(refused("they share less than two samples".to_owned()));
    }
    let time: Vec<f64> = keep.iter().map(|&i| whole[i]).collect();
    let mut raw = Raw::default();
    raw.push(("t_s".to_owned(), String::new()), String::new(), Cells::Numbers(time.clone()));
    let mut said = Vec::new();
    let mut kind = "clock";
    for (index, (part, from)) in timed.into_iter().enumerate() {
        let time_field = part.time_field();
        let same = index == master || from == time;
        if !same && !part.names.is_empty() {
            kind = RESAMPLED;
            said.push(resample::describe(&part.source.name, &from, &time));
            notes.extend(resample::gaps(&part.source.name, &from, &time).map(|t| note("gap", t)));
        }
        let named = part.names.into_iter().zip(part.units);
        for (column, ((name, unit), cells)) in named.zip(part.source.topic.columns).enumerate() {
            if Some(column) == time_field {
                continue;
            }
            let cells = if index == master { cells.gathered(&keep) } else { resample::onto(&time, &from, &cells) };
            raw.push((name.short, name.full), unit, cells);
        }
        if index == master {
            let text = format!("{} of {}", clock.words(), part.source.name);
            said.insert(0, format!("the time is {text}"));
        }
    }
    let cut = whole.len() - keep.len();
    if cut > 0 {
        said.push(format!("{cut} samples that not all topics cover are left out"));
    }
    notes.push(note(kind, said.join("; ")));
    Ok(raw)
}
