//! Rows of a log that another file's times cover.

use crate::mcap::resample;
use haptics::recording::{Recording, Span};

/// Rows at `time` that lie within the times `from` and in no gap of them. Both increase.
pub fn shared(time: &[f64], from: &[f64]) -> Vec<usize> {
    let (Some(first), Some(last)) = (from.first(), from.last()) else { return Vec::new() };
    let covered = resample::covered(from, time);
    let is_shared = |&row: &usize| covered[row] && (*first..=*last).contains(&time[row]);
    (0..time.len()).filter(is_shared).collect()
}

/// Keeps some rows of a recording, in their order.
pub fn keep(recording: &mut Recording, rows: &[usize]) {
    if rows.len() == recording.len() {
        return;
    }
    let gathered = |values: &[f64]| rows.iter().map(|&row| values[row]).collect::<Vec<f64>>();
    recording.time_s = recording.time_s.as_deref().map(gathered);
    for channel in &mut recording.channels {
        channel.values = gathered(&channel.values);
    }
    recording.labels = recording.labels.as_ref().map(|labels| labels.gathered(rows.iter().copied()));
    for warning in &mut recording.warnings {
        let place = |row: usize| rows.partition_point(|&kept| kept < row);
        let spans = warning.spans.iter().map(|span| Span { first: place(span.first), end: place(span.end) });
        warning.spans = spans.filter(|span| span.first < span.end).collect();
    }
}
