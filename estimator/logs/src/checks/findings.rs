//! Warnings about samples: which channel, which spans, and where in words.

use crate::units;
use haptics::recording::{Channel, Recording, Span, Warning};

/// No more spans than this are listed for faults that are no reason to leave samples out.
const MAX_SPANS: usize = 200;

/// A warning about one channel.
pub(super) fn about(kind: &str, channel: &Channel, spans: Vec<Span>, text: String) -> Warning {
    Warning { kind: kind.to_owned(), column: Some(channel.name.clone()), spans, text, ..Warning::default() }
}

/// Place of a sample, for people.
pub(crate) fn place(recording: &Recording, sample: usize) -> String {
    match recording.time_s.as_ref().and_then(|t| t.get(sample)) {
        Some(time) => format!("{time:.3} s (sample {sample})"),
        None => format!("sample {sample}"),
    }
}

/// The first spans, as many as a warning lists.
pub(crate) fn limited(mut spans: Vec<Span>) -> Vec<Span> {
    spans.truncate(MAX_SPANS);
    spans
}

/// True for positions and angles of the program.
pub(crate) fn is_position(channel: &Channel) -> bool {
    units::is_program_name(&channel.name) && matches!(channel.unit.as_str(), "m" | "rad")
}
