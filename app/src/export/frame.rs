//! The frame of other simulators: x right, z up, y away from the viewer. Ours has y up and z towards the viewer.

use haptics::Vec2;
use nalgebra::Vector3;

/// Vectors of the file.
pub type Vec3 = Vector3<f64>;

/// Axis about which this program's angles, counter-clockwise for the viewer, are right-handed.
pub fn turning() -> Vec3 {
    -Vec3::y()
}

/// Vector of this program's plane, in the file's frame.
pub fn of_plane(v: Vec2) -> Vec3 {
    Vec3::new(v.x, 0.0, v.y)
}

/// Vector of a recording in space (z towards the viewer), in the file's frame.
pub fn of_space(v: [f64; 3]) -> Vec3 {
    Vec3::new(v[0], -v[2], v[1])
}

/// Vector rotated about a unit axis by an angle, rad.
pub fn turned(v: Vec3, axis: Vec3, angle_rad: f64) -> Vec3 {
    nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), angle_rad) * v
}
