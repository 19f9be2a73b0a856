//! The topics of a file, each with its names and the clocks that it offers.

use super::items::{self, Place};
use super::kinds;
use super::names::{self, Name};
use super::repeats;
use super::source::{Decoder, Source, note};
use super::stamps::{self, Course};
use super::stated_units;
use crate::bursts::{self, BURSTS};
use crate::errors::LogError;
use crate::raw::{Cells, renamed};
use haptics::recording::{Meta, Warning};
use std::collections::HashSet;
use std::path::Path;

/// A topic, with its names and its possible clocks.
pub struct Part {
    pub source: Source,
    pub names: Vec<Name>,
    /// Texts of the units that stand beside the values; empty where there are none.
    pub units: Vec<String>,
    /// Stamps in the messages, ns, if they run on in all but a few.
    stamps_ns: Option<Vec<i64>>,
    pub needed: bool,
}

/// A kind of clock.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// A field `t_s` (or `t_ms`, …).
    Field,
    /// The stamp in the message's header.
    Stamp,
    /// Time at which the recorder wrote the message.
    Log,
}

/// Every topic of a file, and the sidecar with the items of lists by their names.
pub struct Prepared {
    pub parts: Vec<Part>,
    pub meta: Meta,
    /// Full names by place, such as `/joint_states.position[0]`, and by the name of the item.
    pub renamed: Vec<(String, String)>,
}

/// Puts the messages of all topics in order, names the items of lists, and leaves out what is there twice.
pub fn of(sources: Vec<Source>, meta: &Meta, notes: &mut Vec<Warning>, path: &Path) -> Result<Prepared, LogError> {
    let mut split = Vec::new();
    let mut by_name = Vec::new();
    for mut source in sources {
        source.topic.sort();
        let mut said = Vec::new();
        let places = items::name_items(&mut source.topic, &mut said);
        by_name.extend(places_by_name(&source.name, places, meta, path)?);
        notes.extend(said.into_iter().map(|text| note("topic", format!("the topic {}: {text}", source.name))));
        split.extend(by_kind(source, notes));
    }
    let meta = renamed(meta, &by_name);
    let mut all_stamps = Vec::new();
    for source in &mut split {
        let clock = meta.columns.get("t_s").map(|name| field_of(&source.name, name));
        let said = [repeats::count_once(&mut source.topic, clock), repeats::one_publisher(&mut source.topic)];
        let said = said.into_iter().flatten();
        notes.extend(said.map(|text| note("topic", format!("the topic {}: {text}", source.name))));
        all_stamps.push(usable_stamps(source, &meta, notes));
    }
    forget_repeated(&mut split);
    let units: Vec<Vec<String>> =
        split.iter_mut().map(|source| stated_units::take(&mut source.topic, &source.units)).collect();
    let mut parts: Vec<Part> = Vec::new();
    let names = names::of(&split);
    for (((source, names), units), stamps_ns) in split.into_iter().zip(names).zip(units).zip(all_stamps) {
        let needed = names.iter().any(|n| is_needed(n, &meta));
        parts.push(Part { source, names, units, stamps_ns, needed });
    }
    // Topics that are not needed are dropped; if none is needed, all are shown.
    if parts.iter().all(|p| !p.needed) {
        for part in &mut parts {
            part.needed = true;
        }
    }
    Ok(Prepared { parts, meta, renamed: by_name })
}

/// The field in a full name of a topic's column.
fn field_of<'a>(topic: &str, name: &'a str) -> &'a str {
    name.strip_prefix(topic).and_then(|rest| rest.strip_prefix('.')).unwrap_or(name)
}

/// Full names by place and by name; an error if the sidecar asks for a place where names change.
fn places_by_name(
    topic: &str,
    places: Vec<Place>,
    meta: &Meta,
    path: &Path,
) -> Result<Vec<(String, String)>, LogError> {
    let mut found = Vec::new();
    for place in places {
        let column = format!("{topic}.{}", place.field);
        match place.named.as_slice() {
            [] => {}
            [name] => found.push((column, format!("{topic}.{name}"))),
            names if meta.columns.values().any(|v| *v == column) => {
                let names: Vec<String> = names.iter().map(|name| format!("`{topic}.{name}`")).collect();
                return Err(LogError::ByPlace { column, names: names.join(" or "), path: path.to_path_buf() });
            }
            _ => {}
        }
    }
    Ok(found)
}

/// A source for every kind of message that a topic has.
fn by_kind(mut source: Source, notes: &mut Vec<Warning>) -> Vec<Source> {
    if source.own.is_some() {
        return vec![source];
    }
    let mut topics = kinds::split(std::mem::take(&mut source.topic));
    if topics.len() > 1 {
        let counts: Vec<String> = topics.iter().map(|topic| topic.log_ns.len().to_string()).collect();
        let text = format!(
            "the topic {} has {} kinds of messages that share no column ({} of them): each kind keeps its own clock",
            source.name,
            topics.len(),
            counts.join(" and ")
        );
        notes.push(note("topic", text));
    }
    let last = topics.pop();
    let mut sources: Vec<Source> = topics
        .into_iter()
        .map(|topic| Source {
            name: source.name.clone(),
            decoder: Decoder::Json,
            messages: topic.log_ns.len() as u64,
            topic,
            units: source.units.clone(),
            own: None,
            clockless: source.clockless,
            shown: 0,
        })
        .collect();
    source.topic = last.unwrap_or_default();
    sources.push(source);
    sources
}

