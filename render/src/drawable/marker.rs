//! Found constraints: a centre of rotation with its circle and uncertainty, a direction of motion, a curve, a surface.

use super::canvas::{Canvas, Line, angle, at, mark_scale};
use crate::coordinates::vec2;
use crate::draw_data::Layer;
use crate::mesh::MeshKind;
use crate::scene::{ConstraintMarker, SceneView};
use crate::shape::{Solid, Stroke};
use crate::theme::{Color, ColorRole};
use glam::Vec2;

/// Half the size of the cross at a centre, period of dashes, length of barbs, m in a picture of the workspace.
const CROSS_M: f32 = 0.0028;
const DASH_M: f32 = 0.004;
const BARB_M: f32 = 0.003;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let scale = mark_scale(view);
    for marker in &view.options.constraints {
        match marker {
            ConstraintMarker::Revolute { center_m, radius_m, center_axes_m } => {
                revolute(canvas, (vec2(*center_m), *radius_m as f32), center_axes_m.map(vec2), scale);
            }
            ConstraintMarker::Prismatic { origin_m, direction, length_m, std_m } => {
                let half = 0.5 * *length_m as f32 * vec2(*direction).normalize_or_zero();
                prismatic(canvas, (vec2(*origin_m), half), 2.0 * *std_m as f32, scale);
            }
            ConstraintMarker::Path { points_m } => path(canvas, points_m, scale),
            ConstraintMarker::Surface { ends_m, normal, std_m } => {
                surface(canvas, ends_m.map(vec2), vec2(*normal).normalize_or_zero(), 2.0 * *std_m as f32);
            }
        }
    }
}

fn revolute(canvas: &mut Canvas<'_>, (center, radius): (Vec2, f32), axes: [Vec2; 2], scale: f32) {
    let color = canvas.color(ColorRole::Constraint);
    canvas.circle(center, radius, 0.0, Line { width_px: 1.8, color, dash_m: scale * DASH_M }, true);
    if axes.iter().all(|axis| axis.length() > 0.0) {
        ellipse(canvas, center, axes, color);
    }
    for arm in [Vec2::X, Vec2::Y] {
        let cross = scale * CROSS_M * arm;
        canvas.overlay_stroke(Stroke::line(at(center - cross, 0.0), at(center + cross, 0.0), 2.2, color));
    }
    canvas.solid_in(Layer::Overlay, MeshKind::Box, Solid::ball(at(center, 0.0), 0.0011 * scale, color).unlit(0.5));
}

/// A translucent ellipse with its outline.
fn ellipse(canvas: &mut Canvas<'_>, center: Vec2, axes: [Vec2; 2], color: Color) {
    let solid = Solid::ellipse(center, axes, [0.0, 0.0004], color.with_alpha(0.28)).unlit(1.0);
    canvas.solid_in(Layer::Glass, MeshKind::Disc, solid);
    let on_rim = |i: u16| {
        let turn = angle(f32::from(i) / 48.0);
        at(center + turn.x * axes[0] + turn.y * axes[1], 0.0)
    };
    for i in 0..48 {
        canvas.overlay_stroke(Stroke::line(on_rim(i), on_rim(i + 1), 1.4, color));
    }
}

/// A dashed curve.
fn path(canvas: &mut Canvas<'_>, points: &[haptics::Vec2], scale: f32) {
    let color = canvas.color(ColorRole::Constraint);
    let mut along = 0.0;
    for pair in points.windows(2) {
        let [a, b] = [vec2(pair[0]), vec2(pair[1])];
        canvas.overlay_stroke(Stroke::line(at(a, 0.0), at(b, 0.0), 2.2, color).dashed(scale * DASH_M, along));
        along += a.distance(b);
    }
}

/// The edge of the solid, hatched on its inner side as in drawings, with an arrow to where it pushes.
fn surface(canvas: &mut Canvas<'_>, [from, to]: [Vec2; 2], out: Vec2, uncertainty: f32) {
    let color = canvas.color(ColorRole::Constraint);
    let (length, along) = (from.distance(to), (to - from).normalize_or_zero());
    let mut line = |a: Vec2, b: Vec2, width_px, color| {
        canvas.overlay_stroke(Stroke::line(at(a, 0.0), at(b, 0.0), width_px, color));
    };
    line(from, to, 2.4, color);
    let depth = (0.06 * length).clamp(0.0015, 0.03);
    let hatches = (length / depth).ceil().clamp(1.0, 60.0) as u16;
    for i in 0..=hatches {
        let foot = from + along * length * f32::from(i) / f32::from(hatches);
        line(foot, foot - depth * (out + 0.7 * along), 1.2, color.with_alpha(0.7));
    }
    let middle = 0.5 * (from + to);
    let tip = middle + 2.2 * depth * out;
    line(middle, tip, 2.0, color);
    for side in [0.45_f32, -0.45] {
        line(tip, tip - Vec2::from_angle(side).rotate(out) * 0.7 * depth, 2.0, color);
    }
    if uncertainty > 0.0 {
        let band = Solid::bar(from, to, uncertainty, [0.0, 0.0004], color.with_alpha(0.2)).unlit(1.0);
        canvas.solid_in(Layer::Glass, MeshKind::Plate, band);
    }
}

fn prismatic(canvas: &mut Canvas<'_>, (origin, half): (Vec2, Vec2), uncertainty: f32, scale: f32) {
    let color = canvas.color(ColorRole::Constraint);
    let mut line = |a: Vec2, b: Vec2, width_px, dash_m| {
        canvas.overlay_stroke(Stroke::line(at(a, 0.0), at(b, 0.0), width_px, color).dashed(dash_m, 0.0));
    };
    line(origin - half, origin + half, 2.2, 0.0);
    for end in [half, -half] {
        for side in [0.45_f32, -0.45] {
            let barb = Vec2::from_angle(side).rotate(end.normalize_or_zero()) * scale * BARB_M;
            line(origin + end, origin + end - barb, 2.2, 0.0);
        }
    }
    if uncertainty > 0.0 {
        let across = half.normalize_or_zero().perp() * uncertainty;
        line(origin - half + across, origin + half + across, 1.2, scale * BARB_M);
        line(origin - half - across, origin + half - across, 1.2, scale * BARB_M);
        let band =
            Solid::bar(origin - half, origin + half, uncertainty, [0.0, 0.0004], color.with_alpha(0.2)).unlit(1.0);
        canvas.solid_in(Layer::Glass, MeshKind::Plate, band);
    }
}
