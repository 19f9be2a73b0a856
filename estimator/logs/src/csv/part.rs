//! One block of a table, parsed by itself: places count from its own start.

use super::calendar::{self, Days, Form};
use super::cells::{Cells, Notation, number, record_end};
use super::plain::{self, Plain};
use crate::fingerprint::{Marks, SEPARATOR, cell_hash};
use crate::plan::{Plan, Use};
use crate::raw::{MISSING, place_of};
use crate::written_units::{self, Written};
use haptics::recording::Labels;
use memchr::memchr;

/// Number of values of a selected column that are remembered for the sentence that nothing was selected.
const SEEN_VALUES: usize = 6;

/// Information for every block.
#[derive(Clone, Debug)]
pub struct Layout<'a> {
    /// Marks between and within numbers.
    pub notation: Notation,
    /// Cells in a row.
    pub width: usize,
    /// Names of the columns.
    pub headers: &'a [String],
    /// Use of each column.
    pub plan: &'a Plan,
    /// The plan's uses, less the columns that turned out to hold text.
    pub uses: Vec<Use>,
    /// True until the first selected row has shown which columns hold text.
    pub undecided: bool,
    /// In the block before; 0 before the first.
    pub bytes_a_row: usize,
    /// Ends of the cells of the block, if they are known beforehand.
    pub ends: Vec<u32>,
}

/// Fault of a record.
#[derive(Debug, PartialEq)]
pub enum Fault {
    /// Number of cells.
    Unequal(usize),
    /// Column, a sentence about the cell, and its text if that may stand for no measurement.
    Cell(usize, String, Option<String>),
    /// The record holds names of columns, other than those of the header.
    Names,
}

/// Rows one after the other that belong to one trial and follow each other line by line.
#[derive(Debug)]
pub struct Run {
    /// First of the block's kept rows.
    pub first: usize,
    /// The trial, when there is a column for it.
    pub trial: Option<Vec<u8>>,
    /// Row and line, counted from 0 at the start of the block.
    pub place: (usize, u64),
}

/// Content of a block.
#[derive(Debug)]
pub struct Part {
    /// One vector a column of the file; empty where it is not read.
    pub columns: Vec<Vec<f64>>,
    /// Labels of the kept rows.
    pub labels: Labels,
    /// Kept rows.
    pub kept: usize,
    /// All rows.
    pub rows: usize,
    /// Line ends.
    pub lines: u64,
    /// Bytes.
    pub bytes: usize,
    /// The kept rows, in runs.
    pub runs: Vec<Run>,
    /// For the fingerprints of all rows.
    pub marks: Marks,
    /// Values that `select` refused.
    pub seen: Vec<Vec<String>>,
    /// Columns found to hold text while undecided.
    pub text_columns: Vec<usize>,
    /// Columns with a cell without a value, or with no finite number if nobody needs it.
    pub gappy_columns: Vec<usize>,
    /// Order of day and month in the dates.
    pub days: Days,
    /// The first thing wrong, with its row and line counted from 0 here; the rows before it are complete.
    pub fault: Option<(usize, u64, Fault)>,
}

/// Parses a block into `columns`, which are empty.
pub fn parse(layout: &mut Layout<'_>, bytes: &[u8], columns: Vec<Vec<f64>>) -> Part {
    let mut reader = Reader::new(layout, bytes.len(), columns);
    reader.reserve();
    reader.find_ends(bytes);
    let mut at = 0;
    while at < bytes.len() && reader.part.fault.is_none() {
        at = reader.record(bytes, at);
    }
    reader.layout.bytes_a_row = bytes.len() / reader.part.rows.max(1);
    reader.part
}

/// True for a number with a unit behind it.
fn has_unit(cell: &[u8]) -> bool {
    let cell = String::from_utf8_lossy(cell);
    let is_of_number = |c: char| c.is_ascii_digit() || "+-.,eE".contains(c);
    let (number, unit) = cell.split_at(cell.find(|c| !is_of_number(c)).unwrap_or(cell.len()));
    number.contains(|c: char| c.is_ascii_digit()) && written_units::parse(unit, &[]) != Written::Unknown
}

struct Reader<'a, 'p> {
    layout: &'a mut Layout<'p>,
    part: Part,
    cells: Cells,
    /// No trial, selection or label: rows are read straight off the bytes.
    plain: bool,
    /// Numbers of the row being read.
    row: Vec<f64>,
}

