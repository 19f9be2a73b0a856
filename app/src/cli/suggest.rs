//! `touchstone info --suggest`: the shortest sidecar with which a file is read, or read without doubts.

use super::Output;
use crate::ui::column_mapping::draft::Draft;
use crate::ui::column_mapping::facts::look;
use crate::ui::column_mapping::names::dimension;
use crate::ui::column_mapping::state::mends;
use estimator::log::units;
use estimator::log::{
    ALTERNATION, LogError, NO_CLOCK, NO_KNOWN_COLUMN, UNIT, load, parse_sidecar, put_suggested, sidecar_path,
};
use estimator::signal::wrench::is_turned_sensor;
use haptics::recording::{Recording, Suggested, Warning};
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Suggestions that follow from each other.
const ROUNDS: usize = 8;
/// Name of the sidecar in which entries are tried.
const TRIED: &str = "suggested.meta.json";

/// Output of `info --suggest --json`.
#[derive(JsonSchema, Serialize)]
pub(crate) struct Said {
    /// The sidecar's file.
    path: PathBuf,
    /// Its entries, with null for a value that only the user knows.
    sidecar: Suggested,
    /// True if the file was written, false if there was nothing to add.
    written: bool,
    /// The first doubt or error that stays.
    open: Option<String>,
}

/// Entries of a sidecar that make a log load without doubts.
struct Search<'a> {
    log: &'a Path,
    /// The user's sidecar, as sentences name it.
    sidecar: &'a Path,
    /// Folder of the sidecar in which the entries are tried.
    tried: tempfile::TempDir,
    entries: Suggested,
    has_guessed: bool,
    /// Sentences about units that were inferred from values.
    guesses: Vec<String>,
}

impl Search<'_> {
    /// Reads the log with the entries so far.
    fn read(&self) -> anyhow::Result<Result<Vec<Recording>, LogError>> {
        let sidecar = self.tried.path().join(TRIED);
        std::fs::write(&sidecar, Value::Object(self.entries.clone()).to_string())?;
        Ok(load(self.log, Some(&sidecar)))
    }

    /// Takes the meanings of the columns from their names and values, but for those that the entries have; false if that was done
    /// before.
    fn guess(&mut self) -> anyhow::Result<bool> {
        if self.has_guessed {
            return Ok(false);
        }
        self.has_guessed = true;
        let meta = parse_sidecar(&Value::Object(self.entries.clone()).to_string(), self.sidecar)?;
        let mut draft = Draft::new(&look(self.log)?, meta);
        draft.guess_the_rest();
        let Value::Object(mut guessed) = serde_json::to_value(draft.sidecar())? else { return Ok(false) };
        for row in &draft.rows {
            let Some(name) = row.name().filter(|name| dimension(name).is_some()) else { continue };
            let header = &row.facts.header;
            if let Some(rival) = &row.rival {
                self.guesses.push(format!("`{header}` and `{rival}` may both be `{name}`: check which one is meant"));
            }
            if let Some((value, _)) = row.facts.range.filter(|(low, high)| low == high) {
                self.guesses.push(format!(
                    "`{header}` is {value} in every row: map another column to `{name}` if there is one"
                ));
            }
            if row.unit_stated || [name, header].iter().any(|key| draft.meta.scale.contains_key(*key)) {
                continue;
            }
            // Only the user knows the factor of a unit that the reader does not know.
            if row.needs_a_factor() {
                put_suggested(&factor_of(name), &mut guessed);
            } else if let Some(unit) = row.unit {
                self.guesses.push(format!("`{header}` states no unit; by its values it is {}: check it", unit.shown));
            }
        }
        let is_new = guessed != self.entries;
        self.entries = guessed;
        Ok(is_new)
    }

    /// Takes entries in; false if they say nothing new.
    fn take(&mut self, suggested: &Suggested) -> bool {
        let before = self.entries.clone();
        put_suggested(suggested, &mut self.entries);
        self.entries != before
    }

    /// Takes in the entries that settle a doubt, and keeps one about a unit open; false if they say nothing new.
    fn settle(&mut self, doubt: &Warning) -> bool {
        let is_taken = doubt.suggested.as_ref().is_some_and(|entries| self.take(entries));
        self.guesses.extend(Some(&doubt.text).filter(|_| is_taken && doubt.kind == UNIT).cloned());
        is_taken
    }

    /// One step: true if there was one, and the problem that it is about.
    fn step(&mut self) -> anyhow::Result<(bool, Option<String>)> {
        Ok(match self.read()? {
            Ok(recordings) => {
                let mut warnings = recordings.iter().flat_map(|r| &r.warnings);
                let is_mute = warnings.clone().any(|w| [NO_KNOWN_COLUMN, NO_CLOCK].contains(&w.kind.as_str()))
                    || recordings.iter().any(|recording| !has_motion_and_force(recording));
                let doubt = warnings.find(|w| w.suggested.is_some() && holds_for_all(w, &recordings));
                // Poses need no clock.
                let has_no_clock = recordings.iter().any(|r| r.time_s.is_none() && !is_turned_sensor(r));
                let has_step = is_mute && self.guess()?
                    || doubt.is_some_and(|doubt| self.settle(doubt))
                    || has_no_clock && !self.entries.contains_key("rate_hz") && self.take(&asked("rate_hz"));
                let is_open = |w: &&Warning| [UNIT, ALTERNATION].contains(&w.kind.as_str());
                let open = doubt.or_else(|| recordings.iter().flat_map(|r| &r.warnings).find(is_open));
                (has_step, open.map(|w| w.text.clone()).or_else(|| recordings.iter().find_map(missing)))
            }
            Err(error) => {
                let has_step = match error.suggested() {
                    Some(entries) => self.take(&entries),
                    None => mends(&error) && self.guess()?,
                };
                let tried = self.tried.path().join(TRIED).display().to_string();
                (has_step, Some(error.to_string().replace(&tried, &self.sidecar.display().to_string())))
            }
        })
    }
}

