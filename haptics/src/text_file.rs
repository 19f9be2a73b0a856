//! Small text files, ours and those of others: worlds, sidecars, tasks, lessons, keys.
//!
//! A file of gigabytes under such a name is a mistake or malice; it is refused before memory is taken for it.

use std::fs::File;
use std::io::{Error, ErrorKind, Read as _, Result, Write as _};
use std::path::{Path, PathBuf};

/// Largest text that is read, bytes (64 MiB): a hundred times the largest world.
pub const MAX_BYTES: u64 = 64 << 20;

/// The text of a file of at most [`MAX_BYTES`].
///
/// # Errors
/// Errors of the system; [`ErrorKind::FileTooLarge`] for a longer file, [`ErrorKind::InvalidData`] if it is not text.
pub fn read(path: &Path) -> Result<String> {
    let file = File::open(path)?;
    let size = file.metadata()?.len();
    if size > MAX_BYTES {
        return Err(too_large());
    }
    // Anything but a plain file states no size, and a file may grow: never more than the limit is taken in.
    let mut text = String::new();
    file.take(MAX_BYTES + 1).read_to_string(&mut text)?;
    if text.len() as u64 > MAX_BYTES { Err(too_large()) } else { Ok(text) }
}

/// Writes a file as a whole or not at all: beside the old one first, which it replaces when it is on the disk. No
/// reader sees half of one. A target that is no plain file (a pipe, a device) is written to directly.
///
/// # Errors
/// The folder cannot be written to, or the disk is full; nothing is left of the new file then.
pub fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<()> {
    // A link keeps pointing to where it points.
    let path = &std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    if std::fs::metadata(path).is_ok_and(|found| !found.is_file()) {
        return std::fs::write(path, content);
    }
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    let beside = PathBuf::from(beside);
    // On the disk before it takes the other's name: after a power cut there would be an empty file otherwise.
    let written = File::create(&beside)
        .and_then(|mut file| file.write_all(content.as_ref()).and_then(|()| file.sync_all()))
        .and_then(|()| std::fs::rename(&beside, path));
    written.inspect_err(|_| {
        // Half a file is of no use to anybody.
        let _ = std::fs::remove_file(&beside);
    })
}

/// Text out of a file, for a sentence of ours: on one line, and without control sequences for a terminal.
pub fn one_line(text: &str) -> String {
    // Besides control characters those that turn the direction of the text after them.
    let turns = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    text.chars().map(|c| if c.is_control() || turns(c) { ' ' } else { c }).collect()
}

fn too_large() -> Error {
    let mebibytes = MAX_BYTES >> 20;
    Error::new(ErrorKind::FileTooLarge, format!("it has more than {mebibytes} MiB, which no such file needs"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("touchstone-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        folder
    }

    #[test]
    fn the_old_file_stays_until_the_new_one_is_whole() {
        let folder = folder("whole-file");
        let file = folder.join("page.html");
        write(&file, "old").expect("written");
        write(&file, "new").expect("written");
        assert_eq!(read(&file).expect("there"), "new");
        // Something in the way of the file beside: the old one is untouched.
        std::fs::create_dir(folder.join("page.html.part")).expect("made");
        assert!(write(&file, "newer").is_err());
        assert_eq!(read(&file).expect("there"), "new");
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = folder("links");
        let (file, link) = (folder.join("a.json"), folder.join("b.json"));
        write(&file, "old").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("linked");
        write(&link, "new").expect("written");
        assert!(std::fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(read(&file).expect("there"), "new");
        write(Path::new("/dev/null"), "gone").expect("swallowed");
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn a_file_of_gigabytes_is_refused_before_memory_is_taken() {
        let folder = folder("text-file");
        let path = folder.join("world.json");
        // Sparse: it takes no room on the disk.
        File::create(&path).and_then(|file| file.set_len(5 << 30)).expect("a sparse file");
        assert_eq!(read(&path).expect_err("too large").kind(), ErrorKind::FileTooLarge);
        std::fs::write(&path, "{}").expect("written");
        assert_eq!(read(&path).expect("text"), "{}");
        std::fs::write(&path, [0xff, 0xfe]).expect("written");
        assert_eq!(read(&path).expect_err("not text").kind(), ErrorKind::InvalidData);
        std::fs::remove_dir_all(&folder).expect("removed");
    }

    #[test]
    fn what_others_wrote_stays_on_its_line() {
        assert_eq!(one_line("a\nb\u{1b}[31m\u{202e}c"), "a b [31m c");
    }

    #[cfg(unix)]
    #[test]
    fn a_file_without_an_end_has_one_here() {
        assert_eq!(read(Path::new("/dev/zero")).expect_err("endless").kind(), ErrorKind::FileTooLarge);
    }
}
