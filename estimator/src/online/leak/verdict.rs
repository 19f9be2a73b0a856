//! Verdicts on a weight that changes: a leak, a drift of the sensors, both, or neither.

use serde::{Deserialize, Serialize};

/// A change within so many standard errors is no change.
pub(super) const SIGNIFICANT: f64 = 4.0;

/// What a changing reading is.
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
    /// Something changes; what it is the recording does not show.
    CannotTell,
}
