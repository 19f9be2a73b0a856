//! Parts of a table put together in the order of the file.

use super::dialect::Dialect;
use super::part::{Fault, Part};
use crate::errors::{CORRECT_CELL, LogError, MAP_ANOTHER, WRITE_TIMES};
use crate::pages;
use crate::plan::{Plan, Use};
use crate::preview::Preview;
use crate::raw::is_missing;
use crate::suggested::entry;
use crate::table::{Group, Table};
use serde_json::json;
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Number of values of a selected column that a sentence lists.
const SHOWN_VALUES: usize = 6;

/// Fewer values than this are no samples of a slower clock.
const LEAST_VALUES: usize = 8;

/// Meaning of cells without a value.
enum Blanks {
    /// The column has a clock of its own, or no such cell.
    OfASlowerClock,
    /// Samples were lost.
    Few,
    /// The table is faulty.
    Faulty,
}

/// Takes parts in any order and keeps those that are early.
#[derive(Debug)]
pub struct Join<'a> {
    /// The joined table.
    pub table: Table,
    /// Bytes joined.
    pub bytes: usize,
    plan: &'a Plan,
    dialect: &'a Dialect,
    path: &'a Path,
    size: u64,
    preview: Option<&'a Preview>,
    early: BTreeMap<usize, Part>,
    next: usize,
    rows: usize,
    lines: u64,
    /// Trial → its group.
    index: HashMap<Vec<u8>, usize>,
    seen: Vec<Vec<String>>,
}

impl<'a> Join<'a> {
    /// Nothing joined yet; `size` of the file in bytes, to reserve room.
    pub fn new(plan: &'a Plan, dialect: &'a Dialect, path: &'a Path, size: u64, preview: Option<&'a Preview>) -> Self {
        Self {
            table: Table::default(),
            bytes: 0,
            plan,
            dialect,
            path,
            size,
            preview,
            early: BTreeMap::new(),
            next: 0,
            rows: 0,
            lines: 0,
            index: HashMap::new(),
            seen: vec![Vec::new(); plan.select.len()],
        }
    }

    /// Takes the part of block `index`, and joins all parts whose turn has come; an error for the first row that is
    /// wrong. Returns the columns of the joined parts, emptied.
    pub fn take(&mut self, index: usize, part: Part) -> Result<Vec<Vec<Vec<f64>>>, LogError> {
        self.early.insert(index, part);
        let mut spare = Vec::new();
        while let Some(part) = self.early.remove(&self.next) {
            self.next += 1;
            spare.push(self.join(part)?);
        }
        Ok(spare)
    }

    fn join(&mut self, mut part: Part) -> Result<Vec<Vec<f64>>, LogError> {
        let table = &mut self.table;
        for (all, new) in
            [(&mut table.text_columns, &part.text_columns), (&mut table.gappy_columns, &part.gappy_columns)]
        {
            for column in new {
                all.extend((!all.contains(column)).then_some(*column));
            }
        }
        self.table.days.is_open |= part.days.is_open;
        self.table.days.is_settled |= part.days.is_settled;
        self.table.fingerprints.extend(self.plan.watched.len(), &part.marks);
        for (all, seen) in self.seen.iter_mut().zip(&part.seen) {
            for text in seen {
                if all.len() < SHOWN_VALUES && !all.contains(text) {
                    all.push(text.clone());
                }
            }
        }
        for (i, run) in part.runs.iter().enumerate() {
            let end = part.runs.get(i + 1).map_or(part.kept, |next| next.first);
            let at = self.group(run.trial.as_deref(), part.kept, part.bytes);
            let group = &mut self.table.groups[at].1;
            let (row, line) = (self.rows + run.place.0 + 1, self.dialect.line + self.lines + run.place.1);
            group.note_place(group.rows(), row, line);
            for (target, source) in group.columns.iter_mut().zip(&part.columns) {
                if !source.is_empty() {
                    target.extend_from_slice(&source[run.first..end]);
                }
            }
            if self.plan.label.is_some() {
                group.labels.extend_from(&part.labels, run.first..end);
            }
        }
        self.show();
        if let Some((row, line, fault)) = part.fault {
            return Err(self.sentence(self.rows + row + 1, self.dialect.line + self.lines + line, fault));
        }
        self.rows += part.rows;
        self.lines += part.lines;
        self.bytes += part.bytes;
        part.columns.iter_mut().for_each(Vec::clear);
        Ok(part.columns)
    }

