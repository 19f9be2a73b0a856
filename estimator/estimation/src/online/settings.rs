//! Settings of the estimator beside the servo.

use super::information::target_accuracy::Wanted;

/// Settings of the estimator.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Time after which a direction that is excited all the while is forgotten, s; infinite: never.
    pub memory_s: f64,
    /// Most false alarms of the change detectors of one object, an hour.
    pub false_alarms_per_hour: f64,
    /// Gravity, m/s², positive.
    pub gravity_m_s2: f64,
    /// Wanted accuracies.
    pub wanted: Wanted,
}

impl Default for Settings {
    fn default() -> Self {
        Self { memory_s: 120.0, false_alarms_per_hour: 0.2, gravity_m_s2: 9.81, wanted: Wanted::default() }
    }
}
