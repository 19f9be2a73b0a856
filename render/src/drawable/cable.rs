//! Cables from an eyelet to the back of the body that they hold. A slack one hangs as a catenary of its true length,
//! and lies on the table where it reaches it; a taut one is straight and shows the size of its pull.

use super::canvas::{Canvas, Mode, angle};
use crate::coordinates::vec2;
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use crate::theme::{Color, ColorRole};
use glam::{Vec2, Vec3};

const RADIUS_M: f32 = 0.00065;
/// Segments of the drawing of a slack cable.
const PIECES: u16 = 28;
/// Radius of the eyelet's ring and of its wire, m.
const RING_M: f32 = 0.0027;
const WIRE_M: f32 = 0.0006;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for (block, state) in view.world.blocks.iter().zip(&view.state.bodies) {
        let Some(cable) = &block.cable else { continue };
        let (anchor, end) = (vec2(cable.anchor_m), vec2(state.center_m));
        let depth = -(0.5 * block.width_m as f32 + 2.0 * RADIUS_M);
        if canvas.mode == Mode::Real {
            eyelet(canvas, anchor, depth);
        }
        let taut = state.cable_n > 0.0;
        // As hard as it can look: three times the hanging weight.
        let weight_n = (block.mass_kg * view.world.gravity_m_s2.abs()).max(0.5);
        let (color, unlit) =
            if taut { pull_color(canvas, (state.cable_n / weight_n) as f32) } else { (canvas.palette.rope, 0.0) };
        let floor = canvas.table_top_m.map_or(f32::MIN, |top| top + RADIUS_M);
        let mut piece = |a: Vec3, b: Vec3| {
            canvas.solid(
                MeshKind::Box,
                Solid::capsule(a, b, RADIUS_M, color).gloss(0.2).of(Material::Rubber).unlit(unlit),
            );
        };
        if taut {
            piece(anchor.extend(depth), end.extend(depth));
        } else {
            let hanging = catenary(anchor, end, cable.length_m as f32);
            let lying = hanging.map(|point| fold(point, floor, depth));
            for pair in lying.windows(2) {
                piece(pair[0], pair[1]);
            }
        }
    }
}

/// Colour of the rope by its pull, and the share of it that shines by itself. It goes from the rope's own colour at no
/// pull over the colour of constraints at the body's weight to the warning colour at three times the weight.
fn pull_color(canvas: &Canvas<'_>, weights: f32) -> (Color, f32) {
    let (constraint, hard) = (canvas.color(ColorRole::Constraint), canvas.color(ColorRole::Saturated));
    let color = canvas.palette.rope.mix(constraint, (0.4 + 0.6 * weights).min(1.0));
    (color.mix(hard, (0.5 * (weights - 1.0)).clamp(0.0, 1.0)), 0.35)
}

/// A ring on a small plate.
fn eyelet(canvas: &mut Canvas<'_>, anchor: Vec2, depth: f32) {
    let (frame, steel) = (canvas.palette.frame, canvas.palette.steel);
    if let Some(top) = canvas.table_top_m.filter(|top| (anchor.y - top).abs() < 0.004) {
        let foot = Vec3::new(anchor.x, top + 0.0003, depth);
        canvas.solid(MeshKind::Plate, Solid::drum(foot, Vec2::splat(0.0044), 0.0003, 0.0, frame).gloss(0.4));
    }
    let at = |i: u16| (anchor + RING_M * angle(f32::from(i) / 12.0)).extend(depth);
    for i in 0..12 {
        canvas.solid(MeshKind::Box, Solid::capsule(at(i), at(i + 1), WIRE_M, steel).gloss(0.8).of(Material::Polished));
    }
}

/// Point of a cable; parts that would hang below the table lie on it, backwards, just as long.
fn fold(point: Vec2, floor: f32, depth: f32) -> Vec3 {
    let below = (floor - point.y).max(0.0);
    Vec3::new(point.x, point.y.max(floor), depth - below)
}

/// Points of a cable of `length` that hangs between `a` and `b`; a straight line when it is not longer than the way.
fn catenary(a: Vec2, b: Vec2, length: f32) -> [Vec2; PIECES as usize + 1] {
    let way = b - a;
    let share = |i: usize| i as f32 / f32::from(PIECES);
    let straight = std::array::from_fn(|i| a + share(i) * way);
    // Hanging straight down has no catenary; a hair beside it looks the same.
    let span = way.x.abs().max(0.02 * length);
    let stretched = (length * length - way.y * way.y).max(0.0).sqrt() / span;
    if stretched.is_nan() || stretched <= 1.0005 {
        return straight;
    }
    let bend = bend(stretched);
    // y = c cosh((x − x0) / c) + y0 with c = span / (2 bend); its lowest place from the heights of both ends.
    let c = 0.5 * span / bend;
    let lowest = 0.5 * span - c * (way.y / length).clamp(-0.999_999, 0.999_999).atanh();
    let height = |x: f32| c * ((x - lowest) / c).cosh();
    // Even steps of length, not of width: steep parts keep their shape.
    let arc = |x: f32| c * ((x - lowest) / c).sinh();
    let at = |i: usize| {
        let along = arc(0.0) + share(i) * (arc(span) - arc(0.0));
        let x = lowest + c * (along / c).asinh();
        a + Vec2::new(x / span * way.x, height(x) - height(0.0))
    };
    std::array::from_fn(at)
}

/// The b of sinh(b)/b = `stretched`, for values above 1: Newton from above, where the function is convex.
fn bend(stretched: f32) -> f32 {
    let mut b = (6.0 * (stretched - 1.0)).sqrt().min(2.0 + 2.0 * stretched.ln());
    b = b.max(1e-3);
    for _ in 0..20 {
        let (value, slope) = (b.sinh() - stretched * b, b.cosh() - stretched);
        b = (b - value / slope.max(1e-6)).clamp(1e-3, 20.0);
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(points: &[Vec2]) -> f32 {
        points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    #[test]
    fn a_slack_cable_has_its_length_and_its_ends() {
        for end in [Vec2::new(0.02, 0.01), Vec2::new(-0.03, 0.0), Vec2::new(0.001, 0.02), Vec2::new(0.01, -0.03)] {
            for slack in [1.02, 1.2, 2.0, 4.0] {
                let wanted = slack * end.length();
                let points = catenary(Vec2::ZERO, end, wanted);
                let found = length(&points);
                // A hair beside the vertical it is a hair longer.
                assert!((found / wanted - 1.0).abs() < 0.03, "{end} {slack}: {found} instead of {wanted}");
                assert!(points[0].length() < 1e-5 && points[PIECES as usize].distance(end) < 1e-4, "{end} {slack}");
            }
        }
    }

    #[test]
    fn what_lies_on_the_table_is_as_long_as_it_hung() {
        let hung = catenary(Vec2::ZERO, Vec2::new(0.02, 0.015), 0.045);
        let lying = hung.map(|point| fold(point, 0.0, -0.01));
        assert!(lying.iter().all(|point| point.y >= 0.0));
        let found: f32 = lying.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        assert!((found / 0.045 - 1.0).abs() < 0.02, "{found}");
    }

    #[test]
    fn a_cable_without_slack_is_straight() {
        let points = catenary(Vec2::ZERO, Vec2::new(0.03, 0.01), 0.02);
        assert!((length(&points) - Vec2::new(0.03, 0.01).length()).abs() < 1e-6);
    }
}
