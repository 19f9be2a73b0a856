//! A recording that grows on the disk, block by block, and outlives the process that writes it.

use super::metadata::STREAMED;
use super::records;
use super::write::{Encoding, Sink, metadata};
use crate::errors::LogError;
use crate::rows::{Attachment, Value};
use crate::sidecar::portable_meta;
use ::mcap::McapError;
use haptics::recording::Meta;
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A block is ended and handed to the system at least this often while rows come, so that a killed process loses less than
/// a second.
const FLUSH_EVERY: Duration = Duration::from_millis(500);
/// Name of the text column.
const LABEL: &str = "label";

/// Writes rows to an MCAP file as they come.
///
/// Rows handed to the system survive the end of the process, however it ends; [`super::super::load`] reads such a file
/// up to its last whole block, with a warning. If the disk refuses (it is full, for instance) the file is cut back to
/// its last whole block and takes no more. Memory: one block, and about a hundred bytes for every block written (15 MB
/// in 24 hours). Not for the servo: it allocates and writes.
pub struct McapStream {
    sink: Option<Sink>,
    /// The same file, to look at its length and to cut it.
    file: File,
    columns: usize,
    labelled: bool,
    flushed: Instant,
    pending: bool,
    first_s: f64,
    last_s: f64,
    rows: u64,
    /// Length up to the last whole block, bytes.
    whole: u64,
    path: PathBuf,
}

impl McapStream {
    /// Creates the file. `columns` are the channels beside the time, in the program's names and SI units; `attachments` for
    /// instance the world and the device.
    pub fn create(path: &Path, columns: &[String], meta: &Meta, attachments: &[Attachment]) -> Result<Self, LogError> {
        Self::create_as(path, columns, false, meta, attachments)
    }

    /// [`Self::create`] with a label for every row: [`Self::push_labelled`] appends to it.
    pub fn create_labelled(
        path: &Path,
        columns: &[String],
        meta: &Meta,
        attachments: &[Attachment],
    ) -> Result<Self, LogError> {
        Self::create_as(path, columns, true, meta, attachments)
    }

    fn create_as(
        path: &Path,
        columns: &[String],
        labelled: bool,
        meta: &Meta,
        attachments: &[Attachment],
    ) -> Result<Self, LogError> {
        let mut named = vec![("t_s".to_owned(), false)];
        named.extend(columns.iter().map(|c| (c.clone(), false)));
        named.extend(labelled.then(|| (LABEL.to_owned(), true)));
        for (index, (name, _)) in named.iter().enumerate() {
            if name.is_empty() || named[..index].iter().any(|(earlier, _)| earlier == name) {
                let why = format!("the column `{name}` comes twice or has no name");
                return Err(LogError::NotWritable { why, path: path.to_path_buf() });
            }
        }
        let failed = |e: McapError| failure(&e, path);
        let mut sink =
            Sink::create(path, &named, false, streamed(meta), (attachments, Encoding::Protobuf)).map_err(failed)?;
        sink.flush().map_err(failed)?;
        let file = OpenOptions::new().write(true).open(path).map_err(|e| refusal(&e, path))?;
        let whole = file.metadata().map_err(|e| refusal(&e, path))?.len();
        Ok(Self {
            sink: Some(sink),
            file,
            columns: columns.len(),
            labelled,
            flushed: Instant::now(),
            pending: false,
            first_s: 0.0,
            last_s: f64::NEG_INFINITY,
            rows: 0,
            whole,
            path: path.to_path_buf(),
        })
    }

    /// Appends the sample of time `t_s`, s; `values` in the order of the columns. Times must increase.
    pub fn push(&mut self, t_s: f64, values: &[f64]) -> Result<(), LogError> {
        self.append(t_s, values, None)
    }

    /// [`Self::push`] for a stream with labels.
    pub fn push_labelled(&mut self, t_s: f64, values: &[f64], label: &str) -> Result<(), LogError> {
        self.append(t_s, values, Some(label))
    }

