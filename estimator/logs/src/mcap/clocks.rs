//! Clock of the table, and resampling of topics with different clocks onto it.

use super::names::{self, Name};
use super::resample;
use super::source::{Source, note};
use super::topic::Topic;
use crate::errors::LogError;
use crate::raw::{Cells, Raw};
use haptics::recording::{Meta, Warning};
use std::path::Path;

/// Fields of a stamp in a message: seconds and nanoseconds (ROS, Foxglove's schemas in JSON and in protobuf).
const STAMPS: [(&str, &str); 6] = [
    ("header.stamp.sec", "header.stamp.nanosec"),
    ("header.stamp.sec", "header.stamp.nsec"),
    ("timestamp.sec", "timestamp.nsec"),
    ("timestamp.seconds", "timestamp.nanos"),
    ("stamp.sec", "stamp.nanosec"),
    ("stamp.sec", "stamp.nsec"),
];
/// An extra topic may shorten the recording by this share; one that shortens it more is left out.
const MAX_CUT: f64 = 0.05;

/// A topic, with its names and its possible clocks.
struct Part {
    source: Source,
    names: Vec<Name>,
    /// Stamps in the messages, ns.
    stamps_ns: Option<Vec<i64>>,
    needed: bool,
}

/// A kind of clock.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Clock {
    /// A field `t_s` (or `t_ms`, …).
    Field,
    /// The stamp in the message's header.
    Stamp,
    /// Time at which the recorder wrote the message.
    Log,
}

/// Makes one table of all topics.
pub fn one_table(
    mut sources: Vec<Source>,
    meta: &Meta,
    notes: &mut Vec<Warning>,
    path: &Path,
) -> Result<Raw, LogError> {
    let mut stamps = Vec::new();
    for source in &mut sources {
        source.topic.sort();
        source.topic.name_items();
        stamps.push(take_stamps(&mut source.topic));
    }
    let names = names::of(&sources);
    let mut parts: Vec<Part> = Vec::new();
    for ((source, names), stamps_ns) in sources.into_iter().zip(names).zip(stamps) {
        let needed = names.iter().any(|n| is_needed(n, meta));
        parts.push(Part { source, names, stamps_ns, needed });
    }
    // Topics that are not needed are dropped; if none is needed, all are shown.
    if parts.iter().all(|p| !p.needed) {
        for part in &mut parts {
            part.needed = true;
        }
    }
    if parts.len() == 1 {
        return Ok(parts.pop().map(|part| single(part, meta, notes)).unwrap_or_default());
    }
    several(parts, meta, notes, path)
}

/// True for a column that the program or the sidecar asks for.
fn is_needed(name: &Name, meta: &Meta) -> bool {
    let asked = |wanted: &str| wanted == name.short || wanted == name.full;
    names::quantity(&name.short).is_some_and(|q| q != "t")
        || meta.columns.values().any(|v| asked(v))
        || meta.select.keys().any(|k| asked(k))
}

/// The stamps of the messages; their fields are taken out of the columns.
fn take_stamps(topic: &mut Topic) -> Option<Vec<i64>> {
    for (seconds, nanos) in STAMPS {
        let (Some(Cells::Numbers(s)), Some(Cells::Numbers(n))) = (topic.find(seconds), topic.find(nanos)) else {
            continue;
        };
        // Whole numbers below 2^53 are exact.
        let both = s.iter().zip(n).map(|(s, n)| {
            let whole = s.fract() == 0.0 && n.fract() == 0.0 && s.abs() < 9e9 && (0.0..1e9).contains(n);
            whole.then(|| *s as i64 * 1_000_000_000 + *n as i64)
        });
        let stamps: Option<Vec<i64>> = both.collect();
        topic.forget(|field| field == seconds || field == nanos);
        // Stamps that were never set are all zero.
        return stamps.filter(|s| is_increasing(s));
    }
    None
}

fn is_increasing<T: PartialOrd>(values: &[T]) -> bool {
    values.len() > 1 && values.windows(2).all(|w| w[0] < w[1])
}

/// A file with one topic: its rows as they are, on its own clock.
fn single(part: Part, meta: &Meta, notes: &mut Vec<Warning>) -> Raw {
    let timed = part.names.iter().any(|n| {
        names::time_factor(&n.short).is_some()
            || meta.columns.get("t_s").is_some_and(|t| *t == n.short || *t == n.full)
            || (meta.rate_hz.is_none() && matches!(n.short.as_str(), "time_s" | "timestamp_s"))
    });
    let mut raw = Raw::default();
    if !timed && !part.source.clockless {
        let clock = if part.stamps_ns.is_some() { Clock::Stamp } else { Clock::Log };
        let stamps = part.stamps(clock);
        let base = stamps.first().copied().unwrap_or(0);
        raw.headers.push("t_s".to_owned());
        raw.aliases.push(String::new());
        raw.columns.push(Cells::Numbers(seconds(&stamps, base)));
        notes.push(note(
            "clock",
            format!("the time is {} of {}, from the first message on", clock.words(), part.source.name),
        ));
    }
    for (name, cells) in part.names.into_iter().zip(part.source.topic.columns) {
        raw.headers.push(name.short);
        raw.aliases.push(name.full);
        raw.columns.push(cells);
    }
    raw
}

