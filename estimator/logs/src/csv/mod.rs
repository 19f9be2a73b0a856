//! Reading the text of a table: delimiter, header, cells to numbers, straight from the bytes.
//!
//! The file is cut into blocks of whole records ([`blocks`]); as many threads as there are cores parse them ([`part`]), and
//! the parts are put together in the order of the file ([`join`]). Rows, lines, sentences and bits do not depend on the
//! number of threads.

#[cfg(target_arch = "x86_64")]
mod batch;
mod blocks;
mod cells;
mod dialect;
mod encoding;
mod join;
mod labview;
mod layout;
mod part;
mod plain;
#[cfg(target_arch = "x86_64")]
mod simd;
pub mod stamps;

use super::errors::LogError;
use super::format;
use super::plan::Plan;
use super::table::Table;
use super::watch::Watch;
use blocks::{BLOCK_BYTES, Blocks, Stop};
use cells::{Cells, Decimal, Notation, number, record_end};
use dialect::Dialect;
use encoding::Encoding;
use join::Join;
use part::{Layout, Part};
use std::fs::File;
use std::io::{Read, Seek as _, SeekFrom};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError, TryLockError};

/// Number of bytes that are looked at to tell a table from something else.
const SNIFF_BYTES: usize = 1 << 16;
/// More threads gain nothing: the parts are joined one after the other.
const MAX_THREADS: usize = 8;
/// Parts that may wait for an earlier one before a thread pauses.
const MAX_WAITING: usize = 16;

/// Looks at the beginning and the end of a file; an error when it cannot be a table.
pub fn sniff(path: &Path) -> Result<Dialect, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut start = Vec::with_capacity(SNIFF_BYTES);
    File::open(path).map_err(io)?.take(SNIFF_BYTES as u64).read_to_end(&mut start).map_err(io)?;
    let (encoding, is_short) = (encoding::of(&start), start.len() < SNIFF_BYTES);
    let whole = |start: &[u8]| if is_short { Ok(start.to_vec()) } else { std::fs::read(path).map_err(io) };
    let mut notes = Vec::new();
    let mut text = None;
    if encoding != Encoding::Utf8 && format::foreign(&start).is_none() && !is_binary(&start, encoding) {
        text = Some(encoding::decoded(whole(&start)?, encoding));
        notes.extend((encoding == Encoding::Latin1).then(|| "the text is not UTF-8: it is read as Latin-1".to_owned()));
    }
    let beginning = |text: &[u8]| text[..text.len().min(SNIFF_BYTES)].to_vec();
    start = text.as_deref().map_or(start, beginning);
    if labview::is_measurement(&start) {
        let all = text.map_or_else(|| whole(&start), Ok)?;
        text = Some(labview::table(&all, path)?);
    } else if is_blank_separated(&start) {
        let all = text.map_or_else(|| whole(&start), Ok)?;
        text = Some(encoding::tabbed(&all));
    }
    start = text.as_deref().map_or(start, beginning);
    let mut found = dialect(&start, path)?;
    found.notes.splice(0..0, notes);
    found.leave_summary_out(path, text.as_deref()).map_err(io)?;
    found.text = text;
    Ok(found)
}

/// True for bytes that no text holds.
fn is_binary(start: &[u8], encoding: Encoding) -> bool {
    let is_control = |b: &u8| *b < 0x20 && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0c);
    !matches!(encoding, Encoding::Utf16(_)) && start.iter().any(is_control)
}