impl<'a, 'p> Reader<'a, 'p> {
    fn new(layout: &'a mut Layout<'p>, bytes: usize, columns: Vec<Vec<f64>>) -> Self {
        let plan = layout.plan;
        let part = Part {
            columns,
            labels: Labels::default(),
            kept: 0,
            rows: 0,
            lines: 0,
            bytes,
            runs: Vec::new(),
            marks: Marks::default(),
            seen: vec![Vec::new(); plan.select.len()],
            text_columns: Vec::new(),
            gappy_columns: Vec::new(),
            days: Days::default(),
            fault: None,
        };
        let has_stamps = plan.uses.iter().any(|wanted| matches!(wanted, Use::Stamp { .. }));
        let is_whole = plan.trial.is_none() && plan.select.is_empty() && plan.label.is_none();
        let plain = is_whole && plan.watched.is_empty() && !has_stamps;
        Self { layout, part, cells: Cells::default(), plain, row: Vec::new() }
    }

    /// Room for as many rows as the last block promises.
    fn reserve(&mut self) {
        if self.layout.bytes_a_row == 0 {
            return;
        }
        let rows = self.part.bytes / self.layout.bytes_a_row + 8;
        for (wanted, target) in self.layout.uses.iter().zip(&mut self.part.columns) {
            if self.plain && matches!(wanted, Use::Number { .. }) {
                target.reserve_exact(rows.min(self.part.bytes));
            }
        }
    }

    /// Reads the plain rows at `at`, if any, and the record behind them; returns where the next one starts.
    fn record(&mut self, bytes: &[u8], at: usize) -> usize {
        let mut at = at;
        if self.plain && !self.layout.undecided {
            at = self.plain_rows(bytes, at);
            if at >= bytes.len() {
                return at;
            }
        }
        let end = record_end(bytes, at, self.layout.notation.delimiter).unwrap_or(bytes.len());
        let mut record = &bytes[at..end];
        let lines = if memchr(b'"', record).is_some() { memchr::memchr_iter(b'\n', record).count() as u64 } else { 0 };
        while let Some(shorter) = record.strip_suffix(b"\r") {
            record = shorter;
        }
        let delimiter = self.layout.notation.delimiter;
        let blank = record.iter().all(|&b| b.is_ascii_whitespace() && b != delimiter);
        if !blank && record.first() != Some(&b'#') {
            self.careful_row(record);
        }
        self.part.lines += lines + u64::from(end < bytes.len());
        end + 1
    }

    fn find_ends(&mut self, bytes: &[u8]) {
        self.layout.ends.clear();
        if self.plain {
            plain::find_ends(bytes, self.layout.notation.delimiter, &mut self.layout.ends);
        }
    }

    /// Reads the plain rows from `at` on; returns where the next one starts that is none.
    fn plain_rows(&mut self, bytes: &[u8], at: usize) -> usize {
        let (notation, uses, ends) = (self.layout.notation, &self.layout.uses, &self.layout.ends);
        let (rows, next) = Plain::new(notation, uses, &mut self.part.columns, ends).rows(bytes, at);
        if rows > 0 {
            self.keep(None);
            self.part.kept += rows;
            self.part.rows += rows;
            self.part.lines += rows as u64;
        }
        next
    }

    /// Starts a run where the row about to be kept does not simply follow the last one.
    fn keep(&mut self, trial: Option<&[u8]>) {
        let (row, line, kept) = (self.part.rows, self.part.lines, self.part.kept);
        let follows = self.part.runs.last().is_some_and(|run| {
            let behind = kept - run.first;
            run.place == (row.wrapping_sub(behind), line.wrapping_sub(behind as u64)) && run.trial.as_deref() == trial
        });
        if !follows {
            self.part.runs.push(Run { first: kept, trial: trial.map(<[u8]>::to_vec), place: (row, line) });
        }
    }

    fn careful_row(&mut self, record: &[u8]) {
        let mut cells = std::mem::take(&mut self.cells);
        cells.split(record, self.layout.notation.delimiter);
        // Every page, and every file that was appended, may begin with the names.
        if !self.repeats_header(record, &cells) {
            if let Err(fault) = self.take(record, &cells) {
                let is_text = |k: usize| {
                    let cell = cells.get(record, k);
                    !cell.is_empty() && number(cell, self.layout.notation).is_none() && !has_unit(cell)
                };
                let is_names = matches!(fault, Fault::Cell(..)) && cells.len() > 1 && (0..cells.len()).all(is_text);
                let fault = if is_names { Fault::Names } else { fault };
                self.part.fault = Some((self.part.rows, self.part.lines, fault));
            }
            self.part.rows += 1;
        }
        self.cells = cells;
    }

    fn repeats_header(&self, record: &[u8], cells: &Cells) -> bool {
        let headers = self.layout.headers;
        let is_name = |k: usize| {
            let cell = cells.get(record, k);
            let cell = cell.strip_prefix("\u{feff}".as_bytes()).unwrap_or(cell);
            cell == headers[k].as_bytes() || cell.is_empty() && place_of(&headers[k]) == Some(k)
        };
        let has_names = || (0..cells.len()).any(|k| !cells.get(record, k).is_empty());
        cells.len() == headers.len() && (0..headers.len()).all(is_name) && has_names()
    }

