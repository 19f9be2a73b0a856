//! Columns of a table with clocks of their own, such as pairs of time and value side by side: put on the log's clock, or
//! doubted.

use super::errors::LogError;
use super::mcap::resample;
use super::plan::{self, Plan, SecondClock, TIMES, Use, words};
use super::raw::{Cells, is_missing};
use super::sidecar;
use super::table::{Group, Table};
use haptics::recording::{Labels, Meta, Warning};
use serde_json::{Value, json};
use std::path::Path;

/// Share of a sample interval by which two clocks of one instant differ at most: stamps are rounded.
const ROUNDING: f64 = 0.1;

/// Number of rows up to the last value.
fn filled(values: &[f64]) -> usize {
    values.iter().rposition(|v| !is_missing(*v)).map_or(0, |last| last + 1)
}

/// True for two values and more that increase, with none missing between them.
fn runs_on(values: &[f64]) -> bool {
    let values = &values[..filled(values)];
    values.len() > 1 && values.windows(2).all(|w| w[1] > w[0])
}

/// Takes the first column that reads as a clock and increases in every run as the time, if there is no other.
pub fn take_time(table: &mut Table, plan: &mut Plan, meta: &Meta, headers: &[String]) {
    let is_off = meta.columns.get("t_s").is_some_and(String::is_empty) || meta.rate_hz.is_some();
    if plan.time.is_some() || is_off {
        return;
    }
    let increases = |column: usize| table.groups.iter().all(|(_, group)| runs_on(&group.columns[column]));
    let Some((column, factor)) = plan.suspects.iter().copied().find(|(column, _)| increases(*column)) else { return };
    for (_, group) in &mut table.groups {
        group.columns[column].iter_mut().filter(|t| !is_missing(**t)).for_each(|t| *t *= factor);
    }
    plan.time = Some(column);
    plan.suspects.retain(|(other, _)| *other != column);
    plan.targets.retain(|target| target.column != column);
    table.gappy_columns.retain(|other| *other != column);
    plan.notes.push(format!("the column `{}` is taken as the time t_s", headers[column]));
}

/// Puts columns with clocks of their own on the log's clock. Returns sentences about it.
pub fn on_the_logs_clock(
    group: &mut Group,
    plan: &Plan,
    headers: &[String],
    path: &Path,
) -> Result<Vec<String>, LogError> {
    let refused = |why: String| LogError::Sidecar { why, path: sidecar::path_for(path) };
    let Some(time) = plan.time.filter(|_| plan.has_pairs()) else {
        let why = "\"clocks\" needs the clock of the log; map its column to t_s with \"columns\"";
        return if plan.clocks.is_empty() { Ok(Vec::new()) } else { Err(refused(why.to_owned())) };
    };
    // Rows behind the last time belong to longer columns with another clock.
    let main: Vec<f64> = group.columns[time][..filled(&group.columns[time])].to_vec();
    if plan.clocks.is_empty() && main.len() == group.rows() {
        return Ok(Vec::new());
    }
    let (mut kept, mut moved) = (vec![true; main.len()], Vec::new());
    for second in &plan.clocks {
        let clock = &group.columns[second.clock];
        if let Some(name) = [(time, &main), (second.clock, clock)].iter().find(|(_, values)| !runs_on(values)) {
            let name = &headers[name.0];
            return Err(refused(format!("the clock `{name}` that \"clocks\" needs does not increase in every row")));
        }
        let times: Vec<f64> = clock[..filled(clock)].iter().map(|t| t + second.offset_s).collect();
        let covered = resample::covered(&times, &main);
        kept.iter_mut().zip(covered).for_each(|(kept, covered)| *kept &= covered);
        if !kept.contains(&true) {
            let ends = (times[0], times[times.len() - 1]);
            return Err(refused(apart(second, ends, &main, headers, time)));
        }
        moved.push(times);
    }
    let rows: Vec<usize> = (0..main.len()).filter(|&row| kept[row]).collect();
    let (columns, mut said) = put(group, plan, &moved, &rows, headers);
    if let Some(first) = said.first_mut() {
        *first = format!("the clock is `{}`; {} of {} rows are kept; {first}", headers[time], rows.len(), main.len());
    }
    let labels = if group.labels.is_empty() { Labels::default() } else { group.labels.gathered(rows.iter().copied()) };
    let before = std::mem::replace(group, Group::new(columns, labels));
    if rows.last().is_some_and(|last| last + 1 == rows.len()) {
        group.take_places(&before);
    }
    Ok(said)
}

