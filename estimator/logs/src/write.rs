//! Writing recordings so that they read back exactly: the format that the ending of a file names, and CSV.

use super::errors::LogError;
use super::mcap::write::Encoding;
use super::rows::{Attachment, Value, cell, columns};
use super::sidecar;
use haptics::recording::Recording;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// Writes the recordings of one log to one file, in the format that its ending names: `csv` (with its sidecar beside it),
/// `mcap` or `parquet` (which carry their sidecar). All must have the same columns; several are told apart by their trials.
pub fn write(recordings: &[Recording], path: &Path, attachments: &[Attachment]) -> Result<(), LogError> {
    write_encoded(recordings, path, attachments, Encoding::Protobuf)
}

/// [`write`] with the encoding of the messages of an MCAP file.
pub fn write_encoded(
    recordings: &[Recording],
    path: &Path,
    attachments: &[Attachment],
    encoding: Encoding,
) -> Result<(), LogError> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    match ending.as_str() {
        "csv" => {
            write_table(recordings, path)?;
            recordings.first().map_or(Ok(()), |first| sidecar::write(first, path).map(drop))
        }
        "mcap" => super::mcap::write::write(recordings, path, attachments, encoding),
        #[cfg(feature = "parquet")]
        "parquet" => super::parquet::write(recordings, path),
        #[cfg(not(feature = "parquet"))]
        "parquet" => {
            let why = "Parquet was left out when this program was built; choose .csv or .mcap".to_owned();
            Err(LogError::NotWritable { why, path: path.to_path_buf() })
        }
        _ => {
            let why = "its ending names no format; choose .csv, .mcap or .parquet".to_owned();
            Err(LogError::NotWritable { why, path: path.to_path_buf() })
        }
    }
}

/// Writes `recording` as CSV: SI columns in the program's names, every number in its shortest form that reads back to the
/// same bits.
pub fn write_csv(recording: &Recording, path: &Path) -> Result<(), LogError> {
    write_table(std::slice::from_ref(recording), path)
}

fn write_table(recordings: &[Recording], path: &Path) -> Result<(), LogError> {
    let failed = |e: std::io::Error| LogError::Write { reason: e.to_string(), path: path.to_path_buf() };
    let columns = columns(recordings, path)?;
    let file = std::fs::File::create(path).map_err(failed)?;
    let mut out = std::io::BufWriter::with_capacity(1 << 20, file);
    let names: Vec<String> = columns.iter().map(|(name, _)| quoted(name)).collect();
    out.write_all((names.join(",") + "\n").as_bytes()).map_err(failed)?;
    let mut line = String::new();
    for recording in recordings {
        for row in 0..recording.len() {
            line.clear();
            for column in 0..columns.len() {
                // Writing into a string cannot fail.
                let _ = match cell(recording, column, row) {
                    Value::Number(value) => write!(line, "{value:?},"),
                    Value::Text(text) => write!(line, "{},", quoted(text)),
                };
            }
            line.pop();
            line.push('\n');
            out.write_all(line.as_bytes()).map_err(failed)?;
        }
    }
    out.flush().map_err(failed)
}

/// A cell of text, quoted where it must be.
fn quoted(text: &str) -> String {
    let plain = !text.contains([',', '"', '\n', '\r', ';', '\t']) && !text.starts_with('#') && !text.is_empty();
    if plain { text.to_owned() } else { format!("\"{}\"", text.replace('"', "\"\"")) }
}
