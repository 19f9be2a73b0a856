//! Geometric constraints: the kind of joint that a tool path shows, with an honest interval for its radius.

mod carried;
pub(crate) mod circle;
mod context;
mod decide;
pub mod existence;
pub mod felt;
pub(crate) mod frame;
mod guided;
mod noise;
mod normals;
mod retrace;
pub mod screw;
pub mod slips;
pub mod spline;
pub mod surface;
mod whole;
pub mod yielding;

pub use carried::{Carry, carried};
pub use context::Context;
pub use decide::detect;
pub use normals::{THESIS_SAMPLES, normals_center};

use crate::identify::mechanism::path;
use foundation::estimate::Constraint;
use haptics::recording::Recording;

/// The constraint of a recording with a tool path; `None` without one.
pub fn detect_in(recording: &Recording) -> Option<Constraint> {
    let points = path::points(recording)?;
    let forces = path::forces(recording);
    let context = Context {
        recording: Some(recording.name.clone()),
        planar: recording.channel("z_m").is_none(),
        time_s: recording.time_s.clone(),
        up: path::up(recording).unwrap_or_else(nalgebra::Vector3::zeros),
    };
    Some(detect(&points, forces.as_deref(), &context))
}
