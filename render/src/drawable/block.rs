//! Blocks: boxes with slightly rounded edges and their shadows.

use super::{Canvas, HALF_DEPTH_M};
use crate::mesh::MeshKind;
use crate::scene::{SceneView, SolidRef};
use crate::shape::Solid;
use crate::theme::{Color, ColorRole};
use crate::{lift, vec2};
use glam::{Vec2, Vec3};

/// Radius of the edges, m.
const EDGE_M: f32 = 0.0009;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for (index, (block, body)) in view.world.blocks.iter().zip(&view.state.bodies).enumerate() {
        let center = vec2(body.center_m);
        let half = 0.5 * Vec2::new(block.width_m as f32, block.height_m as f32);
        let turn = body.angle_rad as f32;
        let highlighted = view.options.highlight == Some(SolidRef::Block(index));
        let mut color = canvas.color(ColorRole::Block(index));
        if highlighted {
            color = color.mix(Color::rgb8(0xFF, 0xFF, 0xFF), 0.35);
        }
        let solid = Solid::rounded_box(lift(center, 0.0), half.extend(HALF_DEPTH_M), turn, EDGE_M, color)
            .gloss(0.3)
            .unlit(if highlighted { 0.35 } else { 0.0 });
        canvas.solid(MeshKind::Box, solid);
        let reach = reach(half, turn);
        canvas.cast_shadow(Vec2::new(center.x, 0.0), Vec2::new(reach.x, HALF_DEPTH_M), center.y - reach.y, 1.0);
    }
}

/// Half extents of the upright rectangle around a turned one.
fn reach(half: Vec2, turn: f32) -> Vec2 {
    let Vec3 { x: cos, y: sin, .. } = Vec3::new(turn.cos().abs(), turn.sin().abs(), 0.0);
    Vec2::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y)
}
