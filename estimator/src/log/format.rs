//! Which format a file has: told by what it contains, never by its name.

use super::errors::LogError;
use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Formats that are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A table of text; also what nothing else claims.
    Csv,
    /// Foxglove's container of messages.
    Mcap,
    /// Apache Parquet.
    Parquet,
}

/// Looks at the first bytes of a file.
pub fn of(path: &Path) -> Result<Format, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let mut start = Vec::with_capacity(8);
    File::open(path).map_err(io)?.take(8).read_to_end(&mut start).map_err(io)?;
    Ok(of_bytes(&start))
}

fn of_bytes(start: &[u8]) -> Format {
    // The version byte and the line ends after it are the reader's business: a file mangled there should be called damaged.
    if start.starts_with(b"\x89MCAP") {
        return Format::Mcap;
    }
    // `PARE`: encrypted footer, which is refused by name.
    if start.starts_with(b"PAR1") || start.starts_with(b"PARE") {
        return Format::Parquet;
    }
    Format::Csv
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_bytes_decide() {
        assert_eq!(of_bytes(b"\x89MCAP0\r\n"), Format::Mcap);
        assert_eq!(of_bytes(b"PAR1\x15\x04"), Format::Parquet);
        assert_eq!(of_bytes(b"t_s,q_m\n"), Format::Csv);
        assert_eq!(of_bytes(b"PAR"), Format::Csv);
        assert_eq!(of_bytes(b""), Format::Csv);
    }
}
