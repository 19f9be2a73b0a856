//! Place of the header and the first row: the rows of numbers decide.
//!
//! Exports have facts above the header, a row of units below it, and a summary behind the last row. The header is the
//! last line of the table's width above the first row of numbers, unless that one holds nothing but units.

use super::cells::{Cells, Notation, number, record_end};
use super::{calendar, encoding};
use crate::written_units::{self, Written};

/// Records at the start of a file that are looked at.
pub const LOOKED_AT: usize = 400;
/// Share of the rows that hold numbers in a column of numbers.
const MOSTLY: f64 = 0.9;
/// Most records of a summary behind the table.
const SUMMARY: usize = 50;

/// One record of the text.
#[derive(Debug)]
pub struct Record {
    /// Start and end, bytes.
    pub start: usize,
    pub end: usize,
    /// Line, counted from 0 at the start of the text.
    pub line: u64,
    pub cells: Vec<String>,
}

/// The records of a text, without blank lines and comments.
pub fn records(text: &[u8], delimiter: u8, most: usize) -> Vec<Record> {
    let (mut found, mut at, mut line) = (Vec::new(), 0, 0);
    let mut cells = Cells::default();
    while at < text.len() && found.len() < most {
        let end = record_end(text, at, delimiter).unwrap_or(text.len());
        let record = &text[at..end];
        let record = record.strip_suffix(b"\r").unwrap_or(record);
        if !record.trim_ascii().is_empty() && record.first() != Some(&b'#') && !is_rule(record) {
            cells.split(record, delimiter);
            let cells = (0..cells.len()).map(|i| String::from_utf8_lossy(cells.get(record, i)).into_owned()).collect();
            found.push(Record { start: at, end, line, cells });
        }
        line += 1 + memchr::memchr_iter(b'\n', record).count() as u64;
        at = end + 1;
    }
    found
}

/// True for a line that a person drew below the names.
fn is_rule(record: &[u8]) -> bool {
    record.iter().all(|b| matches!(b, b'-' | b'=' | b'|' | b'+' | b':' | b' ' | b'\t')) && record.contains(&b'-')
}

/// Columns of numbers and of times of a table.
#[derive(Debug, Default)]
pub struct Body {
    width: usize,
    numeric: Vec<usize>,
    times: Vec<usize>,
}

impl Body {
    /// The body that most of the later records have in common; `None` without numbers.
    fn of(records: &[Record], notation: Notation) -> Option<Self> {
        let later = &records[records.len() / 2..];
        let mut widths: Vec<usize> = later.iter().map(|r| r.cells.len()).collect();
        widths.sort_unstable();
        let width = *widths.chunk_by(|a, b| a == b).max_by_key(|run| run.len())?.first()?;
        let rows: Vec<&Record> = later.iter().filter(|r| r.cells.len() == width).collect();
        let holds = |c: &usize| {
            let numbers = rows.iter().filter(|r| is_number(&r.cells[*c], notation)).count();
            let blanks = rows.iter().filter(|r| r.cells[*c].is_empty()).count();
            numbers > 0 && (numbers + blanks) as f64 >= MOSTLY * rows.len() as f64
        };
        let numeric: Vec<usize> = (0..width).filter(holds).collect();
        let has_times = |c: &usize| !numeric.contains(c) && rows.iter().all(|r| is_time(&r.cells[*c]));
        let times = (0..width).filter(has_times).collect();
        (!numeric.is_empty()).then_some(Self { width, numeric, times })
    }

    /// False if most rows have no number and no time in a column.
    pub fn holds_values(&self, column: usize) -> bool {
        self.width == 0 || self.numeric.contains(&column) || self.times.contains(&column)
    }

    /// Share of the columns that hold numbers or times.
    pub fn share(&self) -> f64 {
        (self.numeric.len() + self.times.len()) as f64 / self.width.max(1) as f64
    }

    /// True for a record with numbers in more than half of the columns of numbers.
    fn is_row(&self, record: &Record, notation: Notation) -> bool {
        let cells = &record.cells;
        cells.len() == self.width
            && 2 * self.numbers(record, notation) > self.numeric.len()
            && self.numeric.iter().any(|c| is_number(&cells[*c], notation))
    }

