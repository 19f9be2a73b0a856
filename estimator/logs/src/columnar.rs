//! Conversion of a container's columns to the common table of all formats: selection, trials, labels, units.

use super::errors::{LogError, MAP_ANOTHER};
use super::plan::{Plan, Use};
use super::raw::{Cells, Raw};
use super::suggested::entry;
use super::table::{Group, Table};
use csv::ByteRecord;
use haptics::recording::Labels;
use serde_json::json;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Largest number of values of a selected column that are named when none fits.
const SHOWN_VALUES: usize = 6;

/// Makes the table as `plan` says.
pub fn table(raw: &mut Raw, plan: &Plan, path: &Path) -> Result<Table, LogError> {
    if raw.rows() == 0 {
        return Err(LogError::HeaderOnly { path: path.to_path_buf() });
    }
    let mut rows = selected(raw, plan, path)?;
    let mut table = Table::default();
    leave_missing_out(raw, plan, &mut rows, &mut table, path)?;
    fingerprint(raw, plan, &mut table);
    let groups = groups(raw, plan, &rows);
    let uses = usable(raw, plan, &groups, &mut table, path)?;
    if plan.trial.is_none() && rows.len() == raw.rows() {
        table.groups.push((None, whole(raw, plan, &uses)));
        return Ok(table);
    }
    for (trial, members) in groups {
        let mut group = Group::new(vec![Vec::new(); uses.len()], labels(raw, plan, &members));
        for (column, factor) in uses.iter().enumerate().filter_map(|(c, u)| Some((c, (*u)?))) {
            let value = |&row: &usize| number(&raw.columns[column], row) * factor;
            group.columns[column] = members.iter().map(value).collect();
        }
        for (index, &row) in members.iter().enumerate() {
            group.note_place(index, row + 1, 0);
        }
        table.groups.push((trial, group));
    }
    Ok(table)
}

/// The one group of a file without trials and selection: columns are moved, not copied.
fn whole(raw: &mut Raw, plan: &Plan, uses: &[Option<f64>]) -> Group {
    let labels = match plan.label.map(|column| (column, &mut raw.columns[column])) {
        // It is not read as numbers too: the plan gives a column one use.
        Some((_, Cells::Text(texts))) => std::mem::take(texts),
        Some((column, Cells::Numbers(_))) => (0..raw.rows()).map(|row| raw.columns[column].text(row)).collect(),
        None => Labels::default(),
    };
    let mut group = Group::new(Vec::new(), labels);
    for (cells, &factor) in raw.columns.iter_mut().zip(uses) {
        let mut values = Vec::new();
        if let Some(factor) = factor {
            values = match cells {
                Cells::Numbers(numbers) => std::mem::take(numbers),
                Cells::Text(_) => (0..cells.len()).map(|row| number(cells, row)).collect(),
            };
            if factor != 1.0 {
                for value in &mut values {
                    *value *= factor;
                }
            }
        }
        group.columns.push(values);
    }
    group
}

fn labels(raw: &Raw, plan: &Plan, rows: &[usize]) -> Labels {
    match plan.label.map(|column| &raw.columns[column]) {
        Some(Cells::Text(texts)) => texts.gathered(rows.iter().copied()),
        Some(cells) => rows.iter().map(|&row| cells.text(row)).collect(),
        None => Labels::default(),
    }
}

/// A cell as a number; not a number where it is text that is none.
fn number(cells: &Cells, row: usize) -> f64 {
    match cells {
        Cells::Numbers(values) => values[row],
        Cells::Text(texts) => texts[row].trim().parse().unwrap_or(f64::NAN),
    }
}

/// Indices of the rows that the sidecar selects.
fn selected(raw: &Raw, plan: &Plan, path: &Path) -> Result<Vec<usize>, LogError> {
    let mut rows: Vec<usize> = (0..raw.rows()).collect();
    for wanted in &plan.select {
        let mut seen: Vec<String> = Vec::new();
        rows.retain(|&row| {
            let cell = raw.columns[wanted.column].text(row);
            let fits = wanted.matches(cell.trim().as_bytes());
            if !fits && seen.len() < SHOWN_VALUES && !seen.contains(&cell) {
                seen.push(cell);
            }
            fits
        });
        if rows.is_empty() {
            let more = if seen.len() < SHOWN_VALUES { "" } else { ", …" };
            return Err(LogError::NothingSelected {
                column: raw.headers[wanted.column].clone(),
                wanted: wanted.shown(),
                present: if seen.is_empty() { "no rows".to_owned() } else { seen.join(", ") + more },
                path: path.to_path_buf(),
            });
        }
    }
    Ok(rows)
}

