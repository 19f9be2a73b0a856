//! Place and look of a movable body.

use crate::theme::Color;
use glam::{Vec2, Vec3};

/// Pose and look of a body.
#[derive(Clone, Copy)]
pub(super) struct Body {
    pub center: Vec2,
    /// Half width and half height.
    pub half: Vec2,
    pub turn: f32,
    pub color: Color,
    /// Share of the colour that shines by itself: while the body is being talked about.
    pub unlit: f32,
}

impl Body {
    /// A point of the body's own frame (x across, y along its height), in the plane.
    pub fn to_world(self, local: Vec2) -> Vec2 {
        self.center + Vec2::from_angle(self.turn).rotate(local)
    }
}

/// Half extents of the upright rectangle around a turned one.
pub(super) fn reach(half: Vec2, turn: f32) -> Vec2 {
    let Vec3 { x: cos, y: sin, .. } = Vec3::new(turn.cos().abs(), turn.sin().abs(), 0.0);
    Vec2::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y)
}