impl Clock {
    fn words(self) -> &'static str {
        match self {
            Self::Field => "the field t_s",
            Self::Stamp => "the stamp in the messages",
            Self::Log => "the log time",
        }
    }
}

fn seconds(ns: &[i64], base: i64) -> Vec<f64> {
    ns.iter().map(|&t| t.wrapping_sub(base) as f64 / 1e9).collect()
}

impl Part {
    /// Times of the rows in ns, by a clock that is not a field.
    fn stamps(&self, clock: Clock) -> Vec<i64> {
        match (clock, &self.stamps_ns) {
            (Clock::Stamp, Some(stamps)) => stamps.clone(),
            _ => self.source.topic.log_ns.iter().map(|&t| t.cast_signed()).collect(),
        }
    }

    /// The column that is a time of the program.
    fn time_field(&self) -> Option<usize> {
        self.source.topic.fields.iter().position(|f| names::time_factor(f).is_some())
    }

    fn offers(&self, clock: Clock) -> bool {
        match clock {
            Clock::Field => self.time_field().is_some(),
            Clock::Stamp => self.stamps_ns.is_some(),
            Clock::Log => true,
        }
    }

    /// Times of the rows, s; `base` is the zero of clocks that are not a field.
    fn time_s(&self, clock: Clock, base: i64) -> Vec<f64> {
        let field = self.time_field().filter(|_| clock == Clock::Field);
        match field.map(|at| (&self.source.topic.columns[at], &self.source.topic.fields[at])) {
            Some((Cells::Numbers(values), name)) => {
                let factor = names::time_factor(name).unwrap_or(1.0);
                values.iter().map(|v| v * factor).collect()
            }
            _ => seconds(&self.stamps(clock), base),
        }
    }

    fn has_motion(&self, meta: &Meta) -> bool {
        self.names.iter().any(|n| {
            let mapped = meta.columns.iter().filter(|(_, v)| **v == n.short || **v == n.full);
            names::is_motion(&n.short) || mapped.clone().any(|(k, _)| names::is_motion(k))
        })
    }
}

/// Files with several topics: all that are needed come onto the clock of the motion.
fn several(parts: Vec<Part>, meta: &Meta, notes: &mut Vec<Warning>, path: &Path) -> Result<Raw, LogError> {
    let refused = |why: String| LogError::Clocks { why, path: path.to_path_buf() };
    if let Some(time) = meta.columns.get("t_s") {
        return one_with_mapped_time(parts, time, meta, notes, &refused);
    }
    let needed = || parts.iter().filter(|p| p.needed);
    let clock = [Clock::Field, Clock::Stamp, Clock::Log]
        .into_iter()
        .find(|&c| needed().all(|p| p.offers(c)))
        .unwrap_or(Clock::Log);
    let base = needed().filter_map(|p| p.stamps(clock).first().copied()).min().unwrap_or(0);
    let mut timed = Vec::new();
    for part in parts {
        let time = if part.offers(clock) { part.time_s(clock, base) } else { part.time_s(Clock::Log, base) };
        let name = &part.source.name;
        if is_increasing(&time) && time.iter().all(|t| t.is_finite()) && part.offers(clock) {
            timed.push((part, time));
        } else if part.needed {
            return Err(refused(format!("{} of {name} stands still or goes backwards", clock.words())));
        } else {
            let text = format!("the topic {name} is not used: it has no {} that runs on", clock.words());
            notes.push(note("topic", text));
        }
    }
    let master = master(&timed, meta);
    let (first, last) = common_range(&mut timed, master, notes, &refused)?;
    merge(timed, master, (first, last), clock, notes, &refused)
}

/// A time that the sidecar picks from one topic says nothing about the others.
fn one_with_mapped_time(
    parts: Vec<Part>,
    time: &str,
    meta: &Meta,
    notes: &mut Vec<Warning>,
    refused: &dyn Fn(String) -> LogError,
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
    Ok(single(part, meta, notes))
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
    let mut push = |short: String, full: String, cells: Cells| {
        raw.headers.push(short);
        raw.aliases.push(full);
        raw.columns.push(cells);
    };
    push("t_s".to_owned(), String::new(), Cells::Numbers(time.clone()));
    let mut said = Vec::new();
    for (index, (part, from)) in timed.into_iter().enumerate() {
        let time_field = part.time_field();
        let same = index == master || from == time;
        if !same && !part.names.is_empty() {
            said.push(resample::describe(&part.source.name, &from, &time));
            notes.extend(resample::gaps(&part.source.name, &from, &time).map(|t| note("gap", t)));
        }
        for (column, (name, cells)) in part.names.into_iter().zip(part.source.topic.columns).enumerate() {
            if Some(column) == time_field {
                continue;
            }
            let cells = if index == master { cells.gathered(&keep) } else { resample::onto(&time, &from, &cells) };
            push(name.short, name.full, cells);
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
    notes.push(note("resampled", said.join("; ")));
    Ok(raw)
}