/// Leaves out the rows in which a needed column holds a text that stands for no measurement.
fn leave_missing_out(
    raw: &Raw,
    plan: &Plan,
    rows: &mut Vec<usize>,
    table: &mut Table,
    path: &Path,
) -> Result<(), LogError> {
    let needed = plan.uses.iter().zip(&raw.columns).zip(&raw.headers);
    for ((wanted, cells), header) in needed.filter(|_| !plan.missing.is_empty()) {
        if !matches!(wanted, Use::Number { required: true, .. }) {
            continue;
        }
        let before = rows.len();
        let is_out = |row: usize| !number(cells, row).is_finite() && plan.is_missing(cells.text(row).trim());
        rows.retain(|row| !is_out(*row));
        if rows.is_empty() && before > 0 {
            return Err(LogError::BadCell {
                row: 1,
                line: 0,
                column: header.clone(),
                what: "no row holds a value".into(),
                advice: MAP_ANOTHER,
                mend: None,
                path: path.to_path_buf(),
            });
        }
        if rows.len() < before {
            table.notes.push(format!("{} row(s) without a value of `{header}` are left out", before - rows.len()));
        }
    }
    Ok(())
}

/// Rows by trial, in the order in which the trials first appear.
fn groups(raw: &Raw, plan: &Plan, rows: &[usize]) -> Vec<(Option<String>, Vec<usize>)> {
    let Some(column) = plan.trial else { return vec![(None, rows.to_vec())] };
    let mut groups: Vec<(Option<String>, Vec<usize>)> = Vec::new();
    let mut index: HashMap<String, usize> = HashMap::new();
    for &row in rows {
        let key = raw.columns[column].text(row);
        let group = *index.entry(key.clone()).or_insert_with(|| {
            groups.push((Some(key), Vec::new()));
            groups.len() - 1
        });
        groups[group].1.push(row);
    }
    groups
}

/// The factor of every column that is used; an error for the first cell, row by row, that cannot be.
fn usable(
    raw: &Raw,
    plan: &Plan,
    groups: &[(Option<String>, Vec<usize>)],
    table: &mut Table,
    path: &Path,
) -> Result<Vec<Option<f64>>, LogError> {
    let mut uses = vec![None; plan.uses.len()];
    let mut worst: Option<(usize, usize, String)> = None;
    for (column, wanted) in plan.uses.iter().enumerate() {
        let (required, factor) = match *wanted {
            Use::Number { required, factor } => (required, factor),
            // Its text has become seconds.
            Use::Stamp { .. } => (true, 1.0),
            Use::Ignore => continue,
        };
        let cells = &raw.columns[column];
        let rows = groups.iter().flat_map(|(_, rows)| rows);
        let first_bad = rows.copied().filter(|&row| !number(cells, row).is_finite()).min();
        let Some(row) = first_bad else {
            uses[column] = Some(factor);
            continue;
        };
        let none_asked = !required && plan.label != Some(column) && plan.trial != Some(column);
        match cells {
            Cells::Text(_) if none_asked => table.text_columns.push(column),
            Cells::Numbers(_) if none_asked => table.gappy_columns.push(column),
            _ => {
                let what = complaint(cells, row);
                if worst.as_ref().is_none_or(|(earlier, _, _)| row < *earlier) {
                    worst = Some((row, column, what));
                }
            }
        }
    }
    match worst {
        None => Ok(uses),
        Some((row, column, what)) => {
            let word = raw.columns[column].text(row);
            let is_word = !word.is_empty() && !word.contains(|c: char| c.is_ascii_digit());
            let mend = is_word.then(|| Box::new(entry("missing", json!([word.trim()]))));
            Err(LogError::BadCell {
                row: row + 1,
                line: 0,
                column: raw.headers[column].clone(),
                what: what.into(),
                advice: MAP_ANOTHER,
                mend,
                path: PathBuf::from(path),
            })
        }
    }
}

fn complaint(cells: &Cells, row: usize) -> String {
    let shown: String = cells.text(row).trim().chars().take(40).collect();
    match cells {
        _ if shown.is_empty() => "there is no value".to_owned(),
        Cells::Numbers(_) => format!("`{shown}` is not a finite number"),
        Cells::Text(_) if shown.parse::<f64>().is_ok() => format!("`{shown}` is not a finite number"),
        Cells::Text(_) => format!("`{shown}` is not a number"),
    }
}

/// Takes every row of the file into the fingerprints, also those that are not selected.
fn fingerprint(raw: &Raw, plan: &Plan, table: &mut Table) {
    if plan.watched.is_empty() {
        return;
    }
    let mut record = ByteRecord::new();
    for row in 0..raw.rows() {
        record.clear();
        for (column, cells) in raw.columns.iter().enumerate() {
            match cells {
                _ if plan.trial_keys.contains(&column) => record.push_field(cells.text(row).as_bytes()),
                Cells::Numbers(values) if plan.watched.contains(&column) => {
                    record.push_field(&values[row].to_bits().to_le_bytes());
                }
                _ => record.push_field(b""),
            }
        }
        table.fingerprints.add(plan, &record);
    }
}