    fn take(&mut self, record: &[u8], cells: &Cells) -> Result<(), Fault> {
        if cells.len() != self.layout.width {
            return Err(Fault::Unequal(cells.len()));
        }
        self.mark(record, cells);
        if !self.selected(record, cells) {
            return Ok(());
        }
        self.row.clear();
        for column in 0..self.layout.width {
            match self.layout.uses[column] {
                Use::Number { required, factor } => self.cell(column, cells.get(record, column), required, factor)?,
                Use::Stamp { origin_ns, form } => {
                    let date = form.date.map_or(&b""[..], |date| cells.get(record, date));
                    self.stamp(column, (date, cells.get(record, column)), (origin_ns, form))?;
                }
                Use::Ignore => {}
            }
        }
        self.layout.undecided = false;
        self.keep(self.layout.plan.trial.map(|column| cells.get(record, column)));
        let mut values = self.row.iter();
        for (wanted, target) in self.layout.uses.iter().zip(&mut self.part.columns) {
            if *wanted != Use::Ignore
                && let Some(&value) = values.next()
            {
                target.push(value);
            }
        }
        if let Some(label) = self.layout.plan.label {
            self.part.labels.push(&String::from_utf8_lossy(cells.get(record, label)));
        }
        self.part.kept += 1;
        Ok(())
    }

    fn cell(&mut self, column: usize, cell: &[u8], required: bool, factor: f64) -> Result<(), Fault> {
        let value = number(cell, self.layout.notation);
        if let Some(value) = value.filter(|v| v.is_finite()) {
            self.row.push(value * factor);
            return Ok(());
        }
        if !required && self.layout.undecided && value.is_none() && !cell.is_empty() {
            // The first cell is text: a text column without a use.
            self.layout.uses[column] = Use::Ignore;
            self.part.text_columns.push(column);
            return Ok(());
        }
        let is_out = cell.is_empty() || self.layout.plan.is_missing(&String::from_utf8_lossy(cell));
        if is_out || !required {
            // The whole column decides whether that is a fault.
            let left_out =
                if is_out || value.is_some() { &mut self.part.gappy_columns } else { &mut self.part.text_columns };
            if !left_out.contains(&column) {
                left_out.push(column);
            }
            self.row.push(MISSING);
            return Ok(());
        }
        let shown = String::from_utf8_lossy(cell).chars().take(40).collect::<String>();
        let what = match value {
            Some(_) => format!("`{shown}` is not a finite number"),
            None if has_unit(cell) => format!("`{shown}` holds a unit, which belongs into the name of the column"),
            None => format!("`{shown}` is not a number"),
        };
        let is_word = !shown.contains(|c: char| c.is_ascii_digit()) || shown.contains('#');
        Err(Fault::Cell(column, what, is_word.then_some(shown)))
    }

    fn stamp(
        &mut self,
        column: usize,
        (date, time): (&[u8], &[u8]),
        (origin_ns, form): (i64, Form),
    ) -> Result<(), Fault> {
        let shown = String::from_utf8_lossy(&[date, b" ", time].concat()).trim_start().to_owned();
        let Some(ns) = form.read(&shown) else {
            let what = format!("`{}` is not a time like the others", shown.chars().take(40).collect::<String>());
            return Err(Fault::Cell(column, what, None));
        };
        self.part.days.look_at(form, &shown, calendar::is_another_day(ns, origin_ns));
        self.row.push(1e-9 * ns.saturating_sub(origin_ns) as f64);
        Ok(())
    }

    /// Leaves the marks for the comparison of trials.
    fn mark(&mut self, record: &[u8], cells: &Cells) {
        let plan = self.layout.plan;
        if plan.watched.is_empty() {
            return;
        }
        let key = plan.trial_keys.iter().map(|&k| cells.get(record, k)).collect::<Vec<_>>().join(SEPARATOR);
        match self.part.marks.keys.last_mut() {
            Some((last, rows)) if *last == key => *rows += 1,
            _ => self.part.marks.keys.push((key, 1)),
        }
        self.part.marks.hashes.extend(plan.watched.iter().map(|&c| cell_hash(cells.get(record, c))));
    }

    fn selected(&mut self, record: &[u8], cells: &Cells) -> bool {
        for (wanted, seen) in self.layout.plan.select.iter().zip(&mut self.part.seen) {
            let cell = cells.get(record, wanted.column);
            if !wanted.matches(cell) {
                if seen.len() < SEEN_VALUES {
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
}