/// True for a text whose cells only blanks divide.
fn is_blank_separated(start: &[u8]) -> bool {
    let text = start.strip_prefix("\u{feff}".as_bytes()).unwrap_or(start);
    let lines = text.split(|b| *b == b'\n').filter(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"));
    let mut lines = lines.take(20).peekable();
    let has_blanks = |line: &[u8]| {
        line.trim_ascii().contains(&b' ') && !line.iter().any(|b| matches!(b, b'\t' | b';' | b',' | b'"'))
    };
    let widths = |line: &[u8]| line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count();
    let Some(width) = lines.peek().map(|line| widths(line)) else { return false };
    let mut last = text.len() == SNIFF_BYTES;
    lines.all(|line| {
        last = false;
        has_blanks(line) && widths(line) == width
    }) && !last
}

fn dialect(start: &[u8], path: &Path) -> Result<Dialect, LogError> {
    let not_a_table = |why: &str| LogError::NotATable { why: why.to_owned(), path: path.to_path_buf() };
    if let Some(what) = format::foreign(start) {
        return Err(not_a_table(what));
    }
    if start.contains(&0) {
        return Err(not_a_table("binary data"));
    }
    let text = start.strip_prefix("\u{feff}".as_bytes()).unwrap_or(start);
    if text.iter().all(u8::is_ascii_whitespace) {
        return Err(LogError::Empty { path: path.to_path_buf() });
    }
    let (mut at, mut line) = (0, 1);
    let mut stated = None;
    let header_line = loop {
        if at >= text.len() {
            return Err(LogError::HeaderOnly { path: path.to_path_buf() });
        }
        let end = memchr::memchr(b'\n', &text[at..]).map_or(text.len(), |n| at + n);
        let one = &text[at..end];
        stated = stated.or_else(|| stated_delimiter(one));
        if !one.starts_with(b"#") && !one.trim_ascii().is_empty() && stated_delimiter(one).is_none() {
            break one;
        }
        (at, line) = (end + 1, line + 1);
    };
    if let Some(found) = laid_out(&text[at..], stated, delimiter_of(header_line)) {
        let before = (start.len() - text.len() + at) as u64;
        return Ok(Dialect { start: before + found.start, line: line + found.line, ..found });
    }
    let notation =
        Notation { delimiter: stated.unwrap_or_else(|| delimiter_of(header_line)), decimal: Decimal::Either };
    // A quoted name may hold line ends.
    let end = record_end(text, at, notation.delimiter).unwrap_or(text.len());
    let header = &text[at..end];
    if header.len() >= SNIFF_BYTES - 3 {
        return Err(not_a_table("the first line has more than 64 KiB, too long for a header of column names"));
    }
    let headers = names(header, notation.delimiter);
    if headers.iter().all(|h| number(h.as_bytes(), notation).is_some()) {
        return Err(LogError::NoHeader { path: path.to_path_buf() });
    }
    if header.trim_ascii_end().contains(&b'\r') && !header.contains(&b'"') {
        return Err(not_a_table("its lines end with carriage returns only; save it with line feeds"));
    }
    let line = line + 1 + memchr::memchr_iter(b'\n', header).count() as u64;
    let decimal = if notation.delimiter == b',' { Decimal::Point } else { Decimal::Either };
    let start = (start.len() - text.len() + end + 1) as u64;
    Ok(Dialect { notation: Notation { decimal, ..notation }, headers, start, line, ..Dialect::default() })
}

/// The delimiter in a first line `sep=;`.
fn stated_delimiter(line: &[u8]) -> Option<u8> {
    let line = line.trim_ascii_end();
    let sign = line.strip_prefix(b"sep=").or_else(|| line.strip_prefix(b"SEP="))?;
    if let [one] = sign { Some(*one) } else { line.len().eq(&4).then_some(b'\t') }
}

/// Header, units and first row as the rows of numbers show them; places count from the start of `text`.
fn laid_out(text: &[u8], stated: Option<u8>, of_first_line: u8) -> Option<Dialect> {
    let candidates = match stated {
        Some(delimiter) => vec![delimiter],
        None => vec![of_first_line, b'\t', b';', b','],
    };
    candidates.into_iter().find_map(|delimiter| {
        let mut records = layout::records(text, delimiter, layout::LOOKED_AT);
        // The last record may have been cut off.
        if text.len() + 3 >= SNIFF_BYTES && records.last().is_some_and(|r| r.end == text.len()) {
            records.pop();
        }
        let cells = records.iter().flat_map(|r| r.cells.iter().map(String::as_str));
        let (decimal, grouped) = Decimal::of(cells, delimiter);
        let notation = Notation { delimiter, decimal };
        let found = layout::of(&records, notation).filter(|found| found.width > 1 || stated.is_some())?;
        let [header, first] = [found.header, found.first].map(|k| &records[k]);
        let mut headers = header.cells.clone();
        headers.truncate(found.width);
        let units = found.units.map_or_else(Vec::new, |k| records[k].cells.clone());
        let first_cells = first.cells.clone();
        let mut dialect = Dialect {
            notation,
            headers,
            units,
            first: first_cells,
            start: first.start as u64,
            line: first.line,
            body: found.body,
            ..Dialect::default()
        };
        dialect.note_decimals(grouped);
        if found.header > 0 {
            let lines = records[found.header].line;
            dialect.notes.push(format!("{lines} line(s) above the header are not read"));
        }
        Some(dialect)
    })
}

fn names(header: &[u8], delimiter: u8) -> Vec<String> {
    let mut cells = Cells::default();
    cells.split(header, delimiter);
    (0..cells.len()).map(|i| String::from_utf8_lossy(cells.get(header, i)).into_owned()).collect()
}

/// The most frequent of tab, semicolon and comma outside quotes.
fn delimiter_of(header: &[u8]) -> u8 {
    let mut quoted = false;
    let mut counts = [(b'\t', 0), (b';', 0), (b',', 0)];
    for &byte in header {
        quoted ^= byte == b'"';
        if let Some(entry) = counts.iter_mut().find(|(d, _)| *d == byte && !quoted) {
            entry.1 += 1;
        }
    }
    counts.into_iter().max_by_key(|&(_, n)| n).map_or(b',', |(d, _)| d)
}

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
mod tests;