/// The columns in some rows of the log's clock, with sentences about those that are put on it. `moved`: times of each clock
/// of the plan, s.
fn put(
    group: &Group,
    plan: &Plan,
    moved: &[Vec<f64>],
    rows: &[usize],
    headers: &[String],
) -> (Vec<Vec<f64>>, Vec<String>) {
    let gathered = |values: &Vec<f64>| rows.iter().filter_map(|&row| values.get(row).copied()).collect::<Vec<f64>>();
    let mut columns: Vec<Vec<f64>> = group.columns.iter().map(gathered).collect();
    let to = plan.time.map(|time| columns[time].clone()).unwrap_or_default();
    let mut said = Vec::new();
    for (second, times) in plan.clocks.iter().zip(moved) {
        for &column in &second.columns {
            let measured = times.iter().zip(&group.columns[column]).filter(|(_, value)| !is_missing(**value));
            let (from, values): (Vec<f64>, Vec<f64>) = measured.map(|(t, value)| (*t, *value)).unzip();
            if let (true, Cells::Numbers(put)) = (from.len() > 1, resample::onto(&to, &from, &Cells::Numbers(values))) {
                columns[column] = put;
                said.push(resample::describe(&headers[column], &from, &to));
            }
        }
    }
    (columns, said)
}

/// Sentence about a clock that shares no time with the log's.
fn apart(second: &SecondClock, (first, last): (f64, f64), main: &[f64], headers: &[String], time: usize) -> String {
    let (clock, column) = (&headers[second.clock], &headers[second.columns[0]]);
    let entries = json!({ column: { "column": clock, "offset_s": Value::Null } });
    format!(
        "`{clock}` runs from {first} to {last} s and `{}` from {} to {} s; state the seconds that are added to the first \
         in place of null: \"clocks\": {entries}",
        headers[time],
        main[0],
        main[main.len() - 1],
    )
}

/// Doubts about columns that read as further clocks and that the sidecar does not mention.
pub fn doubts(group: &Group, plan: &Plan, headers: &[String]) -> Vec<Warning> {
    let Some(main) = plan.time.map(|column| &group.columns[column]) else { return Vec::new() };
    let step = resample::period(&main[..filled(main)]);
    let is_second = |&&(column, factor): &&(usize, f64)| {
        let clock = &group.columns[column];
        let mut both = clock.iter().zip(main).filter(|(a, b)| !is_missing(**a) && !is_missing(**b));
        let differs = filled(clock) != filled(main) || both.any(|(a, b)| (a * factor - b).abs() > ROUNDING * step);
        differs && runs_on(clock)
    };
    plan.suspects.iter().filter(is_second).filter_map(|&(clock, _)| doubt(clock, plan, headers)).collect()
}

fn doubt(clock: usize, plan: &Plan, headers: &[String]) -> Option<Warning> {
    let columns = columns_of(clock, plan, headers);
    let sources = plan::sources(headers);
    let name = &sources[clock];
    let entries: serde_json::Map<String, Value> =
        columns.iter().map(|&column| (sources[column].clone(), name.as_str().into())).collect();
    let first = sources[*columns.first()?].clone();
    let text = format!(
        "`{name}` is a second clock, and each row is taken as one instant: if it belongs to `{first}`, state \"clocks\": \
         {{\"{first}\": \"{name}\"}} in the sidecar"
    );
    let suggested = json!({ "clocks": entries }).as_object().cloned();
    Some(Warning { kind: "clock".to_owned(), column: Some(name.clone()), text, suggested, ..Warning::default() })
}

/// Columns that belong to a clock: those that share a word with its name, else those between it and the next clock, if
/// others stand before it.
fn columns_of(clock: usize, plan: &Plan, headers: &[String]) -> Vec<usize> {
    let is_clock = |column: usize| Some(column) == plan.time || plan.suspects.iter().any(|(c, _)| *c == column);
    let own = |column: &usize| plan.clocks.iter().any(|second| second.columns.contains(column));
    let is_number = |column: &usize| matches!(plan.uses[*column], Use::Number { .. });
    let all = plan.targets.iter().map(|t| t.column).filter(|c| !is_clock(*c) && is_number(c) && !own(c));
    let all: Vec<usize> = all.collect();
    let words_of = |column: usize| words(&headers[column]).into_iter().filter(|word| word.len() > 2);
    let common: Vec<String> = words_of(clock).filter(|word| !TIMES.contains(&word.as_str())).collect();
    let named: Vec<usize> = all.iter().copied().filter(|&c| words_of(c).any(|word| common.contains(&word))).collect();
    if !named.is_empty() {
        return if named.len() < all.len() { named } else { Vec::new() };
    }
    let next = (clock + 1..headers.len()).find(|&column| is_clock(column)).unwrap_or(headers.len());
    let has_before = all.iter().any(|&column| column < clock);
    all.into_iter().filter(|column| has_before && (clock..next).contains(column)).collect()
}

#[cfg(test)]
mod tests;
