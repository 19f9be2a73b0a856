//! Runs of a table. A run is a stretch of rows that were recorded in one go: with one value of the column that counts runs,
//! and with times that increase. Every run becomes a recording.

use super::clock;
use super::errors::LogError;
use super::plan::Plan;
use super::table::Group;
use super::units;
use haptics::recording::{Labels, TimeWindow};
use std::path::Path;

/// Fewest rows of a run that is told by its clock alone. Half as many make runs of repeated packets.
const LEAST_ROWS: usize = 10;
/// A step up to so many usual ones belongs to the same run. Half as many split recordings with dropped samples.
const LONGEST_STEP: f64 = 10.0;
/// A clock that starts again falls by this share of its run or more. A packet that arrives late falls by less.
const LEAST_FALL: f64 = 0.5;

/// A run of fewer rows is an attempt that was broken off, beside one of [`LONGER`] times as many: no law is fitted to so few.
const BROKEN_OFF: usize = 24;
const LONGER: usize = 10;

/// A run: its name where there are several, and its rows.
pub type Run = (Option<String>, Group);

/// Rows within a window of time, with their times, s.
pub type Part = (Option<TimeWindow>, Group, Option<Vec<f64>>);

/// Runs of a table, with a sentence about them.
pub struct Apart {
    /// The runs, in the order of the file.
    pub runs: Vec<Run>,
    /// The rule by which they were told apart, if it was not stated.
    pub said: Option<String>,
    /// False when the column that counts runs was found to count something else.
    pub by_column: bool,
}

/// Tells the runs of a table apart. `groups`: its rows by the value of the column that counts runs. An error when the
/// sidecar selects runs that are not there.
pub fn apart(groups: Vec<Run>, plan: &Plan, headers: &[String], path: &Path) -> Result<Apart, LogError> {
    let name = plan.trial.map_or("", |column| headers[column].as_str());
    let many = groups.len() > 1;
    let by_column = !plan.is_trial_guessed || !many || are_runs(&groups, plan);
    let (groups, mut said) = match (by_column, plan.is_trial_guessed && many) {
        (false, _) => {
            let text = format!(
                "time goes on where `{name}` changes, so the file is one run; \"select\": {{\"{name}\": …}} takes a part of \
                 it, and \"columns\": {{\"trial\": \"{name}\"}} makes each value a recording"
            );
            (vec![(None, merged(&groups))], Some(text))
        }
        (true, guessed) => {
            let text = guessed.then(|| format!("each value of `{name}` is a run, and each run a recording"));
            (groups, text)
        }
    };
    let before = groups.len();
    let mut runs: Vec<Run> = groups.into_iter().flat_map(|(trial, group)| split(trial, group, plan)).collect();
    if runs.len() > before {
        let text = format!("the clock starts again {} time(s): each start begins a run", runs.len() - before);
        said = Some(said.map_or(text.clone(), |before| format!("{before}; {text}")));
        if before == 1 && runs[0].0.is_none() {
            (1..).zip(&mut runs).for_each(|(number, (name, _))| *name = Some(number.to_string()));
        }
    }
    if plan.runs.is_none() {
        said = leave_out_broken_off(&mut runs)
            .into_iter()
            .chain(said)
            .reduce(|short, others| format!("{others}; {short}"));
    }
    if let Some(wanted) = &plan.runs {
        let names: Vec<String> = runs.iter().filter_map(|(name, _)| name.clone()).collect();
        runs.retain(|(name, _)| name.as_ref().is_some_and(|name| wanted.matches(name.as_bytes())));
        if runs.is_empty() {
            let present = if names.is_empty() { "one run".to_owned() } else { names.join(", ") };
            let (column, wanted) = ("trial".to_owned(), wanted.shown());
            return Err(LogError::NothingSelected { column, wanted, present, path: path.to_path_buf() });
        }
    }
    Ok(Apart { runs, said, by_column })
}

/// Leaves the runs out that were broken off; a sentence about them.
fn leave_out_broken_off(runs: &mut Vec<Run>) -> Option<String> {
    let longest = runs.iter().map(|(_, group)| group.rows()).max()?;
    let is_short = |(_, group): &Run| group.rows() < BROKEN_OFF && LONGER * group.rows() < longest;
    let short: Vec<String> = runs
        .iter()
        .filter(|run| is_short(run))
        .map(|(name, group)| format!("{} ({} rows)", name.as_deref().unwrap_or_default(), group.rows()))
        .collect();
    runs.retain(|run| !is_short(run));
    (!short.is_empty()).then(|| {
        format!(
            "runs that were broken off are left out: {}; \"select\": {{\"trial\": …}} reads one of them",
            short.join(", ")
        )
    })
}

/// True if the clock starts again, stands still, or pauses at half of the changes of the column, if its values take turns, and without
/// a clock.
fn are_runs(groups: &[Run], plan: &Plan) -> bool {
    let Some(clock) = plan.time else { return true };
    let order = stretches(groups);
    let rows: usize = groups.iter().map(|(_, group)| group.rows()).sum();
    if rows < LEAST_ROWS * order.len() && order.len() > groups.len() {
        return true;
    }
    let usual =
        groups.iter().filter_map(|(_, group)| clock::usual_step(&group.columns[clock])).fold(f64::NAN, f64::min);
    let step = |a: &Stretch, b: &Stretch| {
        groups[b.group].1.columns[clock][b.first] - groups[a.group].1.columns[clock][a.end - 1]
    };
    let steps: Vec<f64> = order.windows(2).filter(|w| w[0].group != w[1].group).map(|w| step(&w[0], &w[1])).collect();
    let breaks = steps.iter().filter(|step| **step <= 0.0 || **step > LONGEST_STEP * usual).count();
    2 * breaks >= steps.len()
}

