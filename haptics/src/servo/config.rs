//! Settings that the servo is started with: rate, limits, privileges.

use super::rate::RateChoice;
use super::safety::Limits;

/// Settings of the servo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoConfig {
    /// Choice of the rate.
    pub rate: RateChoice,
    /// Safety limits.
    pub limits: Limits,
    /// Ask the system for real-time scheduling.
    pub real_time: bool,
    /// Largest damping that the passivity controller may add, N s/m; `None`: it only observes.
    pub passivity_control_n_s_m: Option<f64>,
}

impl Default for ServoConfig {
    fn default() -> Self {
        Self { rate: RateChoice::Auto, limits: Limits::default(), real_time: true, passivity_control_n_s_m: None }
    }
}

impl ServoConfig {
    /// A servo at a fixed rate, Hz.
    pub fn at(rate_hz: f64) -> Self {
        Self { rate: RateChoice::Fixed(rate_hz), ..Self::default() }
    }
}