    fn append(&mut self, t_s: f64, values: &[f64], label: Option<&str>) -> Result<(), LogError> {
        let refuse = |why: String| LogError::NotWritable { why, path: self.path.clone() };
        if values.len() != self.columns || label.is_some() != self.labelled {
            let (has, wants) = (values.len(), self.columns);
            return Err(refuse(format!(
                "a row has {has} values and the file {wants} columns, or one of them no label"
            )));
        }
        if !t_s.is_finite() || values.iter().any(|v| !v.is_finite()) {
            return Err(refuse(format!("a value at {t_s} s is not a finite number")));
        }
        if t_s <= self.last_s {
            return Err(refuse(format!("the time does not increase: {} s, then {t_s} s", self.last_s)));
        }
        let Some(sink) = &mut self.sink else { return Err(refuse("the disk has refused what came before".to_owned())) };
        if self.rows == 0 {
            self.first_s = t_s;
        }
        let log_time = ((t_s - self.first_s) * 1e9).round() as u64;
        let row = std::iter::once(t_s).chain(values.iter().copied()).map(Value::Number);
        if let Err(error) = sink.row(log_time, row.chain(label.map(Value::Text))) {
            return Err(self.give_up(&error));
        }
        self.last_s = t_s;
        self.rows += 1;
        self.pending = true;
        self.poll()
    }

    /// Hands rows to the system when it is time to. [`Self::push`] does that too: call this where rows may stop coming.
    pub fn poll(&mut self) -> Result<(), LogError> {
        if self.pending && self.flushed.elapsed() >= FLUSH_EVERY { self.flush() } else { Ok(()) }
    }

    /// Hands every row to the system now.
    pub fn flush(&mut self) -> Result<(), LogError> {
        let Some(sink) = &mut self.sink else { return Ok(()) };
        if let Err(error) = sink.flush() {
            return Err(self.give_up(&error));
        }
        self.whole = self.file.metadata().map_or(self.whole, |facts| facts.len());
        self.flushed = Instant::now();
        self.pending = false;
        Ok(())
    }

    /// Rows written so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Size on the disk up to the last whole block, bytes.
    pub fn bytes(&self) -> u64 {
        self.whole
    }

    /// Writes the end of the file. A stream that is dropped ends itself, without word of failures.
    pub fn finish(mut self) -> Result<(), LogError> {
        self.end(None)
    }

    /// [`Self::finish`] with facts that are known only now; they take the place of those of the beginning.
    pub fn finish_with(mut self, meta: &Meta) -> Result<(), LogError> {
        self.end(Some(meta))
    }

    fn end(&mut self, meta: Option<&Meta>) -> Result<(), LogError> {
        // First every row: should the end not fit on the disk, they do.
        self.flush()?;
        let Some(mut sink) = self.sink.take() else { return Ok(()) };
        let facts = meta.map_or(Ok(()), |meta| sink.metadata(streamed(meta)));
        facts.and_then(|()| sink.finish()).map_err(|error| self.give_up(&error))
    }

    /// Takes no more, and cuts off a half-written block: behind it a reader would take the file for damaged.
    fn give_up(&mut self, error: &McapError) -> LogError {
        // It tries to write its end, on a disk that may have room again.
        drop(self.sink.take());
        // If this fails too there is nothing left to try; readers then report the damage.
        let _ = self.file.set_len(self.whole);
        failure(error, &self.path)
    }
}

impl Drop for McapStream {
    fn drop(&mut self) {
        let _ = self.end(None); // nobody is left to be told
    }
}

/// The facts of a file that grows.
fn streamed(meta: &Meta) -> BTreeMap<String, String> {
    let mut metadata = metadata(&portable_meta(meta));
    metadata.insert(STREAMED.to_owned(), "true".to_owned());
    metadata
}

fn failure(error: &McapError, path: &Path) -> LogError {
    match error {
        McapError::Io(error) => refusal(error, path),
        other => LogError::Write { reason: records::one_line(other), path: path.to_path_buf() },
    }
}

fn refusal(error: &std::io::Error, path: &Path) -> LogError {
    LogError::Write { reason: error.to_string(), path: path.to_path_buf() }
}
