//! From the table to recordings: time, channels, notes.

use super::errors::LogError;
use super::fingerprint::{Fingerprints, Shared};
use super::origin::Dated;
use super::plan::{Plan, Use};
use super::runs::Apart;
use super::stated_rate::STATED_RATE;
use super::table::{Group, Table};
use super::{checks, clock, facts, repairs, runs, second_clocks, sidecar, units};
use foundation::signal::chain::is_chain;
use foundation::signal::wrench::is_turned_sensor;
use haptics::recording::{Channel, Meta, RESAMPLED, Recording, TimeWindow, Warning};
use std::path::Path;

/// One recording for every group of the table. `said`: warnings of the format's reader.
pub fn recordings(
    mut table: Table,
    plan: &Plan,
    meta: &Meta,
    path: &Path,
    headers: &[String],
    said: &[Warning],
) -> Result<Vec<Dated>, LogError> {
    let apart = runs::apart(std::mem::take(&mut table.groups), plan, headers, path)?;
    let windows = meta.windows();
    let copies = copies(&table, plan, &apart);
    let mut said = said.to_vec();
    said.extend(apart.said.map(|text| note("runs", None, text)));
    let several = apart.runs.len() > 1;
    let mut recordings = Vec::with_capacity(apart.runs.len());
    let mut span_s: Option<(f64, f64)> = None;
    let mut used: Vec<TimeWindow> = Vec::new();
    for (trial, mut group) in apart.runs {
        let doubts = second_clocks::doubts(&group, plan, headers);
        let mut resampled = second_clocks::on_the_logs_clock(&mut group, plan, headers, path)?;
        resampled.extend(clock::on_one_clock(&mut group, plan, &table.sparse_columns, (headers, path))?);
        let clock::Times { time_s, said: about_time, origin } = clock::times(&mut group, plan, meta, headers, path)?;
        let ends = time_s.as_ref().and_then(|time| Some((*time.first()?, *time.last()?)));
        span_s = ends.map(|(a, b)| span_s.map_or((a, b), |(c, d)| (f64::min(a, c), f64::max(b, d)))).or(span_s);
        for (window, group, time_s) in runs::within(&windows, (group, time_s), path)? {
            used.extend(window);
            let part = window.filter(|_| windows.len() > 1).map(runs::shown);
            let run = trial.iter().filter(|_| several);
            let names: Vec<String> = run.clone().map(|run| format!("trial {run}")).chain(part.clone()).collect();
            let trial = if part.is_some() {
                Some(run.cloned().chain(part).collect::<Vec<_>>().join(", "))
            } else {
                trial.clone()
            };
            let about = About { plan, meta, path, headers, copies: &copies, table: &table };
            let name = names.iter().fold(String::new(), |all, name| format!("{all}, {name}"));
            let mut made = about.recording(group, (trial, name), time_s)?;
            let worded = |kind: &'static str| move |text: &String| note(kind, Some("t_s"), text.clone());
            let clock = resampled.iter().map(worded(RESAMPLED)).chain(about_time.iter().map(worded("clock")));
            // A log with a clock needs no rate.
            let said = said.iter().filter(|w| w.kind != STATED_RATE || made.time_s.is_none());
            let all: Vec<Warning> = said.cloned().chain(clock).chain(doubts.clone()).collect();
            made.warnings.splice(0..0, all);
            recordings.push(Dated { recording: made, origin });
        }
    }
    if let Some(empty) = windows.iter().find(|window| !used.contains(window)) {
        let (first_s, last_s) = span_s.unwrap_or_default();
        let (window, path) = (runs::shown(*empty), path.to_path_buf());
        return Err(LogError::EmptyWindow { window, first_s, last_s, path });
    }
    Ok(recordings)
}

/// Channels that two runs share. Runs by a column were compared while the file was read, those that are not selected included.
fn copies(table: &Table, plan: &Plan, apart: &Apart) -> Vec<Shared> {
    if apart.by_column && !plan.watched.is_empty() {
        return table.fingerprints.copies(&plan.watched);
    }
    let known = plan.targets.iter().filter(|target| units::is_program_name(&target.name)).map(|target| target.column);
    let known: Vec<usize> = known.filter(|column| !table.gappy_columns.contains(column)).collect();
    let named = apart.runs.iter().filter_map(|(name, group)| {
        Some((name.as_deref()?, known.iter().map(|&column| group.columns[column].as_slice()).collect()))
    });
    Fingerprints::of_runs(named).copies(&known)
}

/// Facts that hold for every recording of a file.
struct About<'a> {
    plan: &'a Plan,
    meta: &'a Meta,
    path: &'a Path,
    headers: &'a [String],
    /// Channels that repeat those of another trial.
    copies: &'a [Shared],
    table: &'a Table,
}

