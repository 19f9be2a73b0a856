//! Reading and writing logs: tables of samples with a sidecar of facts (`spec/logs.md`).
//!
//! [`load`] goes from the file to [`Recording`]s in SI units, or to one sentence that names the fault and its place.
//! The format is told by the content. Every reader ends in the same table, so every rule of the sidecar holds for every
//! format.

mod assemble;
mod bursts;
mod checks;
mod clock;
mod columnar;
mod csv;
mod errors;
mod facts;
mod fingerprint;
mod format;
mod join;
mod mat;
mod mcap;
mod origin;
mod pages;
#[cfg(feature = "parquet")]
mod parquet;
mod plan;
pub mod preview;
pub mod pyramid;
mod raw;
mod repairs;
mod room;
mod row_order;
mod rows;
mod runs;
mod second_clocks;
mod sidecar;
mod stated_rate;
mod suggested;
mod table;
mod text_clock;
pub mod units;
mod watch;
mod write;
pub mod written_units;

pub use self::clock::is_tick;
pub use self::csv::calendar::parse as stamp_ns;
pub use self::csv::text_table::TextTable;
pub use self::mcap::attached::attached;
pub use self::mcap::stream::McapStream;
pub use self::mcap::write::Encoding;
pub use checks::{ALTERNATION, UNIT, repaired, warnings as quality};
pub use errors::LogError;
pub use format::Format;
pub use plan::{PAIRS, counts_runs, sources};
pub use rows::Attachment;
pub use sidecar::{
    parse as parse_sidecar, path_for as sidecar_path, write as write_meta, write_as_is as write_sidecar,
};
pub use suggested::put_into as put_suggested;
pub use watch::Watch;
pub use write::{write, write_csv, write_encoded};

/// Kind of the warning about spikes of one sample, and about values that no hand reaches.
pub const SPIKES: &str = "outlier";
/// Kind of the warning that tells of a file that was joined, and of its clock.
pub const JOINED: &str = "joined";
/// The kind of the warning that a log has no clock.
pub const NO_CLOCK: &str = "no-clock";
/// The kind of the warning that no column has a name of the program.
pub const NO_KNOWN_COLUMN: &str = "no-known-column";

use haptics::recording::{JoinedFile, Meta, Recording, TimeWindow, Warning};
use origin::{Dated, Origin};
use raw::Raw;
use std::collections::BTreeMap;
use std::path::Path;

/// Largest file that is read, bytes (4 GiB): the table needs about as much memory again.
pub const MAX_BYTES: u64 = 4 << 30;

/// Reads a log and its sidecar (`meta`, or the one that a file of ours carries, or `<stem>.meta.json` beside it): one
/// recording for every run and window of time, in the order of the file.
pub fn load(path: &Path, meta: Option<&Path>) -> Result<Vec<Recording>, LogError> {
    load_watched(path, meta, &Watch::none())
}

/// Faults in the samples of a recording, with their places: [`load`] adds them to its warnings.
pub fn check(recording: &Recording) -> Vec<Warning> {
    checks::warnings(recording)
}

/// [`load`] that tells how far it has come and that can be ended from outside: then nothing is loaded.
pub fn load_watched(path: &Path, meta: Option<&Path>, watch: &Watch<'_>) -> Result<Vec<Recording>, LogError> {
    load_part(path, meta, &Part::default(), watch)
}

/// [`load_watched`] of a part of the log only.
pub fn load_part(path: &Path, meta: Option<&Path>, part: &Part, watch: &Watch<'_>) -> Result<Vec<Recording>, LogError> {
    let size = admissible_size(path)?;
    let beside = Box::new(sidecar::load(path, meta));
    let own = read(path, format::of(path)?, size, Facts::Found { beside, named: meta.is_some(), part }, watch)?;
    joined(own, path, watch)
}

/// The recordings of a log, with the files that its sidecar joins.
fn joined(own: Vec<Dated>, path: &Path, watch: &Watch<'_>) -> Result<Vec<Recording>, LogError> {
    let watch = Watch { cancelled: watch.cancelled, ..Watch::none() };
    join::files(own, path, &|other| {
        let size = admissible_size(other)?;
        let (beside, part) = (Box::new(sidecar::load(other, None)), Part::default());
        read(other, format::of(other)?, size, Facts::Found { beside, named: false, part: &part }, &watch)
    })
}

