//! Attempts that the database has rejected: one JSON file each in a folder beside it, until it accepts them.
//!
//! A file is named after the start of its attempt, but never before one that is already waiting. The import
//! thus keeps the order in which they were made, even if the clock was set back between them.

use crate::history::attempt::Attempt;
use crate::history::store::Store;
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// Folder of a database at this path.
fn folder(database: &Path) -> PathBuf {
    database.with_extension("waiting")
}

/// Position encoded in a file's name; `None` for a foreign name.
fn place(path: &Path) -> Option<(i128, u32)> {
    let (moment, number) = path.file_stem()?.to_str()?.rsplit_once('-')?;
    Some((moment.parse().ok()?, number.parse().ok()?))
}

/// Waiting files, in order.
fn waiting(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let waits = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "json");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).filter(waits).collect();
    paths.sort_by_cached_key(|path| (place(path), path.clone()));
    paths
}

/// Stores an attempt beside the database; it is on the disk on return.
pub fn keep(database: &Path, attempt: &Attempt) -> Result<PathBuf, String> {
    let refused = |error: std::io::Error| {
        format!("The attempt could not be kept ({error}); check the disk and its permissions: {}.", database.display())
    };
    let folder = folder(database);
    std::fs::create_dir_all(&folder).map_err(refused)?;
    let text = serde_json::to_string_pretty(attempt).map_err(|error| refused(error.into()))?;
    // All or nothing: written under another name first.
    let mut whole = tempfile::NamedTempFile::new_in(&folder).map_err(refused)?;
    whole.write_all(text.as_bytes()).and_then(|()| whole.as_file().sync_all()).map_err(refused)?;
    let began = (attempt.began.as_nanosecond(), 0_u32);
    let last = waiting(&folder).iter().filter_map(|path| place(path)).max();
    let (moment, mut number) = last.map_or(began, |(moment, number)| began.max((moment, number.saturating_add(1))));
    loop {
        let path = folder.join(format!("{moment}-{number}.json"));
        match whole.persist_noclobber(&path) {
            Ok(_) => {
                // The name, too, must be on the disk; where folders cannot be synced, this happens by itself.
                let _ = File::open(&folder).and_then(|folder| folder.sync_all());
                return Ok(path);
            }
            Err(error) if error.error.kind() == std::io::ErrorKind::AlreadyExists => whole = error.file,
            Err(error) => return Err(refused(error.error)),
        }
        number += 1;
    }
}

/// Imports the attempts that wait beside the database. Returns their number, and the problems of unreadable files,
/// which stay where they are. If the database rejects one, that is the error, and those behind it continue to wait.
pub fn take_in(database: &Path, store: &mut Store) -> (usize, Vec<String>, Result<(), String>) {
    let (mut taken, mut problems) = (0, Vec::new());
    for path in waiting(&folder(database)) {
        let read = haptics::text_file::read(&path).map_err(|error| error.to_string());
        let attempt = read.and_then(|text| serde_json::from_str::<Attempt>(&text).map_err(|error| error.to_string()));
        match attempt {
            Err(error) => {
                problems
                    .push(format!("An attempt that waits to be kept cannot be read ({error}): {}.", path.display()));
            }
            Ok(attempt) => match store.keep_waiting(&attempt) {
                Ok(_) => {
                    // If the file remains, it is recognized as a duplicate at the next start.
                    let _ = std::fs::remove_file(&path);
                    taken += 1;
                }
                Err(problem) => return (taken, problems, Err(problem)),
            },
        }
    }
    (taken, problems, Ok(()))
}