/// Columns that the kinds of a topic share, such as the frame, are kept once.
fn forget_repeated(sources: &mut [Source]) {
    let mut known: HashSet<(String, String)> = HashSet::new();
    for source in sources {
        let name = &source.name;
        source
            .topic
            .forget(|field| names::time_factor(field).is_none() && known.contains(&(name.clone(), field.to_owned())));
        known.extend(source.topic.fields.iter().map(|field| (name.clone(), field.clone())));
    }
}

/// The stamps of a topic, taken out of its columns; none, with a note, where they do not run on.
fn usable_stamps(source: &mut Source, meta: &Meta, notes: &mut Vec<Warning>) -> Option<Vec<i64>> {
    let clocks = meta.clocks.values().map(|clock| clock.parts().0);
    let named = meta.columns.values().map(String::as_str).chain(clocks).map(|name| field_of(&source.name, name));
    let named: HashSet<&str> = named.collect();
    // A file of ours has its clock; such a field is a channel there.
    let is_ours = source.own.is_some();
    let stamps = stamps::take(&mut source.topic, &|field| is_ours || named.contains(field))?;
    if let Course::Stalls(why) = stamps::course(&stamps, Clock::Stamp.words()) {
        notes.push(note("clock", format!("the topic {}: {why} and is not used", source.name)));
        return None;
    }
    Some(stamps)
}

/// True for a column that the program or the sidecar asks for.
fn is_needed(name: &Name, meta: &Meta) -> bool {
    let asked = |wanted: &str| wanted == name.short || wanted == name.full;
    names::quantity(&name.short).is_some_and(|q| q != "t")
        || meta.columns.values().any(|v| asked(v))
        || meta.select.keys().any(|k| asked(k))
}

impl Clock {
    /// The clock in a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::Field => "the field t_s",
            Self::Stamp => "the stamp in the messages",
            Self::Log => "the log time",
        }
    }
}

/// Seconds from `base` on.
pub fn seconds(ns: &[i64], base: i64) -> Vec<f64> {
    ns.iter().map(|&t| t.wrapping_sub(base) as f64 / 1e9).collect()
}

impl Part {
    /// Times of the rows in ns, by a clock that is not a field.
    pub fn stamps(&self, clock: Clock) -> Vec<i64> {
        match (clock, &self.stamps_ns) {
            (Clock::Stamp, Some(stamps)) => stamps.clone(),
            _ => self.source.topic.log_ns.iter().map(|&t| t.cast_signed()).collect(),
        }
    }

    /// The column that is a time of the program.
    pub fn time_field(&self) -> Option<usize> {
        self.source.topic.fields.iter().position(|f| names::time_factor(f).is_some())
    }

    /// True if the topic has this clock.
    pub fn offers(&self, clock: Clock) -> bool {
        match clock {
            Clock::Field => self.time_field().is_some(),
            Clock::Stamp => self.stamps_ns.is_some(),
            Clock::Log => true,
        }
    }

    /// Times of the rows, s; `base` is the zero of clocks that are not a field.
    pub fn time_s(&self, clock: Clock, base: i64) -> Vec<f64> {
        let field = self.time_field().filter(|_| clock == Clock::Field);
        match field.map(|at| (&self.source.topic.columns[at], &self.source.topic.fields[at])) {
            Some((Cells::Numbers(values), name)) => {
                let factor = names::time_factor(name).unwrap_or(1.0);
                values.iter().map(|v| v * factor).collect()
            }
            _ => seconds(&self.stamps(clock), base),
        }
    }

    /// True if a position or an angle comes from the topic.
    pub fn has_motion(&self, meta: &Meta) -> bool {
        self.names.iter().any(|n| {
            let mapped = meta.columns.iter().filter(|(_, v)| **v == n.short || **v == n.full);
            names::is_motion(&n.short) || mapped.clone().any(|(k, _)| names::is_motion(k))
        })
    }

    /// Spreads stamps that come in bursts, and leaves out the few rows in which a clock does not run on, with notes; an error
    /// in words if they are many.
    pub fn settle(&mut self, clock: Clock, meta: &Meta, notes: &mut Vec<Warning>) -> Result<(), String> {
        if clock == Clock::Field {
            return Ok(());
        }
        if meta.repairs(BURSTS) {
            self.spread(clock, notes);
        }
        let name = &self.source.name;
        match stamps::course(&self.stamps(clock), clock.words()) {
            Course::RunsOn => {}
            Course::AllBut(keep, why) => {
                notes.push(note("clock", format!("the topic {name}: {why}")));
                self.source.topic.keep(&keep);
                self.stamps_ns = self.stamps_ns.take().map(|all| keep.iter().map(|&i| all[i]).collect());
            }
            Course::Stalls(why) => return Err(format!("{why} in {name}")),
        }
        Ok(())
    }

    /// Gives messages that come in bursts the times of the samples in them.
    fn spread(&mut self, clock: Clock, notes: &mut Vec<Warning>) {
        let stamps = self.stamps(clock);
        let base = stamps.first().copied().unwrap_or(0);
        let Some((even, text)) = bursts::even(&seconds(&stamps, base)) else { return };
        notes.push(note(BURSTS, format!("the topic {}: {text}", self.source.name)));
        let even: Vec<i64> = even.into_iter().map(|t| base.wrapping_add((1e9 * t).round() as i64)).collect();
        match clock {
            Clock::Stamp => self.stamps_ns = Some(even),
            _ => self.source.topic.log_ns = even.into_iter().map(i64::cast_unsigned).collect(),
        }
    }

    /// True if `clock` runs on in all but a few rows.
    pub fn runs(&self, clock: Clock) -> bool {
        clock == Clock::Field || !matches!(stamps::course(&self.stamps(clock), ""), Course::Stalls(_))
    }
}
