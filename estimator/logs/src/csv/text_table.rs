//! The cells of a table as text, for people who map its columns.

use super::cells::number;
use super::{layout, sniff};
use crate::errors::LogError;
use std::fs::File;
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::Path;

/// The beginning of a table of text.
#[derive(Clone, Debug, Default)]
pub struct TextTable {
    /// Names of the columns.
    pub headers: Vec<String>,
    /// Texts of units in a row of its own below the names; empty without such a row.
    pub units: Vec<String>,
    /// Cells of each row; a number has a decimal point.
    pub rows: Vec<Vec<String>>,
    /// False if the file goes on.
    pub is_whole: bool,
}

/// Reads at most so many bytes of a table.
pub fn read(path: &Path, most_bytes: u64) -> Result<TextTable, LogError> {
    let io = |error: std::io::Error| LogError::Io { reason: error.to_string(), path: path.to_path_buf() };
    let found = sniff(path, None)?;
    let length = found.end.map_or(u64::MAX, |end| end.saturating_sub(found.start));
    let mut bytes = Vec::new();
    if let Some(text) = &found.text {
        bytes.extend_from_slice(text.get(found.start as usize..).unwrap_or_default());
    } else {
        let mut file = File::open(path).map_err(io)?;
        file.seek(SeekFrom::Start(found.start)).map_err(io)?;
        file.take(length.min(most_bytes + 1)).read_to_end(&mut bytes).map_err(io)?;
    }
    let is_whole = bytes.len() as u64 <= most_bytes;
    bytes.truncate(length.min(most_bytes) as usize);
    let mut records = layout::records(&bytes, found.notation.delimiter, usize::MAX);
    if !is_whole {
        records.pop();
    }
    let plain = |cell: String| match number(cell.as_bytes(), found.notation) {
        Some(value) if cell.parse::<f64>().ok() != Some(value) => value.to_string(),
        _ => cell,
    };
    let width = found.headers.len();
    let is_row = |record: &layout::Record| record.cells.len() == width && record.cells != found.headers;
    let rows = records.into_iter().filter(is_row);
    let rows = rows.map(|record| record.cells.into_iter().map(plain).collect()).collect();
    Ok(TextTable { headers: found.headers, units: found.units, rows, is_whole })
}