    /// Shows the joined rows, of tables with one recording.
    fn show(&self) {
        let (Some(preview), [(_, group)], None) = (self.preview, self.table.groups.as_slice(), self.plan.trial) else {
            return;
        };
        let time = self.plan.time.and_then(|c| group.columns.get(c)).map_or(&[][..], Vec::as_slice);
        let shown = self.plan.targets.iter().filter(|t| Some(t.column) != self.plan.time);
        preview.grow("", 0, time, shown.map(|t| (t.name.as_str(), group.columns[t.column].as_slice())));
    }

    fn group(&mut self, trial: Option<&[u8]>, rows: usize, bytes: usize) -> usize {
        let key = trial.unwrap_or_default();
        if let Some(&found) = self.index.get(key) {
            return found;
        }
        let mut group = Group::default();
        group.columns = vec![Vec::new(); self.plan.uses.len()];
        if self.plan.trial.is_none() && self.plan.select.is_empty() {
            // One table: as many rows as the first block promises, and no more than the file can hold.
            let widths = self.dialect.headers.len().max(1) as u64;
            let expected = self.size * rows as u64 / bytes.max(1) as u64 * 101 / 100 + 16;
            let room = expected.min(self.size / (2 * widths) + 16) as usize;
            for (target, wanted) in group.columns.iter_mut().zip(&self.plan.uses) {
                if *wanted != Use::Ignore {
                    pages::reserve_exact(target, room);
                }
            }
        }
        self.index.insert(key.to_vec(), self.table.groups.len());
        self.table.groups.push((trial.map(|t| String::from_utf8_lossy(t).into_owned()), group));
        self.table.groups.len() - 1
    }

    fn sentence(&self, row: usize, line: u64, fault: Fault) -> LogError {
        let path = self.path.to_path_buf();
        match fault {
            Fault::Unequal(found) => {
                LogError::UnequalRow { row, line, found, expected: self.dialect.headers.len(), path }
            }
            Fault::Names => {
                let mut read = self.table.groups.iter().flat_map(|(_, group)| &group.columns).flatten();
                let has_rows = read.any(|value| value.is_finite());
                if has_rows {
                    LogError::SecondTable { row, line, path }
                } else {
                    LogError::NoNumbers { row, line, path }
                }
            }
            Fault::Cell(column, what, word) => {
                let advice = match () {
                    () if self.dialect.body.holds_values(column) => CORRECT_CELL,
                    () if Some(column) == self.plan.time => WRITE_TIMES,
                    () => MAP_ANOTHER,
                };
                let is_time = Some(column) == self.plan.time;
                let mend = word
                    .filter(|_| advice == CORRECT_CELL && !is_time)
                    .map(|word| Box::new(entry("missing", json!([word]))));
                let column = self.dialect.headers[column].clone();
                LogError::BadCell { row, line, column, what: what.into(), advice, mend, path }
            }
        }
    }

    /// The whole table, when every block has been taken.
    pub fn finish(mut self) -> Result<Table, LogError> {
        if self.rows == 0 {
            return Err(LogError::HeaderOnly { path: self.path.to_path_buf() });
        }
        if self.table.groups.is_empty() {
            return Err(self.nothing_selected());
        }
        self.settle_blanks()?;
        for (_, group) in &mut self.table.groups {
            group.columns.iter_mut().for_each(Vec::shrink_to_fit);
            group.labels.shrink_to_fit();
        }
        Ok(self.table)
    }

