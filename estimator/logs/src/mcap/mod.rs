//! MCAP files: topics of messages in JSON, protobuf or ROS 2 CDR, to one table.

pub mod attached;
mod cdr;
mod clocks;
mod items;
mod json;
mod kinds;
mod lengths;
mod metadata;
mod names;
mod parts;
mod protobuf;
pub mod records;
mod repeats;
pub mod resample;
mod rosmsg;
mod schema;
mod schema_units;
mod source;
mod stamps;
mod stated_units;
pub mod stream;
mod topic;
pub mod write;

use super::errors::LogError;
use super::preview::Preview;
use super::raw::{Cells, Raw};
use super::room;
use super::watch::Watch;
use ::mcap::records::{Channel, Record};
use haptics::recording::{Meta, Warning};
use metadata::{CLOCKLESS, COLUMNS, METADATA, SIDECAR, STREAMED};
use records::{End, Event};
use source::{Decoder, Source, note};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use topic::Topic;

/// Number of messages after which the memory is checked.
const CHECK_EVERY: u64 = 1024;
/// Number of messages after which the decoded values are shown.
const SHOW_EVERY: u64 = 8192;

/// Everything that was read.
pub struct Log {
    sources: Vec<Source>,
    end: End,
    streamed: bool,
    /// The sidecar that the file carries.
    pub sidecar: Option<String>,
    path: PathBuf,
}

/// Reads every message that can be read.
pub fn read(path: &Path, size: u64, watch: &Watch<'_>) -> Result<Log, LogError> {
    let mut reading = Reading { size, preview: watch.preview, ..Reading::new(path) };
    let end = records::walk(path, size, watch, &mut |event| reading.take(event))?;
    let log = Log {
        sources: reading.sources,
        end,
        streamed: reading.streamed,
        sidecar: reading.sidecar,
        path: path.to_path_buf(),
    };
    match &log.end {
        End::CutOff(why) if !log.streamed => {
            Err(LogError::CutOff { format: "MCAP", why: why.clone(), path: path.to_path_buf() })
        }
        _ => Ok(log),
    }
}

impl Log {
    /// One table on one clock, with notes for the reader.
    pub fn columns(self, meta: &Meta) -> Result<(Raw, Vec<Warning>), LogError> {
        let mut notes = Vec::new();
        if let End::CutOff(why) = &self.end {
            notes.push(note(
                "cut-off",
                format!("the recording did not end properly ({why}); it is read up to its last whole block"),
            ));
        }
        for source in &self.sources {
            if let (Decoder::None(why), true) = (&source.decoder, source.messages > 0) {
                notes.push(note("topic", format!("the topic {} is not read: {why}", source.name)));
            }
            if source.topic.long_lists {
                let text = format!(
                    "the topic {} has lists of more than {} items, of which the rest is not read",
                    source.name,
                    topic::MAX_ITEMS
                );
                notes.push(note("topic", text));
            }
        }
        let there = self.sources.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
        let sources: Vec<Source> = self.sources.into_iter().filter(|s| !s.topic.columns.is_empty()).collect();
        if sources.is_empty() {
            let why = match (notes.iter().find(|n| n.kind == "topic"), there.is_empty()) {
                (Some(note), _) => note.text.clone(),
                (None, false) => return Err(LogError::HeaderOnly { path: self.path }),
                (None, true) => "it has no topics".to_owned(),
            };
            return Err(LogError::NoColumns { format: "MCAP", why, path: self.path });
        }
        let raw = clocks::one_table(sources, meta, &mut notes, &self.path)?;
        Ok((raw, notes))
    }
}

struct Reading<'a> {
    path: &'a Path,
    size: u64,
    schemas: HashMap<u16, (String, String, Vec<u8>)>,
    /// Channel of the file → source.
    channels: HashMap<u16, usize>,
    sources: Vec<Source>,
    sidecar: Option<String>,
    streamed: bool,
    messages: u64,
    preview: Option<&'a Preview>,
    /// Scratch for the path of a field.
    field: String,
}

impl<'a> Reading<'a> {
    fn new(path: &'a Path) -> Self {
        Self {
            path,
            size: 0,
            schemas: HashMap::new(),
            channels: HashMap::new(),
            sources: Vec::new(),
            sidecar: None,
            streamed: false,
            messages: 0,
            preview: None,
            field: String::new(),
        }
    }

    fn damaged(&self, why: String) -> LogError {
        LogError::Damaged { format: "MCAP", why, path: self.path.to_path_buf() }
    }

    fn take(&mut self, event: Event<'_>) -> Result<(), LogError> {
        match event {
            Event::Message(channel, log_ns, data) => self.message(channel, log_ns, data),
            Event::Record(Record::Schema { header, data }) => {
                self.schemas.insert(header.id, (header.name, header.encoding, data.into_owned()));
                Ok(())
            }
            Event::Record(Record::Channel(channel)) => {
                self.channel(channel);
                Ok(())
            }
            Event::Record(Record::Metadata(metadata)) if metadata.name == METADATA => {
                self.streamed |= metadata.metadata.contains_key(STREAMED);
                self.sidecar = metadata.metadata.get(SIDECAR).cloned().or(self.sidecar.take());
                Ok(())
            }
            Event::Record(_) => Ok(()),
        }
    }

