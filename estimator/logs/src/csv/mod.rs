//! Reading the text of a table: delimiter, header, cells to numbers, straight from the bytes.
//!
//! The file is cut into blocks of whole records ([`blocks`]); as many threads as there are cores parse them ([`part`]), and
//! the parts are put together in the order of the file ([`join`]). Rows, lines, sentences and bits do not depend on the
//! number of threads.

mod above;
#[cfg(target_arch = "x86_64")]
mod batch;
mod blocks;
pub mod calendar;
mod cells;
mod decimal;
mod dialect;
mod encoding;
mod join;
mod labview;
mod layout;
mod long_table;
mod part;
mod plain;
mod serial_log;
#[cfg(target_arch = "x86_64")]
mod simd;
mod sniff;
pub mod text_table;
mod twincat;
mod unit_cells;

use super::errors::LogError;
use super::plan::Plan;
use super::table::Table;
use super::watch::Watch;
use blocks::{BLOCK_BYTES, Blocks, Stop};
use dialect::Dialect;
use join::Join;
use part::{Layout, Part};
pub use sniff::sniff;
use std::fs::File;
use std::io::{Read, Seek as _, SeekFrom};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, TryLockError};

/// More threads gain nothing: the parts are joined one after the other.
const MAX_THREADS: usize = 8;
/// Parts that may wait for an earlier one before a thread pauses.
const MAX_WAITING: usize = 16;

/// Reads the whole table as `plan` says.
pub fn read(path: &Path, dialect: &Dialect, plan: &Plan, size: u64, watch: &Watch<'_>) -> Result<Table, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let length = dialect.end.map_or(u64::MAX, |end| end.saturating_sub(dialect.start));
    let cores = std::thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS);
    let threads = if size < 2 * BLOCK_BYTES as u64 { 1 } else { cores };
    let split = Split { threads, block_bytes: BLOCK_BYTES.min(size as usize + 1) };
    if let Some(text) = &dialect.text {
        let rest = text.get(dialect.start as usize..).unwrap_or_default().take(length);
        return Reading::new(rest, path, dialect, plan, size, *watch, split).run();
    }
    let mut file = File::open(path).map_err(io)?;
    file.seek(SeekFrom::Start(dialect.start)).map_err(io)?;
    Reading::new(file.take(length), path, dialect, plan, size, *watch, split).run()
}

/// Division of the work.
#[derive(Clone, Copy, Debug)]
struct Split {
    threads: usize,
    block_bytes: usize,
}

/// State shared by the threads.
struct Reading<'a, R> {
    blocks: Mutex<Blocks<R>>,
    /// Held by the thread that joins for all: a thread that finds it taken parses on.
    join: Mutex<Join<'a>>,
    parts: Mutex<Parts>,
    /// Told after parts were joined, and when the work stops.
    joined: Condvar,
    layout: Layout<'a>,
    path: &'a Path,
    size: u64,
    watch: Watch<'a>,
    split: Split,
    /// Set by the first thread that cannot go on.
    stop: AtomicBool,
    error: Mutex<Option<LogError>>,
    /// Why there are no more blocks.
    refused: Mutex<Option<Stop>>,
}

/// Parts on their way from the threads to the join, and their memory on its way back.
#[derive(Debug, Default)]
struct Parts {
    parsed: Vec<(usize, Part)>,
    /// Number of parts handed in that have not been joined.
    waiting: usize,
    /// Memory of columns that have been joined.
    spare: Vec<Vec<Vec<f64>>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Stops the other threads when one ends, also when it panics.
struct StopOnDrop<'a, 'r, R>(&'a Reading<'r, R>);

impl<R> Drop for StopOnDrop<'_, '_, R> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.stop();
        }
    }
}

impl<R> Reading<'_, R> {
    /// Stops all threads from taking another block.
    fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
        // Under the lock, so that no thread has looked at the flag and not yet begun to wait.
        let _parts = lock(&self.parts);
        self.joined.notify_all();
    }
}

