//! A fixed plane at any angle: the edge of the solid as a bar that runs across the picture, its rim on the surface.

use super::canvas::{Canvas, HALF_DEPTH_M, Mode};
use crate::coordinates::vec2;
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use glam::Vec2;

/// Half of the thickness and half of the length of the bar, m.
const HALF_M: f32 = 0.002;
const REACH_M: f32 = 0.060;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let (Some(plane), true) = (&view.world.plane, canvas.mode == Mode::Real) else { return };
    let normal = vec2(plane.normal());
    let along = Vec2::new(-normal.y, normal.x);
    let middle = vec2(plane.point_m) - HALF_M * normal;
    let color = canvas.palette.steel;
    for depth in [-HALF_DEPTH_M, 0.0, HALF_DEPTH_M] {
        let (from, to) = ((middle - REACH_M * along).extend(depth), (middle + REACH_M * along).extend(depth));
        canvas.solid(MeshKind::Box, Solid::capsule(from, to, HALF_M, color).gloss(0.3).of(Material::Brushed));
    }
}