    /// A channel of a topic that is known already (another publisher, or the record repeated) feeds the same columns.
    fn channel(&mut self, channel: Channel) {
        if self.channels.contains_key(&channel.id) {
            return;
        }
        let mut topic = Topic::default();
        let decoder = self.decoder(&channel, &mut topic);
        let same = |s: &Source| {
            s.name == channel.topic && matches!(s.decoder, Decoder::None(_)) == matches!(decoder, Decoder::None(_))
        };
        if let Some(known) = self.sources.iter().position(same) {
            self.channels.insert(channel.id, known);
            return;
        }
        let units = match &decoder {
            Decoder::Json => self.schemas.get(&channel.schema_id).map(|(.., schema)| schema_units::of_json(schema)),
            Decoder::Cdr(types) => Some(schema_units::of_ros(types)),
            _ => None,
        };
        let units = units.unwrap_or_default();
        let own = channel.metadata.get(COLUMNS).and_then(|text| serde_json::from_str(text).ok());
        self.channels.insert(channel.id, self.sources.len());
        self.sources.push(Source {
            name: channel.topic,
            decoder,
            topic,
            messages: 0,
            units,
            own,
            clockless: channel.metadata.contains_key(CLOCKLESS),
            shown: 0,
        });
    }

    fn decoder(&self, channel: &Channel, topic: &mut Topic) -> Decoder {
        let (name, encoding, data) =
            self.schemas.get(&channel.schema_id).map_or(("", "", &[][..]), |(n, e, d)| (n, e, d));
        let made = match (channel.message_encoding.as_str(), encoding) {
            ("json", _) => Ok(Decoder::Json),
            ("protobuf", _) => protobuf::prepare(name, data, topic).map(|s| Decoder::Protobuf(Box::new(s))),
            ("cdr", "ros2msg") => std::str::from_utf8(data)
                .map_err(|_| "its schema is not text".to_owned())
                .and_then(|text| rosmsg::Definitions::parse(name, text))
                .map(|d| Decoder::Cdr(Box::new(d))),
            (message, schema) => Err(format!(
                "messages in `{message}` with a schema in `{schema}` are not known; json, protobuf and cdr with ros2msg are"
            )),
        };
        made.unwrap_or_else(|why| {
            *topic = Topic::default();
            Decoder::None(why)
        })
    }

    fn message(&mut self, channel: u16, log_ns: u64, data: &[u8]) -> Result<(), LogError> {
        let Some(&at) = self.channels.get(&channel) else {
            return Err(self.damaged(format!("a message of channel {channel}, which it does not have")));
        };
        let source = &mut self.sources[at];
        source.messages += 1;
        self.messages += 1;
        if matches!(source.decoder, Decoder::None(_)) {
            return Ok(());
        }
        source.topic.begin(log_ns, channel);
        let done = match &mut source.decoder {
            Decoder::Json => json::decode(data, &mut source.topic, &mut self.field),
            Decoder::Protobuf(shape) => protobuf::decode(shape, data, &mut source.topic),
            Decoder::Cdr(types) => cdr::decode(types, data, &mut source.topic, &mut self.field),
            Decoder::None(_) => Ok(()),
        };
        source.topic.end();
        if let Err(why) = done {
            let (number, name) = (source.messages, source.name.clone());
            return Err(self.damaged(format!("message {number} of {name}: {why}")));
        }
        if self.messages.is_multiple_of(SHOW_EVERY) {
            self.show();
        }
        if self.messages.is_multiple_of(CHECK_EVERY) { self.check_memory() } else { Ok(()) }
    }

    /// Shows the decoded rows, by the log's own time.
    fn show(&mut self) {
        let Some(preview) = self.preview else { return };
        let start = self.sources.iter().filter_map(|s| s.topic.log_ns.first().copied()).min().unwrap_or(0);
        for source in &mut self.sources {
            let (first, topic) = (std::mem::replace(&mut source.shown, source.topic.log_ns.len()), &source.topic);
            let new = topic.log_ns.get(first..).unwrap_or_default();
            let time: Vec<f64> = new.iter().map(|&ns| ns.saturating_sub(start) as f64 * 1e-9).collect();
            let columns = topic.fields.iter().zip(&topic.columns).filter_map(|(field, cells)| match cells {
                Cells::Numbers(values) => Some((field.as_str(), values.get(first..)?)),
                Cells::Text(_) => None,
            });
            preview.grow(&source.name, first, &time, columns);
        }
    }

    fn check_memory(&self) -> Result<(), LogError> {
        let held: usize = self.sources.iter().map(|s| s.topic.bytes() + s.topic.text_bytes()).sum();
        if held as u64 > room::limit(self.size) {
            return Err(self.damaged(format!("it unpacks to more than {} MiB of values", held >> 20)));
        }
        Ok(())
    }
}

#[cfg(test)]
mod order_tests;
#[cfg(test)]
mod tests;
