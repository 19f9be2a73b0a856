//! Notation and layout of a table of text.

use super::cells::Notation;
use super::decimal::Decimal;
use super::layout::{self, Body};
use crate::raw::name_by_place;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::Path;

/// Number of bytes at the end of a file in which a summary may stand.
const TAIL_BYTES: u64 = 1 << 14;

/// Properties of a file told by its first bytes and its last.
#[derive(Debug, Default)]
pub struct Dialect {
    pub(super) notation: Notation,
    /// Column names as they stand in the file, trimmed.
    pub headers: Vec<String>,
    /// Texts of the columns' units in a row below the names; empty without such a row.
    pub units: Vec<String>,
    /// Cells of the first row.
    pub first: Vec<String>,
    /// Start of the first row, bytes.
    pub(super) start: u64,
    /// Line of the first row, from 1.
    pub(super) line: u64,
    /// End of the last row, bytes; `None` for the end of the file.
    pub(super) end: Option<u64>,
    /// Columns of numbers.
    pub(super) body: Body,
    /// The file as UTF-8 with one delimiter, if it is not written so itself.
    pub(super) text: Option<Vec<u8>>,
    /// Columns with a clock of their own, and the columns of those clocks.
    pub clocks: Vec<(usize, usize)>,
    /// True if it was a long table: any signal may lack a value at some times.
    pub(super) is_long: bool,
    /// Sentences for the reader.
    pub notes: Vec<String>,
    /// Line before the rows that states their rate, and the rate, Hz.
    pub rate: Option<(String, f64)>,
}

impl Dialect {
    /// Names the columns that stand below no name.
    pub(super) fn name_columns(&mut self) {
        for (column, name) in self.headers.iter_mut().enumerate() {
            if name.is_empty() && self.first.get(column).is_some_and(|cell| !cell.is_empty()) {
                *name = name_by_place(column);
            }
        }
    }

    /// Says how the decimal marks were understood, where it is not obvious.
    pub(super) fn note_decimals(&mut self, grouped: bool) {
        let note = match self.notation.decimal {
            Decimal::Comma if grouped => "points between digits stand between thousands",
            Decimal::Point if grouped => "commas between digits stand between thousands",
            Decimal::Either if grouped => {
                "the file has decimal commas and decimal points: both are taken as decimal marks"
            }
            _ => return,
        };
        self.notes.push(note.to_owned());
    }

    /// Ends the table before a summary behind its last row.
    pub(super) fn leave_summary_out(&mut self, path: &Path, text: Option<&[u8]>) -> std::io::Result<()> {
        let mut file = Vec::new();
        let (tail, at) = if let Some(text) = text {
            let at = text.len().saturating_sub(TAIL_BYTES as usize);
            (&text[at..], at as u64)
        } else {
            let mut source = File::open(path)?;
            let at = source.seek(SeekFrom::End(0))?.saturating_sub(TAIL_BYTES);
            source.seek(SeekFrom::Start(at))?;
            source.take(TAIL_BYTES).read_to_end(&mut file)?;
            (file.as_slice(), at)
        };
        // From the first whole line on, and not before the rows.
        let whole = if at > 0 { memchr::memchr(b'\n', tail).map_or(tail.len(), |end| end + 1) } else { 0 };
        let from = whole.max(self.start.saturating_sub(at) as usize).min(tail.len());
        if let Some((end, records)) = layout::summary(&tail[from..], &self.body, self.notation) {
            self.end = Some(at + (from + end) as u64);
            self.notes.push(format!("{records} line(s) of text behind the last row are not read"));
        }
        Ok(())
    }
}
