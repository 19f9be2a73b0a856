//! MCAP out: one topic of protobuf or JSON messages, one a sample, that Foxglove, PlotJuggler and Rerun open, and that reads back
//! to the same bits.

use super::metadata::{METADATA, SIDECAR, STREAMED, channel_metadata};
use super::schema::{self, RowSchema};
use crate::errors::LogError;
use crate::rows::{Attachment, Value, cell, columns, log_times_ns, not_finite};
use crate::sidecar::written_meta;
use ::mcap::records::{MessageHeader, Metadata};
use ::mcap::{McapError, WriteOptions, Writer};
use haptics::recording::{Meta, Recording};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// The topic of a recording.
pub const TOPIC: &str = "/recording";

/// Encoding of the messages of a file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Protocol buffers: small, and read fast.
    #[default]
    Protobuf,
    /// JSON: read by any script.
    Json,
}

/// A file that is being written.
pub(super) struct Sink {
    writer: Writer<BufWriter<File>>,
    channel: u16,
    /// Names of the columns for JSON messages; empty for protobuf.
    names: Vec<String>,
    sequence: u32,
    message: Vec<u8>,
}

impl Sink {
    /// Creates the file with its schema, metadata and attachments.
    pub fn create(
        path: &Path,
        columns: &[(String, bool)],
        clockless: bool,
        metadata: BTreeMap<String, String>,
        (attachments, encoding): (&[Attachment], Encoding),
    ) -> Result<Self, McapError> {
        let file = BufWriter::with_capacity(1 << 18, File::create(path)?);
        let library = concat!("touchstone ", env!("CARGO_PKG_VERSION"));
        let mut options = WriteOptions::new().library(library);
        if metadata.contains_key(STREAMED) {
            // A block goes to the file as a whole, so that no killed process leaves one with an empty head. A thousand
            // rows a second need no threads beside their own.
            options = options.disable_seeking(true).compression_threads(0);
        }
        let mut writer = options.create(file)?;
        writer.write_metadata(&Metadata { name: METADATA.to_owned(), metadata })?;
        for attachment in attachments {
            writer.attach(&::mcap::Attachment {
                log_time: 0,
                create_time: 0,
                name: attachment.name.clone(),
                media_type: attachment.media_type.clone(),
                data: Cow::Borrowed(&attachment.data),
            })?;
        }
        if encoding == Encoding::Json {
            let names: Vec<String> = columns.iter().map(|(name, _)| name.clone()).collect();
            let own = names.iter().map(|name| (name.clone(), name.clone())).collect();
            let schema = writer.add_schema(schema::MESSAGE, "jsonschema", &schema::of_json(columns))?;
            let channel = writer.add_channel(schema, TOPIC, "json", &channel_metadata(&own, clockless))?;
            return Ok(Self { writer, channel, names, sequence: 0, message: Vec::new() });
        }
        let row = RowSchema::new(columns);
        let schema = writer.add_schema(schema::MESSAGE, "protobuf", &row.descriptor)?;
        let channel = writer.add_channel(schema, TOPIC, "protobuf", &channel_metadata(&row.columns, clockless))?;
        Ok(Self { writer, channel, names: Vec::new(), sequence: 0, message: Vec::new() })
    }

    /// Appends one row; `values` in the order of the columns.
    pub fn row<'v>(&mut self, log_time: u64, values: impl Iterator<Item = Value<'v>>) -> Result<(), McapError> {
        self.message.clear();
        if self.names.is_empty() {
            values.enumerate().for_each(|(index, value)| schema::put(index, &value, &mut self.message));
        } else {
            schema::put_json(&self.names, values, &mut self.message);
        }
        let header =
            MessageHeader { channel_id: self.channel, sequence: self.sequence, log_time, publish_time: log_time };
        self.sequence = self.sequence.wrapping_add(1);
        self.writer.write_to_known_channel(&header, &self.message)
    }

    /// Writes the facts again: the last ones hold.
    pub fn metadata(&mut self, metadata: BTreeMap<String, String>) -> Result<(), McapError> {
        self.writer.write_metadata(&Metadata { name: METADATA.to_owned(), metadata })
    }

    /// Ends the block and hands it to the system.
    pub fn flush(&mut self) -> Result<(), McapError> {
        self.writer.flush()
    }

    /// Writes the summary and the footer.
    pub fn finish(mut self) -> Result<(), McapError> {
        use std::io::Write as _;
        self.writer.finish()?;
        self.writer.into_inner().flush()?;
        Ok(())
    }
}

/// Metadata that travels with the samples: the sidecar as a whole, and its facts one by one for people.
pub(super) fn metadata(meta: &Meta) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    if let Ok(serde_json::Value::Object(facts)) = serde_json::to_value(meta) {
        for (key, value) in facts {
            match value {
                serde_json::Value::Object(inner) => {
                    found.extend(inner.iter().map(|(name, v)| (format!("{key}.{name}"), plain(v))));
                }
                other => {
                    found.insert(key, plain(&other));
                }
            }
        }
    }
    // Last, so that no fact can take its place.
    found.insert(SIDECAR.to_owned(), serde_json::to_string(meta).unwrap_or_default());
    found
}

fn plain(value: &serde_json::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Writes the recordings of one file as MCAP.
pub fn write(
    recordings: &[Recording],
    path: &Path,
    attachments: &[Attachment],
    encoding: Encoding,
) -> Result<(), LogError> {
    let columns = columns(recordings, path)?;
    let failed = |e: McapError| LogError::Write { reason: super::records::one_line(&e), path: path.to_path_buf() };
    if let Some(why) = not_finite(recordings) {
        return Err(LogError::NotWritable { why, path: path.to_path_buf() });
    }
    let Some(first) = recordings.first() else { return Ok(()) };
    let mut metadata = metadata(&written_meta(first));
    // Reserved for streams.
    metadata.remove(STREAMED);
    let carried = (attachments, encoding);
    let mut sink = Sink::create(path, &columns, first.time_s.is_none(), metadata, carried).map_err(failed)?;
    for (recording, times) in recordings.iter().zip(log_times_ns(recordings)) {
        for (row, &log_time) in times.iter().enumerate() {
            let values = (0..columns.len()).map(|column| cell(recording, column, row));
            sink.row(log_time, values).map_err(failed)?;
        }
    }
    sink.finish().map_err(failed)
}
