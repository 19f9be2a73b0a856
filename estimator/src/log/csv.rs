//! Reading the text of a table: delimiter, header, cells to numbers, straight from the bytes.

use super::errors::LogError;
use super::fingerprint::Fingerprints;
use super::plan::{Plan, Use};
use csv::{ByteRecord, ReaderBuilder};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, Read as _};
use std::path::{Path, PathBuf};

/// How many bytes are looked at to tell a table from something else.
const SNIFF_BYTES: usize = 1 << 16;

/// What the first bytes of a file say about it.
#[derive(Debug)]
pub struct Dialect {
    delimiter: u8,
    /// Column names as they stand in the file, trimmed.
    pub headers: Vec<String>,
    first_line_bytes: usize,
}

/// Rows of one trial value, column by column.
#[derive(Debug, Default)]
pub struct Group {
    /// One vector for every column of the file; empty where the column is not read.
    pub columns: Vec<Vec<f64>>,
    /// Labels, when there is such a column.
    pub labels: Vec<String>,
    /// Line in the file of every row, run-length coded: (first row index in the group, its line, its row in the file).
    lines: Vec<(usize, u64, usize)>,
}

/// A parsed table: groups in the order in which their trial value first appears.
#[derive(Debug, Default)]
pub struct Table {
    /// The rows, by trial.
    pub groups: Vec<(Option<String>, Group)>,
    /// Columns that hold text and were left out.
    pub text_columns: Vec<usize>,
    /// Contents of every trial, also of those not selected.
    pub fingerprints: Fingerprints,
}

impl Group {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// Row in the file (from 1) and line (from 1) of row `index` of the group.
    pub fn place(&self, index: usize) -> (usize, u64) {
        let at = self.lines.partition_point(|&(first, _, _)| first <= index).saturating_sub(1);
        self.lines
            .get(at)
            .map_or((index + 1, 0), |&(first, line, row)| (row + index - first, line + (index - first) as u64))
    }

    fn note_place(&mut self, index: usize, row: usize, line: u64) {
        if self.lines.is_empty() || self.place(index) != (row, line) {
            self.lines.push((index, line, row));
        }
    }
}

/// Looks at the beginning of a file; an error when it cannot be a table.
pub fn sniff(path: &Path) -> Result<Dialect, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut start = Vec::with_capacity(SNIFF_BYTES);
    File::open(path).map_err(io)?.take(SNIFF_BYTES as u64).read_to_end(&mut start).map_err(io)?;
    let not_a_table = |why: &str| LogError::NotATable { why: why.to_owned(), path: path.to_path_buf() };
    if start.starts_with(b"PAR1") || start.starts_with(b"\x89MCAP") {
        return Err(not_a_table("a Parquet or MCAP file, read here as text"));
    }
    if start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]) {
        return Err(not_a_table("UTF-16 text; save it as UTF-8"));
    }
    if start.contains(&0) {
        return Err(not_a_table("binary data"));
    }
    let text = start.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&start);
    if text.iter().all(u8::is_ascii_whitespace) {
        return Err(LogError::Empty { path: path.to_path_buf() });
    }
    let mut lines = text.split(|&b| b == b'\n').filter(|l| !l.starts_with(b"#") && !l.trim_ascii().is_empty());
    let Some(header) = lines.next() else { return Err(LogError::HeaderOnly { path: path.to_path_buf() }) };
    if header.len() == SNIFF_BYTES || std::str::from_utf8(header).is_err() {
        return Err(not_a_table("the first line is not a header of column names"));
    }
    let delimiter = delimiter_of(header);
    let mut reader = ReaderBuilder::new().delimiter(delimiter).has_headers(false).from_reader(header);
    let mut record = csv::StringRecord::new();
    reader.read_record(&mut record).map_err(|e| not_a_table(&e.to_string()))?;
    let headers: Vec<String> = record.iter().map(|h| h.trim().to_owned()).collect();
    if headers.iter().all(|h| number(h.as_bytes(), delimiter).is_some()) {
        return Err(LogError::NoHeader { path: path.to_path_buf() });
    }
    let first_line_bytes = lines.next().map_or(header.len(), <[u8]>::len) + 1;
    Ok(Dialect { delimiter, headers, first_line_bytes })
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

/// A number from the bytes of a cell; a decimal comma counts where the comma is not the delimiter. NaN and infinities come
/// back as such.
fn number(cell: &[u8], delimiter: u8) -> Option<f64> {
    let text = std::str::from_utf8(cell.trim_ascii()).ok()?;
    if let Ok(value) = text.parse() {
        return Some(value);
    }
    let decimal_comma = delimiter != b',' && text.contains(',') && !text.contains('.');
    if decimal_comma { text.replacen(',', ".", 1).parse().ok() } else { None }
}

/// What [`read`] carries from row to row.
struct Reading<'a> {
    plan: &'a Plan,
    dialect: &'a Dialect,
    path: &'a Path,
    expected_rows: usize,
    uses: Vec<Use>,
    table: Table,
    /// Trial value → index of its group.
    index: BTreeMap<Vec<u8>, usize>,
    last: Option<usize>,
    seen: Vec<Vec<String>>,
}

