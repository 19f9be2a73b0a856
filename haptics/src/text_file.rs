//! Small text files that others wrote: worlds, sidecars, tasks, lessons, keys.
//!
//! A file of gigabytes under such a name is a mistake or malice; it is refused before memory is taken for it.

use std::fs::File;
use std::io::{Error, ErrorKind, Read as _, Result};
use std::path::Path;

/// Largest text that is read, bytes (64 MiB): a hundred times the largest world.
pub const MAX_BYTES: u64 = 64 << 20;

/// The text of a file of at most [`MAX_BYTES`].
///
/// # Errors
/// What the system says; [`ErrorKind::FileTooLarge`] for more than that, [`ErrorKind::InvalidData`] for what is not text.
pub fn read(path: &Path) -> Result<String> {
    let file = File::open(path)?;
    let size = file.metadata()?.len();
    if size > MAX_BYTES {
        return Err(too_large());
    }
    // What is no plain file states no size, and a file may grow: never more than the limit is taken in.
    let mut text = String::new();
    file.take(MAX_BYTES + 1).read_to_string(&mut text)?;
    if text.len() as u64 > MAX_BYTES { Err(too_large()) } else { Ok(text) }
}

/// Text out of a file, for a sentence of ours: on one line, and without what would be an order to a terminal.
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

    #[test]
    fn a_file_of_gigabytes_is_refused_before_memory_is_taken() {
        let folder = std::env::temp_dir().join(format!("touchstone-text-file-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
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