/// Rows of a group that stand one after the other in the file.
struct Stretch {
    /// Row in the file.
    row: usize,
    line: u64,
    group: usize,
    first: usize,
    end: usize,
}

/// All rows, in the order of the file.
fn stretches(groups: &[Run]) -> Vec<Stretch> {
    let mut found: Vec<Stretch> = Vec::new();
    for (index, (_, group)) in groups.iter().enumerate() {
        let starts = group.stretches();
        for (k, &(first, line, row)) in starts.iter().enumerate() {
            let end = starts.get(k + 1).map_or(group.rows(), |next| next.0);
            found.push(Stretch { row, line, group: index, first, end });
        }
    }
    found.sort_by_key(|stretch| stretch.row);
    found
}

/// The groups as one, in the order of the file.
fn merged(groups: &[Run]) -> Group {
    let order = stretches(groups);
    let width = groups.first().map_or(0, |(_, group)| group.columns.len());
    let mut whole = Group::new(vec![Vec::new(); width], Labels::default());
    let mut rows = 0;
    for stretch in order {
        let from = &groups[stretch.group].1;
        for (column, values) in whole.columns.iter_mut().zip(&from.columns).filter(|(_, values)| !values.is_empty()) {
            column.extend_from_slice(&values[stretch.first..stretch.end]);
        }
        if !from.labels.is_empty() {
            whole.labels.extend_from(&from.labels, stretch.first..stretch.end);
        }
        whole.note_place(rows, stretch.row, stretch.line);
        rows += stretch.end - stretch.first;
    }
    whole
}

/// The parts of a group between the starts of its clock.
fn split(trial: Option<String>, group: Group, plan: &Plan) -> Vec<Run> {
    let starts = match plan.time {
        Some(clock) => starts(&group.columns[clock], &clock::cycles(plan.uses[clock])),
        None => counter_starts(&group, plan),
    };
    let ends = starts.iter().skip(1).copied().chain([group.rows()]);
    if starts.len() < 2 {
        return vec![(trial, group)];
    }
    let name =
        |part: usize| trial.as_ref().map(|trial| if part == 1 { trial.clone() } else { format!("{trial} ({part})") });
    (1..)
        .zip(starts.iter().zip(ends))
        .map(|(part, (&first, end))| (name(part), group.rows_between(first, end)))
        .collect()
}

/// First rows of the runs that a clock tells.
fn starts(time: &[f64], cycles: &[f64]) -> Vec<usize> {
    let mut starts = vec![0];
    if time.windows(2).all(|w| w[1] > w[0]) {
        return starts;
    }
    let Some(usual) = clock::usual_step(time) else { return starts };
    let goes_on = |row: usize| {
        let next = time.get(row..row + LEAST_ROWS);
        next.is_some_and(|next| next.windows(2).all(|w| w[1] > w[0] && w[1] - w[0] <= LONGEST_STEP * usual))
    };
    for row in 1..time.len() {
        let first = starts[starts.len() - 1];
        let (step, span) = (time[row] - time[row - 1], time[row - 1] - time[first]);
        // A time of the day may pause over midnight.
        let is_night = cycles.contains(&clock::DAY_S) && -step > 0.5 * clock::DAY_S;
        let is_cycle = is_night || clock::cycle_of(step, usual, cycles).is_some();
        if step < 0.0 && -step >= LEAST_FALL * span && !is_cycle && row - first >= LEAST_ROWS && goes_on(row) {
            starts.push(row);
        }
    }
    starts
}

/// First rows of the runs that a column of row numbers tells.
fn counter_starts(group: &Group, plan: &Plan) -> Vec<usize> {
    let extra = plan.targets.iter().filter(|t| !units::is_program_name(&t.name));
    let columns = extra.map(|t| &group.columns[t.column]).filter(|values| values.len() > LEAST_ROWS);
    let is_counter = |values: &&Vec<f64>| {
        let step = |w: &[f64]| w[1] - w[0] == 1.0 || w[1] == values[0] && w[1] < w[0];
        values[0].fract() == 0.0 && values.windows(2).all(step)
    };
    let mut counters = columns.filter(is_counter);
    counters.next().map_or(vec![0], |values| starts(values, &[]))
}

/// The rows of a run within each window of time that holds some; all of them without windows. An error without a clock.
pub fn within(
    windows: &[TimeWindow],
    (group, time_s): (Group, Option<Vec<f64>>),
    path: &Path,
) -> Result<Vec<Part>, LogError> {
    if windows.is_empty() {
        return Ok(vec![(None, group, time_s)]);
    }
    let Some(time) = time_s else {
        let why = "it states a window of time, but the log has no clock: state \"rate_hz\", or leave the window out";
        return Err(LogError::Sidecar { why: why.to_owned(), path: super::sidecar::path_for(path) });
    };
    let mut kept = Vec::new();
    for window in windows {
        let first = window.from_s.map_or(0, |from| time.partition_point(|t| *t < from));
        let end = window.to_s.map_or(time.len(), |to| time.partition_point(|t| *t <= to));
        if first < end {
            kept.push((Some(*window), group.rows_between(first, end), Some(time[first..end].to_vec())));
        }
    }
    Ok(kept)
}

/// Text of a window, for the name of its recording.
pub fn shown(window: TimeWindow) -> String {
    match (window.from_s, window.to_s) {
        (Some(from), Some(to)) => format!("{from} to {to} s"),
        (Some(from), None) => format!("from {from} s"),
        (None, Some(to)) => format!("up to {to} s"),
        (None, None) => "all".to_owned(),
    }
}

#[cfg(test)]
mod tests;
