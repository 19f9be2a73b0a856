//! Format of a file: told by its content, never by its name.

use super::errors::LogError;
use super::mat;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A table of text; also anything that no other format claims.
    Csv,
    /// MATLAB's variables, of versions 4 to 7.
    Mat,
    /// Foxglove's container of messages.
    Mcap,
    /// Apache Parquet.
    Parquet,
}

/// Looks at the first bytes of a file.
pub fn of(path: &Path) -> Result<Format, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let file = File::open(path).map_err(io)?;
    let size = file.metadata().map_err(io)?.len();
    let mut start = Vec::with_capacity(mat::START);
    file.take(mat::START as u64).read_to_end(&mut start).map_err(io)?;
    Ok(of_bytes(&start, size))
}

/// `start`: the first bytes of a file of `size` bytes.
fn of_bytes(start: &[u8], size: u64) -> Format {
    // The version byte and the line ends after it are the reader's business: a file mangled there should be called damaged.
    if start.starts_with(b"\x89MCAP") {
        return Format::Mcap;
    }
    // `PARE`: encrypted footer, which is refused by name.
    if start.starts_with(b"PAR1") || start.starts_with(b"PARE") {
        return Format::Parquet;
    }
    if mat::is_one(start, size) {
        return Format::Mat;
    }
    Format::Csv
}

impl Format {
    /// Name of the format, as its files end.
    pub fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Mat => "mat",
            Self::Mcap => "mcap",
            Self::Parquet => "parquet",
        }
    }
}

/// Kind of a file that is not read, by its first bytes, with the way for its owner to get a log out of it.
pub fn foreign(start: &[u8]) -> Option<&'static str> {
    const KNOWN: [(&[u8], &str); 8] = [
        (
            b"\x89HDF\r\n",
            "an HDF5 file, as of MATLAB 7.3; save it with save('file.mat', ..., '-v7') there, elsewhere as CSV or Parquet",
        ),
        (b"#ROSBAG", "a ROS 1 bag; convert it with `mcap convert`"),
        (
            b"SQLite format 3",
            "an SQLite database, which ROS 2 bags of old are; convert it with `mcap convert` or `ros2 bag convert`",
        ),
        (b"RRF", "a Rerun recording; export the signals as MCAP, Parquet or CSV"),
        (b"PK\x03\x04", "a zip archive or a spreadsheet; unpack it, or save the sheet as CSV"),
        (b"\x1f\x8b", "compressed with gzip; unpack it with `gunzip`"),
        (b"\x28\xb5\x2f\xfd", "compressed with zstd; unpack it with `unzstd`"),
        (b"\x93NUMPY", "a NumPy array; write it as CSV with a header line of column names"),
    ];
    if start.starts_with(b"MATLAB 7.3") || mat::is_hdf5(start) {
        return Some("a MATLAB file of version 7.3; save it with save('file.mat', ..., '-v7')");
    }
    let known = KNOWN.iter().find(|(magic, _)| start.starts_with(magic)).map(|&(_, what)| what);
    known.or_else(|| markup(start))
}

/// Text that is no table: no header begins with these.
fn markup(start: &[u8]) -> Option<&'static str> {
    let text = start.strip_prefix("\u{feff}".as_bytes()).unwrap_or(start).trim_ascii_start();
    match text.first()? {
        b'<' => Some("a web page or XML; save the table itself as CSV"),
        b'[' if !is_list(text) => None,
        b'{' | b'[' => Some("JSON; write it as CSV, with pandas for example, or as MCAP"),
        _ => None,
    }
}

/// False for a first line such as `[12:00:05] 0.5,2.1` or `[Header]`.
fn is_list(text: &[u8]) -> bool {
    let line = text.split(|b| *b == b'\n').next().unwrap_or_default();
    let mut parts = line.splitn(2, |b| *b == b']');
    let inside = parts.next().unwrap_or_default()[1..].trim_ascii();
    let behind = parts.next().unwrap_or_default().trim_ascii();
    let is_item = inside.first().is_none_or(|b| b.is_ascii_digit() || b"[{\"-".contains(b));
    let is_word = [&b"true"[..], b"false", b"null"].iter().any(|word| inside.starts_with(word));
    (is_item || is_word) && behind.first().is_none_or(|b| b",]".contains(b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bytes_decide() {
        let of = |start: &[u8]| of_bytes(start, start.len() as u64);
        assert_eq!(of(b"\x89MCAP0\r\n"), Format::Mcap);
        assert_eq!(of(b"PAR1\x15\x04"), Format::Parquet);
        assert_eq!(of(b"t_s,q_m\n"), Format::Csv);
        assert_eq!(of(b"PAR"), Format::Csv);
        assert_eq!(of(b""), Format::Csv);
        assert_eq!(of(b"MATLAB 5.0 MAT-file"), Format::Mat);
        assert_eq!(of(b"MATLAB 7.3 MAT-file"), Format::Csv);
    }

    #[test]
    fn well_known_files_are_named() {
        for start in [&b"MATLAB 7.3 MAT-file, Platform: GLNXA64"[..], b"\x89HDF\r\n\x1a\n"] {
            assert!(foreign(start).is_some_and(|what| what.contains("save('file.mat', ..., '-v7')")));
        }
        assert!(foreign(b"t_s,q_m\n").is_none() && foreign(b"").is_none());
        assert!(foreign(b"<!DOCTYPE html>\n<html>").is_some_and(|what| what.contains("web page")));
        assert!(foreign(b"[Header]\nRate=200\n").is_none() && foreign(b"[\n  1.5,\n").is_some());
        assert!(foreign(b"[12:00:05] 0.5,2.1\n").is_none() && foreign(b"[[1, 2], [3, 4]]").is_some());
        assert!(foreign(b"\n { \"t_s\": [0, 1] }").is_some_and(|what| what.starts_with("JSON")));
    }
}
