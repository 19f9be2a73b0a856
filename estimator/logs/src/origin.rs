//! Recordings as they are loaded, with the place of their clock's zero.

use haptics::recording::Recording;

/// Place of a clock's zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Nanoseconds since the start of 1970, or since midnight.
    pub ns: i64,
    /// True for nanoseconds since 1970, false for those since midnight.
    pub is_dated: bool,
}

/// A recording, and the zero of its clock if the file states it.
#[derive(Debug)]
pub struct Dated {
    /// The recording.
    pub recording: Recording,
    /// Place of its time zero.
    pub origin: Option<Origin>,
}