/// Runs and windows of time that are read: a caller's statement, which takes the place of the sidecar's.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Values of columns, as in the sidecar.
    pub select: BTreeMap<String, serde_json::Value>,
    /// Windows of time; none for all of it.
    pub windows: Vec<TimeWindow>,
    /// Other files of the same run; none for those of the sidecar. Paths from the log's folder, or absolute ones.
    pub join: Vec<JoinedFile>,
}

impl Part {
    fn put_into(&self, meta: &mut Meta) {
        meta.select.extend(self.select.clone());
        if !self.windows.is_empty() {
            (meta.from_s, meta.to_s) = (None, None);
            meta.windows.clone_from(&self.windows);
        }
        if !self.join.is_empty() {
            meta.join.clone_from(&self.join);
        }
    }
}

/// Reads a log with a sidecar that is already in memory (the app's mapping dialog).
pub fn load_with_meta(path: &Path, meta: &Meta) -> Result<Vec<Recording>, LogError> {
    load_with(path, meta, &Watch::none())
}

/// [`load_with_meta`] that tells how far it has come and that can be ended from outside.
pub fn load_with(path: &Path, meta: &Meta, watch: &Watch<'_>) -> Result<Vec<Recording>, LogError> {
    load_sized(path, meta, admissible_size(path)?, watch)
}

fn load_sized(path: &Path, meta: &Meta, size: u64, watch: &Watch<'_>) -> Result<Vec<Recording>, LogError> {
    if let Some(why) = facts::complaint(meta) {
        return Err(LogError::Sidecar { why, path: sidecar::path_for(path) });
    }
    joined(read(path, format::of(path)?, size, Facts::Given(meta), watch)?, path, watch)
}

/// Format of a file, told by its content.
pub fn format(path: &Path) -> Result<Format, LogError> {
    admissible_size(path)?;
    format::of(path)
}

/// The column names of a table, for a mapping dialog.
pub fn headers(path: &Path) -> Result<Vec<String>, LogError> {
    let size = admissible_size(path)?;
    let nothing = Meta::default();
    match format::of(path)? {
        Format::Csv => Ok(csv::sniff(path, None)?.headers),
        Format::Mat => Ok(mat::read(path, size, &Watch::none())?.0.headers),
        Format::Mcap => Ok(mcap::read(path, size, &Watch::none())?.columns(&nothing)?.0.headers),
        Format::Parquet => Ok(read_parquet(path, size, &Watch::none())?.0.headers),
    }
}

/// The beginning of a table of text, for a mapping dialog; `None` for another format.
pub fn text_table(path: &Path, most_bytes: u64) -> Result<Option<TextTable>, LogError> {
    admissible_size(path)?;
    let is_text = format::of(path)? == Format::Csv;
    is_text.then(|| csv::text_table::read(path, most_bytes)).transpose()
}

/// Name of the program, in SI units, and factor that a column has by its own name, without a sidecar. `unit`: text of its
/// unit outside the name. An error for a unit that is not known.
pub fn program_name(header: &str, unit: &str) -> Result<Option<(String, f64)>, LogError> {
    plan::program_name(header, unit)
}

/// Source of the facts about a log.
enum Facts<'a> {
    /// The caller.
    Given(&'a Meta),
    /// The sidecar beside the log (or why it cannot be read), which the caller may have named.
    Found { beside: Box<Result<Meta, LogError>>, named: bool, part: &'a Part },
}

impl Facts<'_> {
    /// The facts that hold, with a note when a sidecar beside is not used.
    fn settle(self, carried: Option<&str>, path: &Path) -> Result<(Meta, Option<Warning>), LogError> {
        match (self, carried) {
            (Self::Given(meta), _) => Ok((meta.clone(), None)),
            (Self::Found { beside, named: false, part }, Some(text)) => {
                let mut meta = sidecar::parse(text, path)?;
                // The columns of a file of ours are in SI units already: another file's mapping would spoil them.
                let file = sidecar::path_for(path);
                let stray = !beside.is_ok_and(|beside| beside == Meta::default() || beside == meta);
                let text =
                    format!("the log carries its own sidecar; {} is not used unless it is named", file.display());
                part.put_into(&mut meta);
                Ok((meta, stray.then(|| note("sidecar", text))))
            }
            (Self::Found { beside, part, .. }, _) => {
                let mut meta = (*beside)?;
                part.put_into(&mut meta);
                Ok((meta, None))
            }
        }
    }
}

fn note(kind: &str, text: String) -> Warning {
    Warning { kind: kind.to_owned(), column: None, spans: Vec::new(), text, ..Warning::default() }
}