    /// A needed column without a value in many rows has a clock of its own. Rows are left out if few of them lack a value.
    /// A clock, a column with hardly a value, and rows without a clock need each.
    fn settle_blanks(&mut self) -> Result<(), LogError> {
        let is_needed = |c: &usize| matches!(self.plan.uses[*c], Use::Number { required: true, .. });
        let (needed, others): (Vec<usize>, Vec<usize>) = self.table.gappy_columns.iter().partition(|c| is_needed(c));
        let mut worst: Option<(usize, u64, usize)> = None;
        let mut holes = vec![Vec::new(); self.table.groups.len()];
        for &column in &needed {
            for ((_, group), holes) in self.table.groups.iter().zip(&mut holes) {
                match self.blanks(group, column) {
                    Blanks::OfASlowerClock => {}
                    Blanks::Few => holes.push(column),
                    Blanks::Faulty => {
                        let first = group.columns[column].iter().position(|v| is_missing(*v));
                        let place = first.map(|first| group.place(first));
                        let earlier = place.filter(|(row, _)| worst.is_none_or(|(other, ..)| *row < other));
                        worst = earlier.map(|(row, line)| (row, line, column)).or(worst);
                    }
                }
            }
        }
        if let Some((row, line, column)) = worst {
            return Err(self.sentence(row, line, Fault::Cell(column, "the cell is empty".to_owned(), None)));
        }
        self.table.gappy_columns = others;
        self.table.sparse_columns = needed;
        for ((_, group), holes) in self.table.groups.iter_mut().zip(holes).filter(|(_, holes)| !holes.is_empty()) {
            let lacks = |row: &usize| holes.iter().any(|column| is_missing(group.columns[*column][*row]));
            let first = (0..group.rows()).find(lacks).map_or(0, |first| group.place(first).0);
            let kept = group.filtered(|row| !lacks(&row));
            let names: Vec<String> = holes.iter().map(|c| format!("`{}`", self.dialect.headers[*c])).collect();
            let (count, names) = (group.rows() - kept.rows(), names.join(", "));
            self.table
                .notes
                .push(format!("{count} row(s) without a value of {names}, from row {first} on, are left out"));
            *group = kept;
        }
        Ok(())
    }

    /// Meaning of the cells without a value that a needed column has in a group of rows.
    fn blanks(&self, group: &Group, column: usize) -> Blanks {
        let values = &group.columns[column];
        let blanks = values.iter().filter(|v| is_missing(**v)).count();
        let has_values = values.len() - blanks >= LEAST_VALUES;
        let has_pairs = self.plan.has_pairs();
        if blanks == 0 {
            return Blanks::OfASlowerClock;
        }
        if Some(column) == self.plan.time && !has_pairs || !has_values {
            return Blanks::Faulty;
        }
        // Pairs of time and value side by side have lengths of their own.
        let trails = || values.iter().rev().take(blanks).all(|v| is_missing(*v));
        match () {
            () if self.dialect.is_long || 3 * blanks >= values.len() || has_pairs && trails() => Blanks::OfASlowerClock,
            () if self.plan.time.is_some() && !has_pairs && !self.plan.spare.contains(&column) => Blanks::Few,
            () => Blanks::Faulty,
        }
    }

    fn nothing_selected(&self) -> LogError {
        let at = self.seen.iter().position(|s| !s.is_empty()).unwrap_or(0);
        let (wanted, seen) = (&self.plan.select[at], &self.seen[at]);
        let more = if seen.len() < SHOWN_VALUES { "" } else { ", …" };
        LogError::NothingSelected {
            column: self.dialect.headers[wanted.column].clone(),
            wanted: wanted.shown(),
            present: if seen.is_empty() { "no rows".to_owned() } else { seen.join(", ") + more },
            path: self.path.to_path_buf(),
        }
    }
}