/// Reads the whole table as `plan` says.
pub fn read(path: &Path, dialect: &Dialect, plan: &Plan, size: u64) -> Result<Table, LogError> {
    let owned = || path.to_path_buf();
    let file = File::open(path).map_err(|e| LogError::Io { reason: e.to_string(), path: owned() })?;
    let mut reader = ReaderBuilder::new()
        .delimiter(dialect.delimiter)
        .comment(Some(b'#'))
        .has_headers(true)
        .flexible(true)
        .from_reader(BufReader::with_capacity(1 << 20, file));
    let mut reading = Reading {
        plan,
        dialect,
        path,
        expected_rows: if plan.trial.is_none() && plan.select.is_empty() {
            // Reserve no more than the size of the file, however short the first line is.
            let rows = size as usize / dialect.first_line_bytes.max(1) + 16;
            rows.min(size as usize / (8 * dialect.headers.len().max(1)) + 16)
        } else {
            0
        },
        uses: plan.uses.clone(),
        table: Table::default(),
        index: BTreeMap::new(),
        last: None,
        seen: vec![Vec::new(); plan.select.len()],
    };
    let mut record = ByteRecord::new();
    let mut row = 0;
    loop {
        match reader.read_byte_record(&mut record) {
            Ok(true) => row += 1,
            Ok(false) => break,
            Err(error) => return Err(LogError::Io { reason: error.to_string(), path: owned() }),
        }
        let line = record.position().map_or(0, csv::Position::line);
        reading.take(&record, row, line)?;
    }
    if row == 0 {
        return Err(LogError::HeaderOnly { path: owned() });
    }
    reading.finish()
}

impl Reading<'_> {
    fn owned(&self) -> PathBuf {
        self.path.to_path_buf()
    }

    fn take(&mut self, record: &ByteRecord, row: usize, line: u64) -> Result<(), LogError> {
        let expected = self.dialect.headers.len();
        if record.len() != expected {
            // A lone blank cell is an empty line with spaces in it.
            if record.len() == 1 && record[0].trim_ascii().is_empty() {
                return Ok(());
            }
            return Err(LogError::UnequalRow { row, line, found: record.len(), expected, path: self.owned() });
        }
        self.table.fingerprints.add(self.plan, record);
        if !self.selected(record) {
            return Ok(());
        }
        let group = self.group(record);
        let index = self.table.groups[group].1.rows();
        self.table.groups[group].1.note_place(index, row, line);
        for column in 0..expected {
            if let Use::Number { .. } = self.uses[column] {
                self.cell(group, column, &record[column], row, line)?;
            }
        }
        if let Some(label) = self.plan.label {
            let text = String::from_utf8_lossy(record[label].trim_ascii()).into_owned();
            self.table.groups[group].1.labels.push(text);
        }
        Ok(())
    }

    fn cell(&mut self, group: usize, column: usize, cell: &[u8], row: usize, line: u64) -> Result<(), LogError> {
        let Use::Number { required, factor } = self.uses[column] else { return Ok(()) };
        let target = &mut self.table.groups[group].1;
        let value = number(cell, self.dialect.delimiter);
        if let Some(value) = value.filter(|v| v.is_finite()) {
            target.columns[column].push(value * factor);
            return Ok(());
        }
        let untouched = self.table.groups.iter().all(|(_, g)| g.columns[column].is_empty());
        if !required && untouched && value.is_none() {
            // The first cell is text: a column of text that nobody asked for.
            self.uses[column] = Use::Ignore;
            self.table.text_columns.push(column);
            return Ok(());
        }
        let shown = String::from_utf8_lossy(cell.trim_ascii()).chars().take(40).collect::<String>();
        let what = match value {
            Some(_) => format!("`{shown}` is not a finite number"),
            None if shown.is_empty() => "the cell is empty".to_owned(),
            None => format!("`{shown}` is not a number"),
        };
        Err(LogError::BadCell { row, line, column: self.dialect.headers[column].clone(), what, path: self.owned() })
    }

    fn selected(&mut self, record: &ByteRecord) -> bool {
        for (wanted, seen) in self.plan.select.iter().zip(&mut self.seen) {
            let cell = record[wanted.column].trim_ascii();
            if !wanted.matches(cell) {
                if seen.len() < 6 {
                    let text = String::from_utf8_lossy(cell).into_owned();
                    if !seen.contains(&text) {
                        seen.push(text);
                    }
                }
                return false;
            }
        }
        true
    }

    fn group(&mut self, record: &ByteRecord) -> usize {
        let key = self.plan.trial.map(|column| record[column].trim_ascii());
        let Some(key) = key else {
            if self.table.groups.is_empty() {
                self.new_group(None);
            }
            return 0;
        };
        if let Some(last) = self.last.filter(|&l| self.table.groups[l].0.as_deref().map(str::as_bytes) == Some(key)) {
            return last;
        }
        let found = self.index.get(key).copied();
        let group = found.unwrap_or_else(|| {
            self.index.insert(key.to_vec(), self.table.groups.len());
            self.new_group(Some(String::from_utf8_lossy(key).into_owned()))
        });
        self.last = Some(group);
        group
    }

    fn new_group(&mut self, trial: Option<String>) -> usize {
        let column =
            |u: &Use| if matches!(u, Use::Number { .. }) { Vec::with_capacity(self.expected_rows) } else { Vec::new() };
        let columns = self.uses.iter().map(column).collect();
        self.table.groups.push((trial, Group { columns, ..Group::default() }));
        self.table.groups.len() - 1
    }

    fn finish(self) -> Result<Table, LogError> {
        if self.table.groups.is_empty() {
            let at = self.seen.iter().position(|s| !s.is_empty()).unwrap_or(0);
            let wanted = &self.plan.select[at];
            return Err(LogError::NothingSelected {
                column: self.dialect.headers[wanted.column].clone(),
                wanted: wanted.text.clone(),
                present: if self.seen[at].is_empty() {
                    "no rows".to_owned()
                } else {
                    let list = self.seen[at].join(", ");
                    if self.seen[at].len() < 6 { list } else { list + ", …" }
                },
                path: self.path.to_path_buf(),
            });
        }
        Ok(self.table)
    }
}
