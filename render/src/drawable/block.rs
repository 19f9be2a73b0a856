//! Movable bodies: blocks are boxes with slightly rounded edges; barrels, cups and needles have files of their own.

use super::{Canvas, HALF_DEPTH_M, barrel, cup, needle};
use crate::Material;
use crate::mesh::MeshKind;
use crate::scene::{SceneView, SolidRef};
use crate::shape::Solid;
use crate::theme::{Color, ColorRole};
use crate::{lift, vec2};
use glam::{Vec2, Vec3};
use haptics::world::Shape;

/// Radius of the edges, m.
const EDGE_M: f32 = 0.0009;

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

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for (index, (block, state)) in view.world.blocks.iter().zip(&view.state.bodies).enumerate() {
        let highlighted = view.options.highlight == Some(SolidRef::Block(index));
        let (color, unlit) = canvas.body_color(ColorRole::Block(index), highlighted);
        let body = Body {
            center: vec2(state.center_m),
            half: 0.5 * Vec2::new(block.width_m as f32, block.height_m as f32),
            turn: state.angle_rad as f32,
            color,
            unlit,
        };
        match block.shape {
            Shape::Block => draw_box(canvas, body),
            Shape::Barrel => barrel::draw(canvas, body, state.broken),
            Shape::Cup => cup::draw(canvas, body, state.broken),
            // The pads keep it upright, whatever angle is stored.
            Shape::Needle => needle::draw(canvas, Body { turn: 0.0, ..body }),
        }
    }
}

fn draw_box(canvas: &mut Canvas<'_>, body: Body) {
    let Body { center, half, turn, color, unlit } = body;
    let solid = Solid::rounded_box(lift(center, 0.0), half.extend(HALF_DEPTH_M), turn, EDGE_M, color);
    canvas.solid(MeshKind::Box, solid.gloss(0.22).of(Material::Wood).unlit(unlit));
}

/// Half extents of the upright rectangle around a turned one.
pub(super) fn reach(half: Vec2, turn: f32) -> Vec2 {
    let Vec3 { x: cos, y: sin, .. } = Vec3::new(turn.cos().abs(), turn.sin().abs(), 0.0);
    Vec2::new(cos * half.x + sin * half.y, sin * half.x + cos * half.y)
}
