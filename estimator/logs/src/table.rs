//! The common intermediate of every format: rows by trial, column by column, with their places in the file.

use super::csv::calendar::Days;
use super::fingerprint::Fingerprints;
use haptics::recording::Labels;

/// Rows of one trial value, column by column.
#[derive(Debug, Default)]
pub struct Group {
    /// One vector for every column of the file; empty where the column is not read.
    pub columns: Vec<Vec<f64>>,
    /// Labels, when there is such a column.
    pub labels: Labels,
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
    /// Columns without a use that lack a value in some rows, left out too.
    pub gappy_columns: Vec<usize>,
    /// Needed columns that have values in some rows only: each has a clock of its own.
    pub sparse_columns: Vec<usize>,
    /// Sentences about rows that were left out.
    pub notes: Vec<String>,
    /// Order of day and month in the dates.
    pub days: Days,
    /// Contents of every trial, also of those not selected.
    pub fingerprints: Fingerprints,
}

impl Group {
    /// Rows whose places are still to be noted.
    pub fn new(columns: Vec<Vec<f64>>, labels: Labels) -> Self {
        Self { columns, labels, lines: Vec::new() }
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// Row in the file (from 1) and line (from 1; 0 where the format has no lines) of row `index` of the group.
    pub fn place(&self, index: usize) -> (usize, u64) {
        let at = self.lines.partition_point(|&(first, _, _)| first <= index).saturating_sub(1);
        self.lines.get(at).map_or((index + 1, 0), |&(first, line, row)| {
            (row + index - first, if line == 0 { 0 } else { line + (index - first) as u64 })
        })
    }

    /// Stretches of rows that stand one after the other in the file: first row of the group, line, and row in the file of each.
    pub fn stretches(&self) -> Vec<(usize, u64, usize)> {
        if self.lines.is_empty() { vec![(0, 0, 1)] } else { self.lines.clone() }
    }

    /// A copy of the rows `first..end`, with their places.
    pub fn rows_between(&self, first: usize, end: usize) -> Self {
        let part = |values: &Vec<f64>| values.get(first..end).map(<[f64]>::to_vec).unwrap_or_default();
        let mut labels = Labels::default();
        if !self.labels.is_empty() {
            labels.extend_from(&self.labels, first..end);
        }
        let mut made = Self::new(self.columns.iter().map(part).collect(), labels);
        let (row, line) = self.place(first);
        made.note_place(0, row, line);
        for &(index, line, row) in self.lines.iter().filter(|(index, ..)| (first + 1..end).contains(index)) {
            made.note_place(index - first, row, line);
        }
        made
    }

    /// The rows for which this holds, with their places.
    pub fn filtered(&self, is_kept: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.rows()).filter(|row| is_kept(*row)).collect();
        let part = |values: &Vec<f64>| kept.iter().filter_map(|row| values.get(*row)).copied().collect();
        let has_labels = !self.labels.is_empty();
        let labels = if has_labels { self.labels.gathered(kept.iter().copied()) } else { Labels::default() };
        let mut made = Self::new(self.columns.iter().map(part).collect(), labels);
        for (index, &old) in kept.iter().enumerate() {
            let (row, line) = self.place(old);
            made.note_place(index, row, line);
        }
        made
    }

    /// Takes the places of the rows from a group with the same rows.
    pub fn take_places(&mut self, of: &Self) {
        self.lines.clone_from(&of.lines);
    }

    /// Says where row `index` of the group stands in the file.
    pub fn note_place(&mut self, index: usize, row: usize, line: u64) {
        if self.lines.is_empty() || self.place(index) != (row, line) {
            self.lines.push((index, line, row));
        }
    }
}
