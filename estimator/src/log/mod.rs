//! Reading logs: tables of samples with a sidecar of facts (`spec/logs.md`).
//!
//! [`load`] goes from the file to [`Recording`]s in SI units, or to one sentence that says what is wrong and where.

mod checks;
mod csv;
mod errors;
mod facts;
mod fingerprint;
mod plan;
mod sidecar;
mod table;
pub mod units;
mod watch;
mod write;

pub use errors::LogError;
pub use sidecar::{path_for as sidecar_path, write as write_meta, write_as_is as write_sidecar};
pub use watch::Watch;
pub use write::write_csv;

use haptics::recording::{Channel, Meta, Recording, Warning};
use plan::{Plan, Use};
use std::path::Path;
use table::{Group, Table};

/// Largest file that is read, bytes (4 GiB): the table needs about as much memory again.
pub const MAX_BYTES: u64 = 4 << 30;

/// Reads a log and its sidecar (`meta`, or `<stem>.meta.json` beside it): one recording for every value of the `trial`
/// column, in the order of the file, else one.
pub fn load(path: &Path, meta: Option<&Path>) -> Result<Vec<Recording>, LogError> {
    load_watched(path, meta, &Watch::none())
}

/// [`load`] that tells how far it has come and that can be ended from outside: then nothing is loaded.
pub fn load_watched(path: &Path, meta: Option<&Path>, watch: &Watch<'_>) -> Result<Vec<Recording>, LogError> {
    let size = admissible_size(path)?;
    let meta = sidecar::load(path, meta)?;
    load_with(path, &meta, size, watch)
}

/// Reads a log with a sidecar that is already in memory (the app's mapping dialog).
pub fn load_with_meta(path: &Path, meta: &Meta) -> Result<Vec<Recording>, LogError> {
    let size = admissible_size(path)?;
    if let Some(why) = facts::complaint(meta) {
        return Err(LogError::Sidecar { why, path: sidecar::path_for(path) });
    }
    load_with(path, meta, size, &Watch::none())
}

/// The column names of a table, for a mapping dialog.
pub fn headers(path: &Path) -> Result<Vec<String>, LogError> {
    admissible_size(path)?;
    Ok(csv::sniff(path)?.headers)
}

fn load_with(path: &Path, meta: &Meta, size: u64, watch: &Watch<'_>) -> Result<Vec<Recording>, LogError> {
    let dialect = csv::sniff(path)?;
    let plan = plan::plan(&dialect.headers, meta, path)?;
    let table = csv::read(path, &dialect, &plan, size, watch);
    // A table that grows is reported as such, also when its last line was half written.
    let after = std::fs::metadata(path).map_or(size, |m| m.len());
    if after != size {
        return Err(LogError::Grew { before: size, after, path: path.to_path_buf() });
    }
    assemble(table?, &plan, meta, path, &dialect.headers)
}

/// Size of a file that can be read.
fn admissible_size(path: &Path) -> Result<u64, LogError> {
    let owned = || path.to_path_buf();
    let facts = std::fs::metadata(path).map_err(|e| LogError::Io { reason: e.to_string(), path: owned() })?;
    if facts.is_dir() {
        return Err(LogError::Directory { path: owned() });
    }
    if !facts.is_file() {
        return Err(LogError::NotAFile { path: owned() });
    }
    if facts.len() > MAX_BYTES {
        let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
        return Err(LogError::TooLarge { size_gib: gib(facts.len()), limit_gib: gib(MAX_BYTES), path: owned() });
    }
    if facts.len() == 0 {
        return Err(LogError::Empty { path: owned() });
    }
    Ok(facts.len())
}

fn assemble(
    mut table: Table,
    plan: &Plan,
    meta: &Meta,
    path: &Path,
    headers: &[String],
) -> Result<Vec<Recording>, LogError> {
    let groups = std::mem::take(&mut table.groups);
    let several = groups.len() > 1;
    let copies = table.fingerprints.copies();
    let mut recordings = Vec::with_capacity(groups.len());
    for (trial, mut group) in groups {
        let time_s = time(&mut group, plan, meta, headers, path)?;
        let mut recording = Recording {
            name: name(path, trial.as_deref().filter(|_| several)),
            trial,
            time_s,
            channels: channels(&mut group, plan, &table.text_columns),
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
        recording.warnings = notes(plan, &table, headers, &recording);
        recording.warnings.extend(facts::doubts(&recording));
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

/// Takes the time column out of the group and checks that it increases; made from `rate_hz` when there is none.
fn time(
    group: &mut Group,
    plan: &Plan,
    meta: &Meta,
    headers: &[String],
    path: &Path,
) -> Result<Option<Vec<f64>>, LogError> {
    let Some(column) = plan.time else {
        let rows = group.rows();
        return Ok(meta.rate_hz.map(|rate| (0..rows).map(|i| i as f64 / rate).collect()));
    };
    let time = std::mem::take(&mut group.columns[column]);
    if let Some(i) = time.windows(2).position(|w| w[1] <= w[0]) {
        let (row, line) = group.place(i + 1);
        let how = if time[i + 1] < time[i] { "goes backwards" } else { "stands still" };
        return Err(LogError::Time {
            row,
            line,
            column: headers[column].clone(),
            how,
            previous: time[i],
            time: time[i + 1],
            path: path.to_path_buf(),
        });
    }
    Ok(Some(time))
}

/// The channels: columns are moved, and copied only where two names share one.
fn channels(group: &mut Group, plan: &Plan, text_columns: &[usize]) -> Vec<Channel> {
    let mut made: Vec<Channel> = Vec::with_capacity(plan.targets.len());
    let mut owner: Vec<Option<usize>> = vec![None; plan.uses.len()];
    for target in &plan.targets {
        if text_columns.contains(&target.column) || plan.uses[target.column] == Use::Ignore {
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

/// What the reader should know about the table itself.
fn notes(plan: &Plan, table: &Table, headers: &[String], recording: &Recording) -> Vec<Warning> {
    let note = |kind: &str, column: Option<&str>, text: String| Warning {
        kind: kind.to_owned(),
        column: column.map(str::to_owned),
        spans: Vec::new(),
        text,
    };
    let mut notes: Vec<Warning> = plan.notes.iter().map(|n| note("columns", None, n.clone())).collect();
    let named = |c: usize| !headers[c].is_empty() && !plan.select.iter().any(|w| w.column == c);
    for &column in table.text_columns.iter().filter(|&&c| named(c)) {
        let name = &headers[column];
        notes.push(note("text-column", Some(name), format!("the column `{name}` holds text and is not used")));
    }
    if !recording.channels.iter().any(|c| units::is_program_name(&c.name)) {
        let text = "no column has a name that the program knows; map them with \"columns\" in the sidecar".to_owned();
        notes.push(note("no-known-column", None, text));
    }
    if recording.time_s.is_none() {
        let text = "the log has no clock (no t_s column, no rate_hz in the sidecar): paths and forces can be used; \
                    velocities, viscous friction, inertia and delays cannot be known"
            .to_owned();
        notes.push(note("no-clock", None, text));
    }
    notes
}

#[cfg(test)]
mod tests;
