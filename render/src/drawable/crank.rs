//! The crank: a dial behind, an arm about the axis, an upright handle that the pads can hold.

use super::canvas::{Canvas, HALF_DEPTH_M, Line, angle, at};
use crate::coordinates::vec2;
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::{SceneView, SolidRef};
use crate::shape::{Solid, Stroke};
use crate::theme::{Color, ColorRole};
use glam::{Vec2, Vec3};

/// Depths, back to front, m.
const DIAL_Z: [f32; 2] = [-0.0165, -0.0145];
const ARM_Z: [f32; 2] = [-0.0125, -0.0085];

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let (Some(crank), Some(handle)) = (&view.world.crank, view.state.handle_in_world(view.world)) else { return };
    let (center, handle, radius) = (vec2(crank.center_m), vec2(handle), crank.radius_m as f32);
    if canvas.mode == super::canvas::Mode::Real {
        stand(canvas, center, radius);
        dial(canvas, center, radius);
    }
    arm(canvas, center, handle);
    let highlighted = view.options.highlight == Some(SolidRef::Handle);
    draw_handle(canvas, handle, crank.handle_width_m as f32, highlighted);
}

/// A post down to the table.
fn stand(canvas: &mut Canvas<'_>, center: Vec2, radius: f32) {
    let Some(top) = canvas.table_top_m.filter(|top| *top < center.y) else { return };
    let frame = canvas.palette.frame;
    let foot = Vec2::new(center.x, top);
    canvas.solid(MeshKind::Plate, Solid::bar(foot, center, 0.3 * radius, [-0.024, DIAL_Z[0]], frame));
}

/// A disc with ticks every 15°, longer every 45°.
fn dial(canvas: &mut Canvas<'_>, center: Vec2, radius: f32) {
    let face = canvas.palette.table;
    let rim = radius + 0.0070;
    canvas.solid(MeshKind::Disc, Solid::disc(center, rim, DIAL_Z, face).gloss(0.15));
    let color = canvas.palette.grid;
    let z = DIAL_Z[1] + 0.0002;
    // The handle's path, in its own plane.
    canvas.circle(center, radius, 0.0, Line::solid(1.2, color), false);
    for tick in 0..24_u8 {
        let direction = angle(f32::from(tick) / 24.0);
        let inner = if tick % 3 == 0 { 0.0040 } else { 0.0022 };
        let (from, to) = (center + (rim - 0.0012 - inner) * direction, center + (rim - 0.0012) * direction);
        canvas.stroke(Stroke::line(at(from, z), at(to, z), 1.4, color));
    }
}

fn arm(canvas: &mut Canvas<'_>, center: Vec2, handle: Vec2) {
    let (link, brass, frame) = (canvas.palette.link, canvas.palette.brass, canvas.palette.frame);
    let tail = center - 0.32 * (handle - center);
    canvas.solid(MeshKind::Plate, Solid::bar(tail, handle, 0.0042, ARM_Z, link).gloss(0.5).of(Material::Brushed));
    canvas.solid(MeshKind::Plate, Solid::disc(tail, 0.0062, [ARM_Z[0] - 0.001, ARM_Z[1] + 0.001], frame).gloss(0.3));
    canvas.solid(MeshKind::Plate, Solid::disc(center, 0.0058, [DIAL_Z[1], ARM_Z[1] + 0.0016], frame).gloss(0.4));
    canvas
        .solid(MeshKind::Plate, Solid::disc(center, 0.0028, [DIAL_Z[1], 0.0], brass).gloss(0.8).of(Material::Polished));
}

/// The handle keeps upright on its bearing; its sides are flat for the pads.
fn draw_handle(canvas: &mut Canvas<'_>, handle: Vec2, width: f32, highlighted: bool) {
    let mut color = canvas.color(ColorRole::Block(0));
    if highlighted {
        color = color.mix(Color::rgb8(0xFF, 0xFF, 0xFF), 0.35);
    }
    let brass = canvas.palette.brass;
    let half = Vec3::new(0.5 * width, 0.5 * width + 0.001, 0.5 * (HALF_DEPTH_M - ARM_Z[1]) - 0.0004);
    let middle = at(handle, 0.5 * (HALF_DEPTH_M + ARM_Z[1]) + 0.0004);
    let edge = (0.22 * width).min(0.0025);
    let grip = Solid::rounded_box(middle, half, 0.0, edge, color).of(Material::Rubber).unlit(if highlighted {
        0.35
    } else {
        0.0
    });
    canvas.solid(MeshKind::Box, grip);
    let cap = [HALF_DEPTH_M - 0.0005, HALF_DEPTH_M + 0.0012];
    canvas.solid(MeshKind::Plate, Solid::disc(handle, 0.26 * width, cap, brass).gloss(0.8).of(Material::Polished));
}
