//! Writing a recording as a table that reads back exactly.

use super::errors::LogError;
use haptics::recording::Recording;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// Writes `recording` as CSV: SI columns in the program's names, every number in its shortest form that reads back to the
/// same bits.
pub fn write_csv(recording: &Recording, path: &Path) -> Result<(), LogError> {
    let failed = |e: std::io::Error| LogError::Write { reason: e.to_string(), path: path.to_path_buf() };
    let file = std::fs::File::create(path).map_err(failed)?;
    let mut out = std::io::BufWriter::with_capacity(1 << 20, file);
    out.write_all(header(recording).as_bytes()).map_err(failed)?;
    let mut line = String::new();
    for row in 0..recording.len() {
        line.clear();
        write_row(recording, row, &mut line);
        out.write_all(line.as_bytes()).map_err(failed)?;
    }
    out.flush().map_err(failed)
}

fn header(recording: &Recording) -> String {
    let mut names: Vec<String> = Vec::new();
    if recording.time_s.is_some() {
        names.push("t_s".to_owned());
    }
    if recording.trial.is_some() {
        names.push("trial".to_owned());
    }
    names.extend(recording.channels.iter().map(|c| quoted(&c.name)));
    if recording.labels.is_some() {
        names.push("label".to_owned());
    }
    names.join(",") + "\n"
}

fn write_row(recording: &Recording, row: usize, line: &mut String) {
    // Writing into a string cannot fail.
    if let Some(time) = &recording.time_s {
        let _ = write!(line, "{:?},", time[row]);
    }
    if let Some(trial) = &recording.trial {
        line.push_str(&quoted(trial));
        line.push(',');
    }
    for channel in &recording.channels {
        let _ = write!(line, "{:?},", channel.values[row]);
    }
    if let Some(labels) = &recording.labels {
        line.push_str(&quoted(&labels[row]));
    } else {
        line.pop();
    }
    line.push('\n');
}

/// A cell of text, quoted where it must be.
fn quoted(text: &str) -> String {
    let plain = !text.contains([',', '"', '\n', '\r', ';', '\t']) && !text.starts_with('#') && !text.is_empty();
    if plain { text.to_owned() } else { format!("\"{}\"", text.replace('"', "\"\"")) }
}
