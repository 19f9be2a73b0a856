//! Choice of the columns that make the table, and the sentences about all others.

use super::gather::{Column, Gathered, Run};
use crate::raw::{Cells, Raw};
use crate::{plan, stated_rate};
use haptics::recording::Warning;
use std::collections::HashMap;

/// Most names of variables in a sentence.
const MOST_NAMES: usize = 12;
/// Most sentences about values that are left out.
const MOST_SENTENCES: usize = 20;

/// Columns of equal length.
struct Group {
    runs: Vec<Run>,
    columns: Vec<Column>,
}

impl Group {
    fn rows(&self) -> usize {
        self.runs.iter().map(|run| run.rows).sum()
    }

    /// Merit as the table of a recording: a clock first, then the number of columns with numbers, then rows.
    fn merit(&self) -> (bool, bool, usize, usize) {
        let numbers = self.columns.iter().filter(|column| matches!(column.cells, Cells::Numbers(_)));
        let has_clock = numbers.clone().any(|column| plan::is_clock(&column.short, &column.unit));
        let count = numbers.count();
        (count > 0 && self.rows() > 1, has_clock, count, self.rows())
    }
}

/// The table that the columns make, with notes about the rest; else the reason for there being none.
pub fn of(gathered: Gathered) -> Result<(Raw, Vec<Warning>), String> {
    let mut said: Vec<String> = Vec::new();
    let mut groups: Vec<Group> = Vec::new();
    let mut known: HashMap<Vec<Run>, usize> = HashMap::new();
    for column in gathered.columns {
        // A column of changing kind or unit is told below, and has lost rows.
        if column.runs.iter().map(|run| run.rows).sum::<usize>() != column.cells.len() {
            continue;
        }
        let at = *known.entry(column.runs.clone()).or_insert(groups.len());
        match groups.get_mut(at) {
            Some(group) => group.columns.push(column),
            None => groups.push(Group { runs: column.runs.clone(), columns: vec![column] }),
        }
    }
    for (why, paths) in &gathered.left_out {
        let paths: Vec<&str> = paths.iter().map(String::as_str).collect();
        said.push(format!("{} not read: {why}", subject(&paths)));
    }
    let best = (0..groups.len()).rev().max_by_key(|&at| groups[at].merit()).filter(|&at| groups[at].merit().0);
    let Some(best) = best else {
        let none = "no variable is a vector of samples".to_owned();
        return Err(said.into_iter().next().unwrap_or(none));
    };
    let table = groups.swap_remove(best);
    said.extend(others(&groups, table.rows()));
    let more = said.len().saturating_sub(MOST_SENTENCES);
    said.truncate(MOST_SENTENCES);
    said.extend((more > 0).then(|| format!("{more} more reasons for which variables are not read are not listed")));
    let rate = groups.iter().flat_map(|group| &group.columns).find_map(rate_of);
    Ok((raw(table), said.into_iter().map(note).chain(rate).collect()))
}

/// Doubt about the rate that a variable of one number states: `Fs`, `dt`.
fn rate_of(column: &Column) -> Option<Warning> {
    let Cells::Numbers(values) = &column.cells else { return None };
    let [value] = values[..] else { return None };
    let text = format!("{} = {value}", column.short);
    Some(stated_rate::doubt(&text, stated_rate::of_line(&text)?))
}

/// Sentence about the columns of other lengths.
fn others(groups: &[Group], rows: usize) -> Option<String> {
    let mut groups: Vec<&Group> = groups.iter().collect();
    groups.sort_by_key(|group| std::cmp::Reverse(group.merit()));
    let shown = groups.iter().map(|group| {
        let paths: Vec<&str> = group.columns.iter().map(|column| column.path.as_str()).collect();
        let rows = group.rows();
        format!("{} ({rows} {})", names(&paths), if rows == 1 { "value" } else { "values" })
    });
    let shown: Vec<String> = shown.take(MOST_NAMES).collect();
    let more = if groups.len() > MOST_NAMES { ", …" } else { "" };
    (!groups.is_empty()).then(|| {
        format!("the table of {rows} rows is read, variables of other lengths are not: {}{more}", shown.join(", "))
    })
}

/// `a`, `b` is or are.
fn subject(paths: &[&str]) -> String {
    match paths {
        [one] => format!("the variable `{one}` is"),
        _ => format!("the variables {} are", names(paths)),
    }
}

fn names(paths: &[&str]) -> String {
    let shown: Vec<String> = paths.iter().take(MOST_NAMES).map(|path| format!("`{path}`")).collect();
    if paths.len() > MOST_NAMES {
        format!("{} and {} more", shown.join(", "), paths.len() - MOST_NAMES)
    } else {
        shown.join(", ")
    }
}

fn note(text: String) -> Warning {
    Warning { kind: "variables".to_owned(), column: None, spans: Vec::new(), text, ..Warning::default() }
}

/// The columns by their short names if those are unique, and the number of the run.
fn raw(table: Group) -> Raw {
    let mut count: HashMap<String, usize> = HashMap::new();
    for column in &table.columns {
        *count.entry(column.short.clone()).or_default() += 1;
    }
    let mut raw = Raw::default();
    if table.runs.len() > 1 && !count.contains_key("trial") {
        let numbers =
            table.runs.iter().enumerate().flat_map(|(at, run)| std::iter::repeat_n(at as f64 + 1.0, run.rows));
        raw.headers.push("trial".to_owned());
        raw.aliases.push("trial".to_owned());
        raw.units.push(String::new());
        raw.columns.push(Cells::Numbers(numbers.collect()));
    }
    for column in table.columns {
        let is_unique = count.get(&column.short) == Some(&1);
        raw.headers.push(if is_unique { column.short } else { column.path.clone() });
        raw.aliases.push(column.path);
        raw.units.push(column.unit);
        raw.columns.push(column.cells);
    }
    raw
}
