//! Facts about a path beside its points.

use nalgebra::Vector3;

/// Knowledge about a path beside its points.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// Name of the recording or trial.
    pub recording: Option<String>,
    /// The path lies in the x-y plane by construction.
    pub planar: bool,
    /// Sample times, s, one a point: inertia can then be told from constraint forces.
    pub time_s: Option<Vec<f64>>,
    /// Unit vector upwards; zero in a level plane.
    pub up: Vector3<f64>,
}
