//! The folder of recordings, their names, and the search for unfinished ones.
//!
//! While a recording is written, a locked marker file is beside it. A killed process leaves the marker without its
//! lock. Its recording thus differs from one that another window is writing, and from one already reported to the user.

use std::fs::{File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// File extension of recordings.
const ENDING: &str = "mcap";
/// File extension of markers.
const MARKER: &str = "recording";
/// Maximum number of recordings of one world per day.
const MOST_A_DAY: u32 = 9_999;
/// Time in which a recording follows its marker. Choice: a thousand times the time between both on an idle disk.
const BEGINS: Duration = Duration::from_secs(1);

/// The user's folder for recordings; `None` if the system defines no data folder.
pub fn of_user() -> Option<PathBuf> {
    eframe::storage_dir("touchstone").map(|folder| folder.join("recordings"))
}

/// Marker of a recording that is being written.
pub struct Marker {
    path: PathBuf,
    /// Locked as long as it is open.
    _locked: File,
}

impl Marker {
    /// Removes the marker: the recording is complete, or its problem was reported.
    pub fn remove(self) {
        // If the marker remains, the recording is offered once more at the next start.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Creates the file of a recording in this world, and its marker. The error is one sentence.
pub fn reserve(folder: &Path, world: &str) -> Result<(PathBuf, Marker), String> {
    let refused = |error: std::io::Error| {
        let folder = folder.display();
        format!("The recording cannot be written ({error}); check the folder and its permissions: {folder}.")
    };
    std::fs::create_dir_all(folder).map_err(refused)?;
    let stem = format!("{}_{}", date(SystemTime::now()), plain(world));
    for number in 1..=MOST_A_DAY {
        let path = folder.join(format!("{stem}_{number}.{ENDING}"));
        let marker = path.with_extension(MARKER);
        // Before the file: at no moment can a killed process leave a recording without a marker.
        let locked = match OpenOptions::new().write(true).create_new(true).open(&marker) {
            Ok(locked) => locked,
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => continue,
            Err(error) => return Err(refused(error)),
        };
        // Without file locks, another window offers this file as unfinished: untidy, but nothing is lost.
        // A window that looks for unfinished recordings holds the lock for a moment.
        let _ = locked.lock();
        let marker = Marker { path: marker, _locked: locked };
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(_) => return Ok((path, marker)),
            Err(error) => {
                marker.remove();
                if error.kind() != std::io::ErrorKind::AlreadyExists {
                    return Err(refused(error));
                }
            }
        }
    }
    Err(format!("There are {MOST_A_DAY} recordings of today already; move some away: {}.", folder.display()))
}

/// Recordings that a killed process left without their end, the oldest first.
pub fn unfinished(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let markers = entries.flatten().map(|entry| entry.path()).filter(|p| p.extension().is_some_and(|e| e == MARKER));
    let mut found: Vec<PathBuf> = markers.filter_map(|marker| left_behind(&marker)).collect();
    found.sort();
    found
}

/// Recording of a marker that nobody has locked.
fn left_behind(marker: &Path) -> Option<PathBuf> {
    let file = OpenOptions::new().write(true).open(marker).ok()?;
    if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
        return None; // another window is writing it
    }
    let recording = marker.with_extension(ENDING);
    if has_end(&recording) {
        // Killed before the first byte, or between the end of the file and the removal of the marker; or the recording
        // was deleted.
        if has_bytes(&recording) || !is_new(&file) {
            let _ = std::fs::remove_file(marker);
        }
        return None;
    }
    Some(recording)
}

fn has_bytes(recording: &Path) -> bool {
    recording.metadata().is_ok_and(|facts| facts.len() > 0)
}

/// True for a marker whose recording another window may be about to create: without it, that recording lost its marker.
fn is_new(marker: &File) -> bool {
    let age = marker.metadata().and_then(|facts| facts.modified()).ok().and_then(|made| made.elapsed().ok());
    age.is_some_and(|age| age < BEGINS)
}

/// True for a file with MCAP's end magic, and for an empty or missing one.
fn has_end(recording: &Path) -> bool {
    use std::io::{Read as _, Seek as _, SeekFrom};
    const MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";
    let Ok(mut file) = File::open(recording) else { return true };
    let (mut end, length) = ([0; MAGIC.len()], MAGIC.len() as u64);
    let size = file.metadata().map_or(0, |facts| facts.len());
    // A file with only its first eight bytes has no end.
    size == 0
        || size > 2 * length
            && file.seek(SeekFrom::End(-(length.cast_signed()))).is_ok()
            && file.read_exact(&mut end).is_ok()
            && end == MAGIC
}

/// Removes the marker: the user knows of the recording, so it is not offered again.
pub fn forget(recording: &Path) {
    // If this fails, the recording is offered once more.
    let _ = std::fs::remove_file(recording.with_extension(MARKER));
}

/// World name as part of a file name.
fn plain(world: &str) -> String {
    let plain: String = world.chars().map(|c| if c.is_alphanumeric() || c == '-' { c } else { '-' }).take(40).collect();
    let plain = plain.trim_matches('-');
    if plain.is_empty() { "world".to_owned() } else { plain.to_owned() }
}

/// Date in UTC, `2026-11-21`. The standard library has no local time.
fn date(now: SystemTime) -> String {
    let seconds = now.duration_since(SystemTime::UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (year, month, day) = civil(i64::try_from(seconds / 86_400).unwrap_or(0));
    format!("{year:04}-{month:02}-{day:02}")
}

/// Year, month and day of a number of days since 1970-01-01, in the Gregorian calendar. Source: H. Hinnant,
/// *chrono-compatible low-level date algorithms* (years begin in March, eras have 400 of them).
fn civil(days: i64) -> (i64, i64, i64) {
    let days = days + 719_468;
    let (era, day_of_era) = (days.div_euclid(146_097), days.rem_euclid(146_097));
    let year_of_era = (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let march_month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * march_month + 2) / 5 + 1;
    let month = if march_month < 10 { march_month + 3 } else { march_month - 9 };
    (year_of_era + 400 * era + i64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        for (days, expected) in [
            (0, (1970, 1, 1)),
            (58, (1970, 2, 28)),
            (11_016, (2000, 2, 29)),
            (11_017, (2000, 3, 1)),
            (20_453, (2025, 12, 31)),
            (20_454, (2026, 1, 1)),
            (47_541, (2100, 3, 1)),
        ] {
            assert_eq!(civil(days), expected, "{days}");
        }
        assert_eq!(date(SystemTime::UNIX_EPOCH + Duration::from_secs(1_000_000_000)), "2001-09-09");
    }

    #[test]
    fn names_are_counted_and_stay_in_the_folder() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let names: Vec<String> = [("two blocks", 1), ("two blocks", 2), ("../../x", 1), ("", 1)]
            .map(|(world, number)| {
                let (path, marker) = reserve(folder.path(), world).expect("reserves");
                marker.remove();
                assert_eq!(path.parent(), Some(folder.path()));
                let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
                assert!(name.ends_with(&format!("_{number}")), "{name}");
                name[11..].to_owned()
            })
            .to_vec();
        assert_eq!(names, ["two-blocks_1", "two-blocks_2", "x_1", "world_1"]);
    }

    #[test]
    fn what_was_left_without_its_end_is_found_until_it_is_known() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let (path, marker) = reserve(folder.path(), "crank").expect("reserves");
        std::fs::write(&path, b"\x89MCAP0\r\n and no end").expect("writes");
        assert_eq!(unfinished(folder.path()), Vec::<PathBuf>::new(), "it is being written");
        // A killed process: the lock is released, the marker stays.
        drop(marker);
        assert_eq!(unfinished(folder.path()), std::slice::from_ref(&path));
        forget(&path);
        assert_eq!(unfinished(folder.path()), Vec::<PathBuf>::new());
        let (whole, marker) = reserve(folder.path(), "crank").expect("reserves");
        drop(marker);
        std::fs::write(&whole, b"\x89MCAP0\r\n and all the rest \x89MCAP0\r\n").expect("writes");
        assert_eq!(unfinished(folder.path()), Vec::<PathBuf>::new(), "it has its end");
        assert!(!whole.with_extension(MARKER).exists());
        let (begun, marker) = reserve(folder.path(), "crank").expect("reserves");
        drop(marker);
        assert_eq!(unfinished(folder.path()), Vec::<PathBuf>::new(), "it has no byte yet");
        std::fs::write(&begun, b"\x89MCAP0\r\n and no end").expect("writes");
        assert_eq!(unfinished(folder.path()), std::slice::from_ref(&begun), "its marker stayed");
        assert_eq!(unfinished(Path::new("/nowhere/at/all")), Vec::<PathBuf>::new());
    }
}
