//! A value that is known with its standard error.

use serde::Serialize;

/// A value and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Known {
    /// In SI units.
    pub value: f64,
    /// One standard error.
    pub std_error: f64,
}
