//! Guides: the slot behind the body that follows it, as two edges with a stop at each open end.

use super::canvas::{Canvas, Mode};
use crate::coordinates::vec2;
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use glam::Vec2;

/// Half the width of the slot and the radius of its edges, m.
const HALF_M: f32 = 0.0022;
const EDGE_M: f32 = 0.0007;
/// Segments of the drawing between two control points.
const PIECES: usize = 10;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    if canvas.mode == Mode::Ghost {
        return;
    }
    for block in &view.world.blocks {
        let Some(guide) = &block.guide else { continue };
        let depth = -(0.5 * block.width_m as f32 + 2.0 * EDGE_M);
        let pieces = PIECES * guide.pieces();
        let at = |k: usize| {
            let (place, slope) = guide.point(k as f64 / PIECES as f64);
            let along = vec2(slope).normalize_or_zero();
            (vec2(place), Vec2::new(-along.y, along.x))
        };
        let (edge, slot) = (canvas.palette.steel, canvas.palette.frame);
        let mut rod = |a: Vec2, b: Vec2, z: f32, radius: f32, color| {
            canvas.solid(
                MeshKind::Box,
                Solid::capsule(a.extend(z), b.extend(z), radius, color).gloss(0.6).of(Material::Polished),
            );
        };
        for k in 0..pieces {
            let ((a, left_a), (b, left_b)) = (at(k), at(k + 1));
            rod(a, b, depth - EDGE_M, HALF_M, slot);
            for side in [-HALF_M, HALF_M] {
                rod(a + side * left_a, b + side * left_b, depth, EDGE_M, edge);
            }
        }
        if !guide.closed {
            for k in [0, pieces] {
                let (end, left) = at(k);
                rod(end - HALF_M * left, end + HALF_M * left, depth, EDGE_M, edge);
            }
        }
    }
}
