//! The table: a slab with a grid of 1 cm (stronger every 5 cm).

use super::canvas::Canvas;
use crate::draw_data::Layer;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use glam::{Vec2, Vec3};
use haptics::world::World;

/// Thickness of the slab, m.
const THICKNESS_M: f32 = 0.007;

/// Size and place of the table top.
pub(crate) struct Extent {
    /// Height of the top, m, if there is a table.
    pub top: Option<f32>,
    /// Half the size along x and z, m.
    pub half: Vec2,
    /// z of the middle, m: most of the table lies behind the plane.
    pub center_z: f32,
}

pub(crate) fn extent(world: &World) -> Extent {
    Extent {
        top: world.floor.as_ref().map(|floor| floor.height_m as f32),
        half: Vec2::new(0.125, 0.065),
        center_z: -0.02,
    }
}

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let Extent { top: Some(top), half, center_z } = extent(view.world) else { return };
    let center = Vec3::new(0.0, top - 0.5 * THICKNESS_M, center_z);
    let size = Vec3::new(half.x, 0.5 * THICKNESS_M, half.y);
    let slab = Solid::rounded_box(center, size, 0.0, 0.0022, canvas.palette.table).gloss(0.1);
    canvas.solid_in(Layer::Table, MeshKind::Box, slab);
}
