//! Parts of a table put together in the order of the file.

use super::dialect::Dialect;
use super::part::{Fault, Part};
use crate::errors::LogError;
use crate::pages;
use crate::plan::{Plan, Use};
use crate::preview::Preview;
use crate::raw::is_missing;
use crate::table::{Group, Table};
use std::collections::{BTreeMap, HashMap};
use std::path::Path;

/// Number of values of a selected column that a sentence lists.
const SHOWN_VALUES: usize = 6;

/// Fewer values than this are no samples of a slower clock.
const LEAST_VALUES: usize = 8;

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
            Fault::Cell(column, what) => {
                LogError::BadCell { row, line, column: self.dialect.headers[column].clone(), what, path }
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

    /// A needed column without a value in many rows has a clock of its own; one without a value in a few rows is faulty.
    fn settle_blanks(&mut self) -> Result<(), LogError> {
        let is_needed = |c: &usize| matches!(self.plan.uses[*c], Use::Number { required: true, .. });
        let (needed, others): (Vec<usize>, Vec<usize>) = self.table.gappy_columns.iter().partition(|c| is_needed(c));
        let is_time = |column: usize| Some(column) == self.plan.time && !self.plan.has_pairs();
        let mut worst: Option<(usize, u64, usize)> = None;
        for &column in &needed {
            let blanks = |group: &Group| group.columns[column].iter().filter(|v| is_missing(**v)).count();
            let is_sparse = |group: &Group| {
                let (all, blanks) = (group.columns[column].len(), blanks(group));
                // Pairs of time and value side by side have lengths of their own.
                let trails = || group.columns[column].iter().rev().take(blanks).all(|v| is_missing(*v));
                let is_shorter = self.plan.has_pairs() && all - blanks >= LEAST_VALUES && trails();
                let is_slower = self.dialect.is_long || 3 * blanks >= all;
                blanks == 0 || is_shorter || all - blanks >= LEAST_VALUES && is_slower
            };
            let groups = self.table.groups.iter().map(|(_, group)| group);
            for group in groups.filter(|group| is_time(column) || !is_sparse(group)) {
                let first = group.columns[column].iter().position(|v| is_missing(*v));
                let place = first.map(|first| group.place(first));
                let earlier = place.filter(|(row, _)| worst.is_none_or(|(other, ..)| *row < other));
                worst = earlier.map(|(row, line)| (row, line, column)).or(worst);
            }
        }
        self.table.gappy_columns = others;
        self.table.sparse_columns = needed;
        let fault = |column| Fault::Cell(column, "the cell is empty".to_owned());
        worst.map_or(Ok(()), |(row, line, column)| Err(self.sentence(row, line, fault(column))))
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
