//! Thresholds of the qualitative values.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Symmetric thresholds of the qualitative values +, 0, −.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize, Deserialize)]
pub struct Thresholds {
    /// Velocity, m/s (thesis: 0.05).
    pub velocity_m_s: f64,
    /// Force, N (thesis: 0.05).
    pub force_n: f64,
}