    /// The text with which a record begins in a column of numbers or times.
    fn label<'a>(&self, record: &'a Record, notation: Notation) -> Option<&'a str> {
        let (at, cell) = record.cells.iter().enumerate().find(|(_, cell)| !cell.is_empty())?;
        let has_values = self.numeric.contains(&at) || self.times.contains(&at);
        (has_values && !is_number(cell, notation) && !is_time(cell)).then_some(cell)
    }

    /// Number of the columns of numbers in which a record has one, or a blank.
    fn numbers(&self, record: &Record, notation: Notation) -> usize {
        let fits = |c: &&usize| record.cells.get(**c).is_some_and(|cell| cell.is_empty() || is_number(cell, notation));
        self.numeric.iter().filter(fits).count()
    }
}

fn is_number(cell: &str, notation: Notation) -> bool {
    number(cell.as_bytes(), notation).is_some()
}

fn is_time(cell: &str) -> bool {
    calendar::parse(cell).is_some() || calendar::is_date(cell)
}

/// Header and first row among the records.
#[derive(Debug)]
pub struct Layout {
    /// Names of the columns; empty for a column without one.
    pub names: Vec<String>,
    /// Index of the header; none if it is a comment.
    pub header: Option<usize>,
    /// Index of the row of units: below the header, or above it.
    pub units: Option<usize>,
    /// Index of the first row.
    pub first: usize,
    /// Number of columns.
    pub width: usize,
    pub body: Body,
}

/// Layout of the records at the start of a file; `None` if they show none. Then the first record is the header.
pub fn of(records: &[Record], notation: Notation) -> Option<Layout> {
    let body = Body::of(records, notation)?;
    let width = body.width;
    let is_row = |k: usize| records.get(k).is_none_or(|r| body.is_row(r, notation));
    // A fact above the names may have a number for every column but the first.
    let is_whole = |k: usize| records.get(k).is_none_or(|r| body.numbers(r, notation) == body.numeric.len());
    let first = (1..records.len()).find(|&k| is_row(k) && is_row(k + 1) && (is_whole(k) || is_whole(k + 1)))?;
    // A delimiter behind the last cell of every row, but not behind the last name; or numbers of rows, without a name.
    let ends_blank = records[first..].iter().take(2).all(|r| r.cells.last().is_some_and(String::is_empty));
    let may_lack_one = ends_blank || counts_rows(&records[first..], notation);
    let may_be_names = |k: usize| {
        let cells = &records[k].cells;
        let is_wide = cells.len() == width || is_one_more(cells, width) || may_lack_one && cells.len() + 1 == width;
        let numbers = cells.iter().filter(|cell| is_number(cell, notation)).count();
        is_wide && (numbers == 0 || k == 0 && numbers < cells.len())
    };
    let (header, units) = if records[0].cells.first().is_some_and(|cell| cell == "TOA5") && first == 4 {
        // Campbell Scientific: a station, names, units, and the kind of each value.
        (1, Some(2))
    } else if let Some(units) = units_below_names(records, first, may_be_names) {
        (units - 1, Some(units))
    } else {
        let is_above = first > 1 && records[first - 2].cells.len() == width && holds_units(&records[first - 2].cells);
        (first - 1, is_above.then(|| first - 2))
    };
    // Names in the first line belong to the row below them, whatever its fault is.
    let (header, first) = if may_be_names(header) { (header, first) } else { (0, 1) };
    let mut names = records[header].cells.clone();
    if let Some(name) = names[0].strip_prefix("% ") {
        names[0] = name.trim_start().into();
    }
    if names.len() + 1 == width && !ends_blank {
        names.insert(0, String::new());
    }
    names.resize(width, String::new());
    may_be_names(header).then_some(Layout { names, header: Some(header), units, first, width, body })
}

/// Index of a row of units right below names, perhaps with a row of remarks between it and the first row.
fn units_below_names(records: &[Record], first: usize, may_be_names: impl Fn(usize) -> bool) -> Option<usize> {
    let is_complete = |k: usize| {
        let cells = &records[k].cells;
        cells.iter().enumerate().all(|(at, cell)| !cell.is_empty() && !cells[..at].contains(cell))
    };
    let holds = |k: usize| k > 0 && holds_units(&records[k].cells) && may_be_names(k - 1);
    let above_remarks = || first.checked_sub(2).filter(|&k| holds(k) && is_complete(k - 1) && may_be_names(k + 1));
    // One unit that is not known makes no name of the others.
    let most = |k: usize| {
        k > 0
            && states_units(&records[k].cells)
            && may_be_names(k - 1)
            && is_complete(k - 1)
            && !states_units(&records[k - 1].cells)
    };
    Some(first - 1).filter(|&k| holds(k) || most(k)).or_else(above_remarks)
}