/// False for a factor that some recordings of the file do not need.
fn holds_for_all(doubt: &Warning, recordings: &[Recording]) -> bool {
    let is_factor = doubt.suggested.as_ref().is_some_and(|entries| entries.contains_key("scale"));
    let has_it = |recording: &Recording| recording.warnings.iter().any(|other| other.suggested == doubt.suggested);
    !is_factor || recordings.iter().all(has_it)
}

/// True for a recording with a motion and a force.
fn has_motion_and_force(recording: &Recording) -> bool {
    has_force(recording) && has_motion(recording)
}

fn has_force(recording: &Recording) -> bool {
    is_turned_sensor(recording) || has_quantity(recording, &["f", "tau"])
}

fn has_motion(recording: &Recording) -> bool {
    is_turned_sensor(recording) || has_quantity(recording, &["q", "dq", "ddq", "x", "y", "z", "v"])
}

/// True for a recording with a channel of the program's whose quantity starts with one of these.
fn has_quantity(recording: &Recording, starts: &[&str]) -> bool {
    let known = recording.channels.iter().filter(|channel| units::is_program_name(&channel.name));
    let mut quantities = known.filter_map(|channel| units::split(&channel.name)).map(|(quantity, _)| quantity);
    quantities.any(|quantity| starts.iter().any(|start| quantity.starts_with(start)))
}

/// A sentence if no column was found that is a motion, or a force.
fn missing(recording: &Recording) -> Option<String> {
    let absent = match (has_motion(recording), has_force(recording)) {
        (true, true) => return None,
        (true, false) => "force or torque",
        (false, true) => "motion",
        (false, false) => "motion or a force",
    };
    let names: Vec<String> = recording.channels.iter().map(|channel| format!("`{}`", channel.name)).collect();
    let there = if names.is_empty() { "no other one".to_owned() } else { names.join(", ") };
    Some(format!(
        "no column is recognized as a {absent}: if one is, map it with \"columns\" in the sidecar; beside the clock, the file has {there}"
    ))
}

/// Entries that ask for the factor of a column.
fn factor_of(name: &str) -> Suggested {
    Suggested::from_iter([("scale".to_owned(), Value::Object(asked(name)))])
}

/// An entry whose value only the user knows.
fn asked(key: &str) -> Suggested {
    Suggested::from_iter([(key.to_owned(), Value::Null)])
}

/// True for entries with a value that only the user knows.
fn has_null(entries: &Suggested) -> bool {
    let is_open = |value: &Value| match value {
        Value::Object(members) => members.values().any(Value::is_null),
        other => other.is_null(),
    };
    entries.iter().any(|(key, value)| key != "columns" && is_open(value))
}

/// Finds the sidecar of a log and writes it beside the log.
pub fn run(log: &Path, given: Option<&Path>) -> anyhow::Result<Output> {
    let path = given.map_or_else(|| sidecar_path(log), Path::to_path_buf);
    let before: Suggested = match std::fs::read_to_string(&path) {
        Ok(text) => serde_json::from_str(text.trim_start_matches('\u{feff}'))?,
        Err(_) => Suggested::new(),
    };
    let tried = tempfile::tempdir()?;
    let mut search =
        Search { log, sidecar: &path, tried, entries: before.clone(), has_guessed: false, guesses: Vec::new() };
    let mut open = None;
    for _ in 0..ROUNDS {
        let (has_step, problem) = search.step()?;
        if !has_step {
            open = problem;
            break;
        }
        if has_null(&search.entries) {
            open = Some("state the values in place of null".to_owned());
            break;
        }
    }
    let open = open.or_else(|| (!search.guesses.is_empty()).then(|| search.guesses.join("; ")));
    let written = search.entries != before;
    let sidecar = search.entries;
    let shown = serde_json::to_string_pretty(&sidecar)?;
    if written {
        haptics::text_file::write(&path, format!("{shown}\n"))?;
    }
    let mut text = if written {
        format!("{shown}\nwritten to {}", path.display())
    } else {
        "there is nothing to add to the sidecar".to_owned()
    };
    if let Some(open) = &open {
        text = format!("{text}\nstill open: {open}");
    }
    let json = serde_json::to_value(Said { path, sidecar, written, open })?;
    Ok(Output { text, json })
}