fn read(path: &Path, format: Format, size: u64, facts: Facts<'_>, watch: &Watch<'_>) -> Result<Vec<Dated>, LogError> {
    let done = match format {
        Format::Csv => facts.settle(None, path).and_then(|(meta, _)| read_csv(path, &meta, size, watch)),
        Format::Mat => mat::read(path, size, watch).and_then(|(raw, said)| {
            let (meta, _) = facts.settle(None, path)?;
            finish(raw, &meta, path, &said)
        }),
        Format::Mcap => mcap::read(path, size, watch).and_then(|log| {
            let (meta, stray) = facts.settle(log.sidecar.as_deref(), path)?;
            let (raw, mut said) = log.columns(&meta)?;
            said.extend(stray);
            finish(raw, &meta, path, &said)
        }),
        Format::Parquet => read_parquet(path, size, watch).and_then(|(raw, carried, mut said)| {
            let (meta, stray) = facts.settle(carried.as_deref(), path)?;
            said.extend(stray);
            finish(raw, &meta, path, &said)
        }),
    };
    // A file that grows is reported as such, also when its end was half written.
    let after = std::fs::metadata(path).map_or(size, |m| m.len());
    if after != size {
        return Err(LogError::Grew { before: size, after, path: path.to_path_buf() });
    }
    done
}

fn read_csv(path: &Path, meta: &Meta, size: u64, watch: &Watch<'_>) -> Result<Vec<Dated>, LogError> {
    let dialect = csv::sniff(path, Some(meta))?;
    let mut plan = plan::plan(&dialect.headers, &dialect.units, meta, path)?;
    plan.take_stamps(&dialect.headers, &dialect.first, meta);
    plan.take_fraction_of_stamps(&dialect.headers);
    plan.give_clocks(&dialect.clocks);
    plan.note_spare(&dialect.headers, meta);
    let mut read = csv::read(path, &dialect, &plan, size, watch);
    // A day above 12 anywhere in the file settles the order of day and month.
    if matches!(read, Err(LogError::BadCell { .. })) && plan.turn_dates(&dialect.first) {
        read = csv::read(path, &dialect, &plan, size, watch).or(read);
    }
    let again = |plan: &plan::Plan| csv::read(path, &dialect, plan, size, watch);
    let mut table = plan.without_spare((&dialect.headers, meta), read, again)?;
    second_clocks::take_time(&mut table, &mut plan, meta, &dialect.headers);
    let mut said: Vec<Warning> = dialect.notes.iter().map(|text| note("layout", text.clone())).collect();
    said.extend(dialect.rate.iter().map(|(line, rate_hz)| stated_rate::doubt(line, *rate_hz)));
    plan.notes.extend(plan::Plan::doubt_about_dates(table.days));
    assemble::recordings(table, &plan, meta, path, &dialect.headers, &said)
}

/// From the columns of a container to recordings.
fn finish(mut raw: Raw, meta: &Meta, path: &Path, said: &[Warning]) -> Result<Vec<Dated>, LogError> {
    let headers = raw.headers.clone();
    let resolved = raw.resolved(meta);
    let mut plan = plan::plan(&headers, &raw.units, &resolved, path)?;
    plan.origin = raw.origin_ns.filter(|_| plan.time == Some(0)).map(|ns| Origin { ns, is_dated: true });
    let days = text_clock::take(&mut raw, &mut plan, &resolved, path)?;
    plan.notes.extend(plan::Plan::doubt_about_dates(days));
    let read = columnar::table(&mut raw, &plan, path);
    let mut table = plan.without_spare((&headers, &resolved), read, |plan| columnar::table(&mut raw, plan, path))?;
    drop(raw);
    second_clocks::take_time(&mut table, &mut plan, &resolved, &headers);
    assemble::recordings(table, &plan, meta, path, &headers, said)
}

#[cfg(feature = "parquet")]
fn read_parquet(path: &Path, size: u64, watch: &Watch<'_>) -> Result<parquet::Columns, LogError> {
    parquet::read(path, size, watch)
}

#[cfg(not(feature = "parquet"))]
fn read_parquet(path: &Path, _size: u64, _watch: &Watch<'_>) -> Result<(Raw, Option<String>, Vec<Warning>), LogError> {
    let why = "Parquet was left out when this program was built".to_owned();
    Err(LogError::NoColumns { format: "Parquet", why, path: path.to_path_buf() })
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

#[cfg(test)]
mod formats_tests;
#[cfg(test)]
mod table_tests;
#[cfg(test)]
mod tests;
