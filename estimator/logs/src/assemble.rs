//! From the table to recordings: time, channels, notes.

use super::errors::LogError;
use super::plan::{Plan, Use};
use super::table::{Group, Table};
use super::{checks, clock, facts, repairs, sidecar, units};
use foundation::signal::chain::is_chain;
use foundation::signal::wrench::is_turned_sensor;
use haptics::recording::{Channel, Meta, Recording, Warning};
use std::path::Path;

/// One recording for every group of the table. `said`: warnings of the format's reader.
pub fn recordings(
    mut table: Table,
    plan: &Plan,
    meta: &Meta,
    path: &Path,
    headers: &[String],
    said: &[Warning],
) -> Result<Vec<Recording>, LogError> {
    let groups = std::mem::take(&mut table.groups);
    let several = groups.len() > 1;
    let copies = table.fingerprints.copies();
    let left_out: Vec<usize> = table.text_columns.iter().chain(&table.gappy_columns).copied().collect();
    let mut recordings = Vec::with_capacity(groups.len());
    for (trial, mut group) in groups {
        let mut about_time = clock::on_one_clock(&mut group, plan, &table.sparse_columns, headers);
        let (time_s, said_of_time) = clock::times(&mut group, plan, meta, headers, path)?;
        about_time.extend(said_of_time);
        let mut recording = Recording {
            name: name(path, trial.as_deref().filter(|_| several)),
            trial,
            time_s,
            channels: channels(&mut group, plan, &left_out),
            labels: plan.label.map(|_| std::mem::take(&mut group.labels)),
            meta: meta.clone(),
            warnings: Vec::new(),
        };
        if recording.channels.is_empty() {
            let why = "no column holds numbers beside the time".to_owned();
            return Err(LogError::NotATable { why, path: path.to_path_buf() });
        }
        if let Some(why) = facts::up_not_honoured(&recording) {
            return Err(LogError::Sidecar { why, path: sidecar::path_for(path) });
        }
        recording.warnings = said.to_vec();
        recording.warnings.extend(about_time.into_iter().map(|text| note("clock", Some("t_s"), text)));
        recording.warnings.extend(notes(plan, &table, headers, &recording));
        recording.warnings.extend(facts::doubts(&recording));
        let repairs = repairs::repair(&mut recording);
        recording.warnings.extend(repairs);
        recording.warnings.extend(checks::warnings(&recording));
        recording.warnings.extend(checks::copied(&recording, plan, &copies));
        recordings.push(recording);
    }
    Ok(recordings)
}

fn name(path: &Path, trial: Option<&str>) -> String {
    let file = path.file_name().map_or_else(|| path.display().to_string(), |f| f.to_string_lossy().into_owned());
    trial.map_or(file.clone(), |t| format!("{file}, trial {t}"))
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
    Warning { kind: kind.to_owned(), column: column.map(str::to_owned), spans: Vec::new(), text }
}

/// Notes for the reader about the table itself.
fn notes(plan: &Plan, table: &Table, headers: &[String], recording: &Recording) -> Vec<Warning> {
    let mut notes: Vec<Warning> = plan.notes.iter().map(|n| note("columns", None, n.clone())).collect();
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
        notes.push(note("no-known-column", None, text));
    }
    if recording.time_s.is_none() {
        let text = "the log has no clock (no t_s column, no rate_hz in the sidecar): paths and forces can be used; \
                    velocities, viscous friction, inertia and delays cannot be known"
            .to_owned();
        notes.push(note(super::NO_CLOCK, None, text));
    }
    notes
}
