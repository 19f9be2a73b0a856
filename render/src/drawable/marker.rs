//! Found constraints: a centre of rotation with its radius and uncertainty, or a direction of motion.

use super::{Canvas, Line, at};
use crate::draw_data::Layer;
use crate::mesh::MeshKind;
use crate::scene::{ConstraintMarker, SceneView};
use crate::shape::{Solid, Stroke};
use crate::theme::ColorRole;
use crate::vec2;
use glam::Vec2;

/// Half the size of the cross at a centre, m.
const CROSS_M: f32 = 0.0028;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for marker in &view.options.constraints {
        match *marker {
            ConstraintMarker::Revolute { center_m, radius_m, center_std_m } => {
                revolute(canvas, vec2(center_m), radius_m as f32, 2.0 * center_std_m as f32);
            }
            ConstraintMarker::Prismatic { origin_m, direction, length_m, std_m } => {
                let half = 0.5 * length_m as f32 * vec2(direction).normalize_or_zero();
                prismatic(canvas, vec2(origin_m), half, 2.0 * std_m as f32);
            }
        }
    }
}

fn revolute(canvas: &mut Canvas<'_>, center: Vec2, radius: f32, uncertainty: f32) {
    let color = canvas.color(ColorRole::Constraint);
    canvas.circle(center, radius, 0.0, Line { width_px: 1.8, color, dash_m: 0.004 }, true);
    if uncertainty > 0.0 {
        let disc = Solid::disc(center, uncertainty, [0.0, 0.0004], color.with_alpha(0.28)).unlit(1.0);
        canvas.solid_in(Layer::Glass, MeshKind::Plate, disc);
        canvas.circle(center, uncertainty, 0.0, Line::solid(1.4, color), true);
    }
    for arm in [Vec2::X, Vec2::Y] {
        let cross = CROSS_M * arm;
        canvas.overlay_stroke(Stroke::line(at(center - cross, 0.0), at(center + cross, 0.0), 2.2, color));
    }
    canvas.solid_in(Layer::Overlay, MeshKind::Box, Solid::ball(at(center, 0.0), 0.0011, color).unlit(0.5));
}

fn prismatic(canvas: &mut Canvas<'_>, origin: Vec2, half: Vec2, uncertainty: f32) {
    let color = canvas.color(ColorRole::Constraint);
    let mut line = |a: Vec2, b: Vec2, width_px, dash_m| {
        canvas.overlay_stroke(Stroke::line(at(a, 0.0), at(b, 0.0), width_px, color).dashed(dash_m, 0.0));
    };
    line(origin - half, origin + half, 2.2, 0.0);
    for end in [half, -half] {
        for side in [0.45_f32, -0.45] {
            let barb = Vec2::from_angle(side).rotate(end.normalize_or_zero()) * 0.003;
            line(origin + end, origin + end - barb, 2.2, 0.0);
        }
    }
    if uncertainty > 0.0 {
        let across = half.normalize_or_zero().perp() * uncertainty;
        line(origin - half + across, origin + half + across, 1.2, 0.003);
        line(origin - half - across, origin + half - across, 1.2, 0.003);
        let band =
            Solid::bar(origin - half, origin + half, uncertainty, [0.0, 0.0004], color.with_alpha(0.2)).unlit(1.0);
        canvas.solid_in(Layer::Glass, MeshKind::Plate, band);
    }
}