/// Layout of rows without names above them; `None` if the first record is no row.
pub fn without_names(records: &[Record], notation: Notation) -> Option<Layout> {
    let body = Body::of(records, notation)?;
    let are_rows = records.iter().take(2).all(|record| body.is_row(record, notation));
    let names = vec![String::new(); body.width];
    are_rows.then_some(Layout { names, header: None, units: None, first: 0, width: body.width, body })
}

/// Layout of rows below a comment with their names, as `NumPy` writes them.
pub fn below_comment(records: &[Record], comments: &[u8], notation: Notation) -> Option<Layout> {
    let body = Body::of(records, notation)?;
    let is_row = |k: usize| records.get(k).is_some_and(|r| body.is_row(r, notation));
    if !is_row(0) || !is_row(1) {
        return None;
    }
    let mut lines = comments.rsplit(|b| *b == b'\n').filter_map(|line| line.trim_ascii().strip_prefix(b"#"));
    let names = lines.find_map(|line| {
        let mut cells = Cells::default();
        cells.split(line, notation.delimiter);
        let divided: Vec<&[u8]> = (0..cells.len()).map(|k| cells.get(line, k)).collect();
        let names = if divided.len() == body.width { divided } else { encoding::cells(line, body.width) };
        let names = names.iter().map(|name| String::from_utf8_lossy(name).into_owned()).collect::<Vec<_>>();
        let is_text = names.iter().all(|name| !is_number(name, notation));
        (names.len() == body.width && is_text).then_some(names)
    })?;
    Some(Layout { names, header: None, units: None, first: 0, width: body.width, body })
}

/// True if the first cells of these rows count them from 0 or 1 on.
fn counts_rows(rows: &[Record], notation: Notation) -> bool {
    let number = |k: usize| number(rows.get(k)?.cells.first()?.as_bytes(), notation);
    matches!((number(0), number(1)), (Some(a), Some(b)) if (a == 0.0 || a == 1.0) && b - a == 1.0)
}

/// True for a header with a last name above no cells, as LabVIEW's `Comment`.
fn is_one_more(cells: &[String], width: usize) -> bool {
    cells.len() == width + 1 && cells.last().is_some_and(|name| name.is_empty() || name == "Comment")
}

/// True for a row of units: each text is a unit or stands in brackets.
fn holds_units(cells: &[String]) -> bool {
    let bracketed =
        |cell: &str| [('[', ']'), ('(', ')')].iter().any(|(a, b)| cell.starts_with(*a) && cell.ends_with(*b));
    let is_unit = |cell: &str| bracketed(cell) || written_units::parse(cell, &[]) != Written::Unknown;
    let mut texts = cells.iter().filter(|cell| !cell.is_empty() && cell.as_str() != "-").peekable();
    texts.peek().is_some() && texts.all(|cell| is_unit(cell))
}

/// True if half of the texts or more are known units.
fn states_units(cells: &[String]) -> bool {
    let texts: Vec<&String> = cells.iter().filter(|cell| !cell.is_empty()).collect();
    let known = texts.iter().filter(|cell| matches!(written_units::parse(cell, &[]), Written::Known(..))).count();
    known > 0 && 2 * known >= texts.len()
}

/// True for a record whose first text begins with a word.
pub fn begins_with_word(record: &Record) -> bool {
    let text = record.cells.iter().find(|cell| !cell.is_empty()).map_or("", String::as_str);
    text.chars().take(2).filter(|c| c.is_alphabetic()).count() == 2
}

/// Start of a summary behind the last row, bytes, and its number of records: text that begins where numbers stood, such as
/// `End of test` and `Mean,0.1,2.5`.
/// `tail`: the last bytes of the file, from a line's start on.
pub fn summary(tail: &[u8], body: &Body, notation: Notation) -> Option<(usize, usize)> {
    let records = records(tail, notation.delimiter, usize::MAX);
    // Numbers of a summary stand behind a word for them; a row with a fault has none.
    let is_summary = |record: &Record| body.label(record, notation).is_some() && begins_with_word(record);
    let last = records.iter().rposition(|r| body.is_row(r, notation) && !is_summary(r))?;
    let behind = &records[last + 1..];
    let named = behind.iter().filter(|r| body.is_row(r, notation));
    let names: Vec<&str> = named.filter_map(|r| body.label(r, notation)).collect();
    let is_repeated = names.iter().enumerate().any(|(at, name)| names[..at].contains(name));
    let is_text = body.label(behind.first()?, notation).is_some() && !is_repeated;
    (is_text && behind.len() <= SUMMARY).then(|| (records[last].end + 1, behind.len()))
}
