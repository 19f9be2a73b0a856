//! The shape of a path: everything that is measured about it before its kind is decided.

use crate::constraint::circle::Arc;
use crate::constraint::frame::Frame;
use crate::constraint::retrace::Retrace;

/// Hinges within reach lie this far away, m: their radii are taken as equally likely in logarithm.
pub(super) const HINGE_M: (f64, f64) = (0.03, 2.0);

/// Everything measured about the path's shape.
pub(super) struct Shape {
    pub(super) frame: Frame,
    pub(super) arc: Arc,
    pub(super) retrace: Retrace,
    pub(super) rms_m: f64,
    /// Curvature interval at 5 %, 1/m, and lower end at the decision level.
    pub(super) interval: (f64, f64),
    pub(super) decision_low: f64,
    /// Probability of a straight line against a circle, even odds before.
    pub(super) straight_probability: f64,
    /// The motion begins and ends in this recording, or goes there and back in it.
    pub(super) whole: bool,
    /// Its rest at the ends would be seen in a few samples only.
    pub(super) few: bool,
    pub(super) curvature_error: f64,
    pub(super) angle_error: f64,
}