impl About<'_> {
    /// Seconds of the clock's stated unit, and the scale in a sidecar that makes seconds of it: that of an own name multiplies.
    fn clock_unit(&self) -> (f64, f64) {
        let Some(column) = self.plan.time else { return (1.0, 1.0) };
        let Use::Number { factor, .. } = self.plan.uses[column] else { return (1.0, 1.0) };
        let is_own = units::split(&self.headers[column]).is_some();
        (factor, if is_own { factor.recip() } else { 1.0 })
    }

    /// The recording of a group of rows. `names`: its trial, and the part of its name after the file's.
    fn recording(
        &self,
        mut group: Group,
        (trial, part): (Option<String>, String),
        time_s: Option<Vec<f64>>,
    ) -> Result<Recording, LogError> {
        let left_out: Vec<usize> = self.table.text_columns.iter().chain(&self.table.gappy_columns).copied().collect();
        let mut recording = Recording {
            name: name(self.path, &part),
            trial,
            time_s,
            channels: channels(&mut group, self.plan, &left_out),
            labels: self.plan.label.map(|_| std::mem::take(&mut group.labels)),
            meta: self.meta.clone(),
            warnings: Vec::new(),
        };
        if recording.channels.is_empty() {
            return Err(LogError::NoChannels { path: self.path.to_path_buf() });
        }
        if let Some(why) = facts::up_not_honoured(&recording) {
            return Err(LogError::Sidecar { why, path: sidecar::path_for(self.path) });
        }
        recording.warnings.extend(notes(self.plan, self.table, self.headers, &recording));
        recording.warnings.extend(facts::doubts(&recording));
        recording
            .warnings
            .extend(recording.time_s.as_deref().and_then(|time| clock::unit_doubt(time, self.clock_unit())));
        let repairs = repairs::repair(&mut recording);
        recording.warnings.extend(repairs);
        let is_repaired = recording.meta.repairs("spikes");
        recording.warnings.extend(checks::warnings_of(&recording, !is_repaired));
        recording.warnings.extend(checks::copied(&recording, self.plan, self.copies));
        Ok(recording)
    }
}

fn name(path: &Path, part: &str) -> String {
    let file = path.file_name().map_or_else(|| path.display().to_string(), |f| f.to_string_lossy().into_owned());
    file + part
}

/// The channels: columns are moved, and copied only where two names share one.
fn channels(group: &mut Group, plan: &Plan, left_out: &[usize]) -> Vec<Channel> {
    let mut made: Vec<Channel> = Vec::with_capacity(plan.targets.len());
    let mut owner: Vec<Option<usize>> = vec![None; plan.uses.len()];
    for target in &plan.targets {
        if left_out.contains(&target.column) || plan.uses[target.column] == Use::Ignore {
            continue;
        }
        let values = match owner[target.column] {
            Some(first) => made[first].values.clone(),
            None => std::mem::take(&mut group.columns[target.column]),
        };
        owner[target.column].get_or_insert(made.len());
        made.push(Channel { name: target.name.clone(), unit: target.unit.clone(), values });
    }
    made
}

fn note(kind: &str, column: Option<&str>, text: String) -> Warning {
    Warning { kind: kind.to_owned(), column: column.map(str::to_owned), spans: Vec::new(), text, ..Warning::default() }
}

/// Notes for the reader about the table itself.
fn notes(plan: &Plan, table: &Table, headers: &[String], recording: &Recording) -> Vec<Warning> {
    let mut notes: Vec<Warning> = plan.notes.iter().map(|n| note("columns", None, n.clone())).collect();
    notes.extend(table.notes.iter().map(|text| note("gap", None, text.clone())));
    let named = |c: usize| !headers[c].is_empty() && !plan.select.iter().any(|w| w.column == c);
    for &column in table.text_columns.iter().filter(|&&c| named(c)) {
        let name = &headers[column];
        notes.push(note("text-column", Some(name), format!("the column `{name}` holds text and is not used")));
    }
    for &column in table.gappy_columns.iter().filter(|&&c| named(c)) {
        let name = &headers[column];
        let text = format!("the column `{name}` has no value in some rows and is not used");
        notes.push(note("text-column", Some(name), text));
    }
    let is_known = recording.channels.iter().any(|c| units::is_program_name(&c.name));
    if !is_known && !is_chain(recording) && !is_turned_sensor(recording) {
        let text = "no column has a name that the program knows; map them with \"columns\" in the sidecar".to_owned();
        notes.push(note(super::NO_KNOWN_COLUMN, None, text));
    }
    // Poses need no clock.
    if recording.time_s.is_none() && !is_turned_sensor(recording) {
        let text = "the log has no clock (no t_s column, no rate_hz in the sidecar): paths and forces can be used; \
                    velocities, viscous friction, inertia and delays cannot be known"
            .to_owned();
        notes.push(note(super::NO_CLOCK, None, text));
    }
    notes
}
