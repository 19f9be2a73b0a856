//! A recording that grows on the disk, block by block, and outlives the process that writes it.

use super::write::{Sink, metadata};
use super::{STREAMED, records};
use crate::log::errors::LogError;
use crate::log::write::{Attachment, Value, portable_meta};
use ::mcap::McapError;
use haptics::recording::Meta;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A block is ended and handed to the system at least this often while rows come, so that a killed process loses less than
/// a second.
const FLUSH_EVERY: Duration = Duration::from_millis(500);

/// Writes rows to an MCAP file as they come.
///
/// What was handed to the system survives the end of the process, however it ends; [`super::super::load`] reads such a file
/// up to its last whole block, with a warning. Memory: one block, and about a hundred bytes for every block written (15 MB
/// in 24 hours). Not for the servo: it allocates and writes.
pub struct McapStream {
    sink: Option<Sink>,
    columns: usize,
    flushed: Instant,
    pending: bool,
    first_s: f64,
    last_s: f64,
    rows: u64,
    path: PathBuf,
}

impl McapStream {
    /// Creates the file. `columns` are the channels beside the time, in the program's names and SI units; `attachments` for
    /// instance the world and the device.
    pub fn create(path: &Path, columns: &[String], meta: &Meta, attachments: &[Attachment]) -> Result<Self, LogError> {
        let mut named = vec![("t_s".to_owned(), false)];
        named.extend(columns.iter().map(|c| (c.clone(), false)));
        for (index, (name, _)) in named.iter().enumerate() {
            if name.is_empty() || named[..index].iter().any(|(earlier, _)| earlier == name) {
                let why = format!("the column `{name}` comes twice or has no name");
                return Err(LogError::NotWritable { why, path: path.to_path_buf() });
            }
        }
        let mut metadata = metadata(&portable_meta(meta));
        metadata.insert(STREAMED.to_owned(), "true".to_owned());
        let failed = |e: McapError| failure(&e, path);
        let mut sink = Sink::create(path, &named, false, metadata, attachments).map_err(failed)?;
        sink.flush().map_err(failed)?;
        Ok(Self {
            sink: Some(sink),
            columns: columns.len(),
            flushed: Instant::now(),
            pending: false,
            first_s: 0.0,
            last_s: f64::NEG_INFINITY,
            rows: 0,
            path: path.to_path_buf(),
        })
    }

    /// Appends the sample of time `t_s`, s; `values` in the order of the columns. Times must increase.
    pub fn push(&mut self, t_s: f64, values: &[f64]) -> Result<(), LogError> {
        let refuse = |why: String| LogError::NotWritable { why, path: self.path.clone() };
        if values.len() != self.columns {
            return Err(refuse(format!("a row has {} values and the file {} columns", values.len(), self.columns)));
        }
        if !t_s.is_finite() || values.iter().any(|v| !v.is_finite()) {
            return Err(refuse(format!("a value at {t_s} s is not a finite number")));
        }
        if t_s <= self.last_s {
            return Err(refuse(format!("the time does not increase: {} s, then {t_s} s", self.last_s)));
        }
        if self.rows == 0 {
            self.first_s = t_s;
        }
        let log_time = ((t_s - self.first_s) * 1e9).round() as u64;
        let row = std::iter::once(t_s).chain(values.iter().copied()).map(Value::Number);
        let Some(sink) = &mut self.sink else { return Ok(()) };
        sink.row(log_time, row).map_err(|e| failure(&e, &self.path))?;
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
        sink.flush().map_err(|e| failure(&e, &self.path))?;
        self.flushed = Instant::now();
        self.pending = false;
        Ok(())
    }

    /// Rows written so far.
    pub fn rows(&self) -> u64 {
        self.rows
    }

    /// Writes the end of the file. A stream that is dropped ends itself, without word of failures.
    pub fn finish(mut self) -> Result<(), LogError> {
        self.sink.take().map_or(Ok(()), |sink| sink.finish().map_err(|e| failure(&e, &self.path)))
    }
}

impl Drop for McapStream {
    fn drop(&mut self) {
        if let Some(sink) = self.sink.take() {
            let _ = sink.finish(); // nobody is left to be told
        }
    }
}

fn failure(error: &McapError, path: &Path) -> LogError {
    LogError::Write { reason: records::one_line(error), path: path.to_path_buf() }
}
