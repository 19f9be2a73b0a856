//! Centre, radius, rigidity and friction of a crank turned by its handle (thesis, 5.3.1, eqs. 5.1 and 5.2).
//!
//! Geometry before forces: the give of the pads displaces the tips by the force they carry, which would tilt the
//! tangent. The radius residual shows it (it depends on the force, not on the angle), so it is fitted together with
//! centre and radius. The handle's position is corrected, and only then are the forces split into normal and tangential
//! parts.

pub mod frame;
mod friction;
pub(crate) mod geometry;
mod grasp_slip;
mod joint_fit;
pub mod laws;
pub(crate) mod path_coordinate;
mod report;
pub(crate) mod signals;
mod single_fit;

pub use joint_fit::{JointFit, fit_jointly, refit_jointly};
pub use single_fit::{Prepared, fit, fit_by};
