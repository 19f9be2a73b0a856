//! Coordinates: from the simulation's plane to the pictures' space.

use glam::{Vec2, Vec3};

/// The seam from the simulation's `f64` to the pictures' `f32`.
pub(crate) fn vec2(point: haptics::Vec2) -> Vec2 {
    Vec2::new(point.x as f32, point.y as f32)
}

/// A point of the world's plane, lifted to depth `z` (m, towards the viewer).
pub(crate) fn lift(point: Vec2, z: f32) -> Vec3 {
    point.extend(z)
}
