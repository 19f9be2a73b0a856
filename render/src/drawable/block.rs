//! Movable bodies: blocks are boxes with slightly rounded edges; barrels, cups and needles have files of their own.

use super::body::Body;
use super::canvas::{Canvas, HALF_DEPTH_M};
use super::{barrel, cup, needle};
use crate::coordinates::{lift, vec2};
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::{SceneView, SolidRef};
use crate::shape::Solid;
use crate::theme::ColorRole;
use glam::Vec2;
use haptics::world::Shape;

/// Radius of the edges, m.
const EDGE_M: f32 = 0.0009;

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
