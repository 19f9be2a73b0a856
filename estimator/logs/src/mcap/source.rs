//! One topic of a file, and how its messages are read.

use super::schema_units::Units;
use super::topic::Topic;
use super::{protobuf, rosmsg};
use haptics::recording::Warning;
use std::collections::HashMap;

/// Decoder of the messages of a channel.
pub(super) enum Decoder {
    Json,
    Protobuf(Box<protobuf::Shape>),
    Cdr(Box<rosmsg::Definitions>),
    /// They are not, and why.
    None(String),
}

/// One topic of the file.
pub(super) struct Source {
    pub(super) name: String,
    pub(super) decoder: Decoder,
    pub(super) topic: Topic,
    pub(super) messages: u64,
    /// Units that its schema states.
    pub(super) units: Units,
    /// Our own column names by field, in files that we wrote.
    pub(super) own: Option<HashMap<String, String>>,
    pub(super) clockless: bool,
    /// Rows handed to the preview.
    pub(super) shown: usize,
}

/// A warning about the file as a whole.
pub(super) fn note(kind: &str, text: String) -> Warning {
    Warning { kind: kind.to_owned(), column: None, spans: Vec::new(), text, ..Warning::default() }
}
