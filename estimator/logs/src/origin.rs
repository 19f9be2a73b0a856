//! Recordings as they are loaded, with the place of their clock's zero.

use foundation::words::CLOCK_UNITS;
use haptics::recording::Recording;

/// Seconds since 1970 of stamps that recordings have: 1990 to 2100.
pub const EPOCHS: std::ops::Range<f64> = 6.3e8..4.1e9;

/// Nanoseconds since 1970 of stamps in one unit, if all of them can be such.
pub fn since_1970_ns(stamps: &[f64]) -> Option<Vec<i64>> {
    let first = stamps.first()?;
    let units = std::iter::once(1.0).chain(CLOCK_UNITS.map(|(_, unit)| unit));
    let unit = units.into_iter().find(|unit| EPOCHS.contains(&(first * unit)))?;
    let ns = |stamp: &f64| EPOCHS.contains(&(stamp * unit)).then(|| (stamp * (1e9 * unit).round()).round() as i64);
    stamps.iter().map(ns).collect()
}

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
