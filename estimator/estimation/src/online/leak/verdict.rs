//! Verdicts on a weight that changes: a leak, a drift of the sensors, both, or neither.

use serde::{Deserialize, Serialize};

/// Size of a change in standard errors below which it is none.
pub(super) const SIGNIFICANT: f64 = 4.0;

/// Cause of a changing reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// Nothing changes beyond the errors.
    Steady,
    /// The weight changes.
    Leak,
    /// The sensors' bias changes.
    SensorDrift,
    /// Both change.
    Both,
    /// Something changes; the recording does not show the cause.
    CannotTell,
}
