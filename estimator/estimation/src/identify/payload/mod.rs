//! Load of a force/torque sensor, and the zero of the sensor, from readings in several orientations.
//!
//! In the sensor's axes, the weight turns while the bias stays:
//! `f = Rᵀ(−W u) + b + d (t − t̄)` and `τ = r × Rᵀ(−W u) + b_τ + d_τ (t − t̄)`, with the orientation R (sensor to base), the
//! upward unit vector u, the weight W in N, and the centre of mass r in m from the sensor's origin. Both are linear in
//! W, W r, the biases, and the drifts (Kubus, Kröger & Wahl 2008 for the whole inertia).
//!
//! One pose is one observation, however many samples it has: errors between poses (of the orientation, of the sensor)
//! exceed the noise within one. Standard errors come from the spread between poses ([`crate::regression::blocks`]).

pub mod compensate;
pub mod doubts;
mod estimate;
mod observations;
mod report;

pub use estimate::{Estimate, Left, Model, Row, left_by};
pub use observations::{Observation, Observed, observe};
pub use report::{PAYLOAD, SENSOR, SEPARATES, fit};
