//! Files that are there as a whole or as they were: nobody reads half of one, and a crash or a full disk leaves the old one.

use std::fs::File;
use std::io::{Result, Write as _};
use std::path::{Path, PathBuf};

/// Writes beside the file first and gives it its name when it is on the disk. What is no file (a pipe, a device) is written to as it is.
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

#[cfg(test)]
mod tests {
    use super::write;

    #[test]
    fn the_old_file_stays_until_the_new_one_is_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("page.html");
        write(&file, "old").expect("written");
        write(&file, "new").expect("written");
        assert_eq!(std::fs::read_to_string(&file).expect("there"), "new");
        // Something in the way of the file beside: the old one is untouched.
        std::fs::create_dir(folder.path().join("page.html.part")).expect("made");
        assert!(write(&file, "newer").is_err());
        assert_eq!(std::fs::read_to_string(&file).expect("there"), "new");
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("a.json"), folder.path().join("b.json"));
        write(&file, "old").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("linked");
        write(&link, "new").expect("written");
        assert!(std::fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(std::fs::read_to_string(&file).expect("there"), "new");
        write(std::path::Path::new("/dev/null"), "gone").expect("swallowed");
    }
}
