//! Rows of recordings as the writers of all formats see them.

use super::errors::LogError;
use haptics::recording::Recording;
use std::path::Path;

/// A file that travels within a recording (MCAP only): the calibrated world, the device, …
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment {
    /// Its name, e.g. `world.json`.
    pub name: String,
    /// Its kind, e.g. `application/json`.
    pub media_type: String,
    /// Its content.
    pub data: Vec<u8>,
}

/// A value of a row.
#[derive(Clone, Copy, Debug)]
pub enum Value<'a> {
    /// A number.
    Number(f64),
    /// A text.
    Text(&'a str),
}

/// Log time between two trials, ns.
const PAUSE_NS: u64 = 1_000_000_000;

/// Log time between the samples of a recording without a clock, ns.
const CLOCKLESS_NS: u64 = 1_000_000;

/// The columns of a file of ours, with true for text: time, trial, channels, label.
pub(super) fn columns(recordings: &[Recording], path: &Path) -> Result<Vec<(String, bool)>, LogError> {
    let refuse = |why: String| LogError::NotWritable { why, path: path.to_path_buf() };
    let of = |recording: &Recording| {
        let mut columns = Vec::new();
        columns.extend(recording.time_s.as_ref().map(|_| ("t_s".to_owned(), false)));
        columns.extend(recording.trial.as_ref().map(|_| ("trial".to_owned(), true)));
        columns.extend(recording.channels.iter().map(|c| (c.name.clone(), false)));
        columns.extend(recording.labels.as_ref().map(|_| ("label".to_owned(), true)));
        columns
    };
    let Some(first) = recordings.first() else { return Err(refuse("there is none".to_owned())) };
    let columns = of(first);
    if let Some(other) = recordings.iter().find(|r| of(r) != columns) {
        return Err(refuse(format!(
            "`{}` and `{}` have different columns; write them to files of their own",
            first.name, other.name
        )));
    }
    if recordings.len() > 1 && first.trial.is_none() {
        return Err(refuse("several recordings need trials to be told apart".to_owned()));
    }
    Ok(columns)
}

/// The value of a column of [`columns`] in a row.
pub(super) fn cell(recording: &Recording, column: usize, row: usize) -> Value<'_> {
    let mut left = column;
    if let Some(time) = &recording.time_s {
        if left == 0 {
            return Value::Number(time[row]);
        }
        left -= 1;
    }
    if let Some(trial) = &recording.trial {
        if left == 0 {
            return Value::Text(trial);
        }
        left -= 1;
    }
    match (recording.channels.get(left), &recording.labels) {
        (Some(channel), _) => Value::Number(channel.values[row]),
        (None, Some(labels)) => Value::Text(&labels[row]),
        (None, None) => Value::Text(""),
    }
}

/// A number that a format without NaN cannot hold, in words.
pub(super) fn not_finite(recordings: &[Recording]) -> Option<String> {
    recordings.iter().find_map(|r| {
        let time = r.time_s.iter().map(|t| ("t_s", t));
        let mut columns = time.chain(r.channels.iter().map(|c| (c.name.as_str(), &c.values)));
        columns.find_map(|(name, values)| {
            let row = values.iter().position(|v| !v.is_finite())?;
            Some(format!("row {} of `{name}` is {}, which no reader accepts", row + 1, values[row]))
        })
    })
}

/// Times for other programs' time lines, ns from the first sample on; trials follow each other.
pub(super) fn log_times_ns(recordings: &[Recording]) -> Vec<Vec<u64>> {
    let mut start = 0_u64;
    let mut all = Vec::with_capacity(recordings.len());
    for recording in recordings {
        let times: Vec<u64> = match &recording.time_s {
            // Casts to integers saturate.
            Some(time) => time.iter().map(|t| start.saturating_add(((t - time[0]) * 1e9).round() as u64)).collect(),
            None => (0..recording.len() as u64).map(|i| start.saturating_add(i * CLOCKLESS_NS)).collect(),
        };
        start = times.last().map_or(start, |last| last.saturating_add(PAUSE_NS));
        all.push(times);
    }
    all
}
