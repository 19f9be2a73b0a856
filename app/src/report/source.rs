//! The input files, with their SHA-256.

use estimator::log::{parse_sidecar, sidecar_path};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Maximum size of a sidecar printed in full, bytes.
const PRINTED: u64 = 16_384;

/// One file.
#[derive(Clone, Debug)]
pub struct Hashed {
    /// Path as given.
    pub path: PathBuf,
    /// Length, bytes, and SHA-256 in hexadecimal digits; a sentence if it could not be read.
    pub digest: Result<(u64, String), String>,
}

/// A log with its sidecar.
#[derive(Clone, Debug)]
pub struct Source {
    /// The log.
    pub log: Hashed,
    /// Its sidecar, if it has one.
    pub sidecar: Option<Hashed>,
    /// Other files of the same run, which the sidecar joins, and their sidecars.
    pub joined: Vec<Hashed>,
    /// Content of the sidecar, if it is text of a readable length.
    pub stated: Option<String>,
}

impl Source {
    /// Reads a log's bytes, and those of its sidecar: `meta`, or the one beside the log.
    pub fn of(log: &Path, meta: Option<&Path>) -> Self {
        let beside = sidecar_path(log);
        let path = meta.map_or_else(|| Some(beside).filter(|p| p.is_file()), |p| Some(p.to_path_buf()));
        let stated = path.as_deref().and_then(text);
        let joined = path.as_deref().map_or_else(Vec::new, |sidecar| joined(log, sidecar));
        Self { log: Hashed::of(log), sidecar: path.as_deref().map(Hashed::of), joined, stated }
    }

    /// The log's name without its folders.
    pub fn name(&self) -> String {
        self.log.name()
    }
}

impl Hashed {
    /// Reads the bytes of a file.
    pub fn of(path: &Path) -> Self {
        Self { path: path.to_path_buf(), digest: digest(path).map_err(|error| error.to_string()) }
    }

    /// The name without folders.
    pub fn name(&self) -> String {
        self.path.file_name().map_or_else(|| self.path.display().to_string(), |n| n.to_string_lossy().into_owned())
    }
}

/// Files that a sidecar joins to a log, each with its own sidecar.
fn joined(log: &Path, sidecar: &Path) -> Vec<Hashed> {
    let read = || parse_sidecar(&haptics::text_file::read(sidecar).ok()?, sidecar).ok();
    let folder = log.parent().unwrap_or(Path::new(""));
    let files = read().into_iter().flat_map(|meta| meta.join).map(|joined| folder.join(joined.file));
    let with_sidecar = files.flat_map(|path| {
        let beside = Some(sidecar_path(&path)).filter(|beside| beside.is_file());
        std::iter::once(path).chain(beside)
    });
    with_sidecar.map(|path| Hashed::of(&path)).collect()
}

fn digest(path: &Path) -> io::Result<(u64, String)> {
    if !path.is_file() {
        // Reading a pipe would block; a folder has no bytes.
        return Err(io::Error::other(if path.exists() { "it is no file" } else { "it is not there" }));
    }
    let (mut file, mut hash, mut length) = (File::open(path)?, Sha256::new(), 0);
    let mut buffer = vec![0; 1 << 20];
    loop {
        let n = file.read(&mut buffer)?;
        if n == 0 {
            break;
        }
        hash.update(&buffer[..n]);
        length += n as u64;
    }
    Ok((length, digits(&hash.finalize())))
}

/// Bytes as hexadecimal digits.
fn digits(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut digits, byte| {
        let _ = write!(digits, "{byte:02x}");
        digits
    })
}

/// SHA-256 of bytes, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    digits(&Sha256::digest(bytes))
}

fn text(path: &Path) -> Option<String> {
    let length = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?.len();
    (length <= PRINTED).then(|| std::fs::read_to_string(path).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_text_has_its_known_hash() {
        let folder = tempfile::tempdir().expect("a folder");
        let (log, meta) = (folder.path().join("a.csv"), folder.path().join("a.meta.json"));
        std::fs::write(&log, "abc").expect("written");
        std::fs::write(&meta, "{}").expect("written");
        let source = Source::of(&log, None);
        // FIPS 180-4, example of one block.
        let known = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        assert_eq!(source.log.digest, Ok((3, known.to_owned())));
        assert_eq!((source.name().as_str(), source.stated.as_deref()), ("a.csv", Some("{}")));
        assert!(source.sidecar.is_some());
    }

    #[test]
    fn joined_files_are_listed_with_their_sidecars() {
        let folder = tempfile::tempdir().expect("a folder");
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
        write("a.csv", "abc");
        write("a.meta.json", r#"{"join": [{"file": "force.csv"}, {"file": "none.csv"}], "columns": {"t_s": null}}"#);
        write("force.csv", "abc");
        write("force.meta.json", "{}");
        let source = Source::of(&folder.path().join("a.csv"), None);
        let names: Vec<String> = source.joined.iter().map(Hashed::name).collect();
        assert_eq!(names, ["force.csv", "force.meta.json", "none.csv"]);
        assert!(source.joined[0].digest == source.log.digest && source.joined[2].digest.is_err());
    }

    #[test]
    fn what_is_no_file_is_a_sentence() {
        let folder = tempfile::tempdir().expect("a folder");
        let source = Source::of(folder.path(), None);
        assert!(source.log.digest.expect_err("a folder").contains("no file"));
        let missing = Source::of(&folder.path().join("none.csv"), Some(Path::new("/no/such/sidecar.json")));
        assert!(missing.log.digest.is_err() && missing.sidecar.is_some_and(|s| s.digest.is_err()));
    }
}