impl<'a, R: Read + Send> Reading<'a, R> {
    fn new(
        source: R,
        path: &'a Path,
        dialect: &'a Dialect,
        plan: &'a Plan,
        size: u64,
        watch: Watch<'a>,
        split: Split,
    ) -> Self {
        let width = dialect.headers.len();
        let notation = dialect.notation;
        Self {
            blocks: Mutex::new(Blocks::new(source, notation.delimiter, split.block_bytes)),
            join: Mutex::new(Join::new(plan, dialect, path, size, watch.preview)),
            parts: Mutex::default(),
            joined: Condvar::new(),
            layout: Layout {
                notation,
                width,
                headers: &dialect.headers,
                plan,
                uses: plan.uses.clone(),
                undecided: true,
                bytes_a_row: 0,
                ends: Vec::new(),
            },
            path,
            size,
            watch,
            split,
            stop: AtomicBool::new(false),
            error: Mutex::new(None),
            refused: Mutex::new(None),
        }
    }

    fn run(mut self) -> Result<Table, LogError> {
        // The first selected row shows which columns hold text: until then one block after the other.
        let mut layout = self.layout.clone();
        while layout.undecided && self.step(&mut layout) {}
        self.layout = layout;
        let this = &self;
        std::thread::scope(|scope| {
            for _ in 1..this.split.threads {
                // A thread that cannot be had is no loss: this one works too.
                let _ = std::thread::Builder::new().name("csv".to_owned()).spawn_scoped(scope, || this.work());
            }
            this.work();
        });
        if let Some(error) = lock(&self.error).take() {
            return Err(error);
        }
        if let Some(stop) = lock(&self.refused).take() {
            return Err(self.refusal(stop));
        }
        self.join.into_inner().unwrap_or_else(PoisonError::into_inner).finish()
    }

    fn work(&self) {
        let _guard = StopOnDrop(self);
        let mut layout = self.layout.clone();
        while self.step(&mut layout) {}
    }

    /// Reads, parses and joins one block; false when there is nothing more to do.
    fn step(&self, layout: &mut Layout<'_>) -> bool {
        if self.watch.is_cancelled() {
            return self.end(LogError::Cancelled { path: self.path.to_path_buf() });
        }
        let mut parts = lock(&self.parts);
        while parts.waiting > MAX_WAITING && !self.stop.load(Ordering::Relaxed) {
            parts = self.joined.wait(parts).unwrap_or_else(PoisonError::into_inner);
        }
        let columns = parts.spare.pop().unwrap_or_else(|| vec![Vec::new(); layout.width]);
        drop(parts);
        if self.stop.load(Ordering::Relaxed) {
            return false;
        }
        let block = lock(&self.blocks).next();
        let (index, bytes) = match block {
            Ok(Some(block)) => block,
            Ok(None) => return false,
            Err(stop) => {
                // The blocks before it are still being parsed: a fault in one of them comes first.
                lock(&self.refused).get_or_insert(stop);
                return false;
            }
        };
        let part = part::parse(layout, &bytes, columns);
        lock(&self.blocks).recycle(bytes);
        let mut parts = lock(&self.parts);
        parts.parsed.push((index, part));
        parts.waiting += 1;
        drop(parts);
        match self.join_parsed() {
            Ok(()) => true,
            Err(error) => self.end(error),
        }
    }

    /// Joins the parsed parts, if no other thread is at it.
    fn join_parsed(&self) -> Result<(), LogError> {
        // Looked at again after the join is free: a part that comes in between found it taken.
        while !lock(&self.parts).parsed.is_empty() {
            let mut join = match self.join.try_lock() {
                Ok(join) => join,
                Err(TryLockError::Poisoned(join)) => join.into_inner(),
                Err(TryLockError::WouldBlock) => return Ok(()),
            };
            let parsed = std::mem::take(&mut lock(&self.parts).parsed);
            for (index, part) in parsed {
                let spare = join.take(index, part)?;
                let mut parts = lock(&self.parts);
                parts.waiting -= spare.len();
                parts.spare.extend(spare);
                self.joined.notify_all();
            }
            (self.watch.progress)((join.bytes as f64 / self.size.max(1) as f64).min(1.0));
        }
        Ok(())
    }

    /// The first error counts.
    fn end(&self, error: LogError) -> bool {
        lock(&self.error).get_or_insert(error);
        self.stop();
        false
    }

    fn refusal(&self, stop: Stop) -> LogError {
        let path = self.path.to_path_buf();
        match stop {
            Stop::Io(error) => LogError::Io { reason: error.to_string(), path },
            Stop::Endless(quoted) => {
                let why = if quoted { "a quote is opened and never closed" } else { "a line does not end" };
                LogError::NotATable { why: why.to_owned(), path }
            }
        }
    }
}

#[cfg(test)]
mod calendar_tests;
#[cfg(test)]
mod tests;
