//! Leaks of a body: a streak below the crack, drops on their way, a puddle that grows on the table.

use super::barrel::{drip_starts, on_front};
use super::body::{Body, reach};
use super::canvas::{Canvas, Mode, WHITE};
use crate::coordinates::vec2;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use glam::{Vec2, Vec3};
use haptics::world::{Block, BodyState, Shape};

/// Radius of a puddle that holds all of the content, in half widths of the body.
const PUDDLE: f32 = 2.1;
/// Places and sizes of its lobes, in radii of the puddle: a puddle is not a disc.
const LOBES: [[f32; 3]; 6] = [
    [0.0, 0.0, 0.72],
    [0.40, 0.22, 0.52],
    [-0.42, 0.30, 0.46],
    [-0.34, -0.34, 0.50],
    [0.44, -0.30, 0.44],
    [0.06, 0.52, 0.40],
];
/// Bright places, likewise; much longer than deep.
const GLINTS: [[f32; 3]; 3] = [[-0.46, 0.44, 0.22], [0.46, 0.46, 0.13], [0.10, 0.74, 0.10]];
/// Time between two drops, s of simulated time; a drop takes as long to fall as it does to grow.
const DROP_PERIOD_S: f64 = 0.45;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for (block, state) in view.world.blocks.iter().zip(&view.state.bodies) {
        let Some(content) = &block.content else { continue };
        let runs = state.broken || state.leaked_kg > 0.0;
        if !runs || content.mass_kg <= 0.0 {
            continue;
        }
        let share = (state.leaked_kg / content.mass_kg).clamp(0.0, 1.0) as f32;
        let color = canvas.palette.liquid;
        let half = 0.5 * Vec2::new(block.width_m as f32, block.height_m as f32);
        let (center, turn) = (vec2(state.center_m), state.angle_rad as f32);
        let body = Body { center, half, turn, color, unlit: 0.0 };
        if canvas.mode == Mode::Real {
            puddle(canvas, body, state.spilled_x_m as f32, share);
        }
        if is_round(block) && state.broken {
            streak(canvas, body, share);
        }
        if share < 1.0 {
            drop(canvas, (block, state), body, view.state.time_s);
        }
    }
}

/// Whose wall shows where it leaks.
fn is_round(block: &Block) -> bool {
    matches!(block.shape, Shape::Barrel | Shape::Cup)
}

/// Thin overlapping discs on the table, a darker rim below a lighter face.
fn puddle(canvas: &mut Canvas<'_>, body: Body, spilled_x: f32, share: f32) {
    let Some(top) = canvas.table_top_m.filter(|_| share > 0.0) else { return };
    let radius = PUDDLE * body.half.x * share.sqrt();
    let middle = Vec2::new(spilled_x + 0.3 * body.half.x, 0.35 * body.half.x);
    let rim = body.color.mix(canvas.palette.frame, 0.35);
    let glint = body.color.mix(WHITE, 0.32);
    let mut face = |at: Vec2, radii: Vec2, height: f32, color| {
        let at = middle + radius * at;
        let drum = Solid::drum(Vec3::new(at.x, top, at.y), radii.max(Vec2::splat(1e-4)), height, 0.0, color);
        canvas.solid(MeshKind::Disc, drum.gloss(0.55));
    };
    // The faces stay below the shadows, which lie 0.1 mm above the table.
    for [x, z, size] in LOBES {
        let (at, size) = (Vec2::new(x, z), size * radius);
        face(at, Vec2::splat(size), 0.00003, rim);
        face(at, Vec2::splat(size - 0.0006), 0.00006, body.color);
    }
    // The sky in it, towards the key light.
    for [x, z, size] in GLINTS {
        face(Vec2::new(x, z), Vec2::new(size, 0.22 * size) * radius, 0.00008, glint);
    }
}

/// Wet lines down the wall, the longer the more has run out; the one from the crack's end reaches the ground.
fn streak(canvas: &mut Canvas<'_>, body: Body, share: f32) {
    let lines = [(1.0, 1.0), (0.35 + 0.5 * share, 0.7), (0.30 + 0.6 * share, 0.6)];
    for (start, (length, wide)) in drip_starts(body.half).into_iter().zip(lines) {
        let end = start.y + (-body.half.y - start.y) * length;
        let radius = 0.05 * body.half.x * wide;
        let [a, b] = [start.y, end].map(|y| on_front(body, Vec2::new(start.x, y), 0.0001));
        canvas.solid(MeshKind::Box, Solid::capsule(a, b, radius, body.color).gloss(0.9));
        canvas.solid(MeshKind::Box, Solid::ball(b, 1.5 * radius, body.color).gloss(0.9));
    }
}

/// One drop: it hangs and grows, then falls to the table.
fn drop(canvas: &mut Canvas<'_>, (block, state): (&Block, &BodyState), body: Body, time_s: f64) {
    let phase = (time_s / DROP_PERIOD_S).rem_euclid(1.0) as f32;
    let lowest = body.center.y - reach(body.half, body.turn).y;
    let from = if is_round(block) && state.broken {
        on_front(body, Vec2::new(drip_starts(body.half)[0].x, -body.half.y), 0.0)
    } else {
        Vec3::new(body.center.x, lowest, 0.6 * body.half.x)
    };
    let size = 0.07 * body.half.x;
    let floor = canvas.table_top_m.unwrap_or(lowest - 0.02);
    let fallen = 2.0 * phase - 1.0;
    let (y, radius) = if fallen <= 0.0 {
        (from.y - 0.6 * size * (1.0 + fallen), size * (0.4 + 0.6 * (1.0 + fallen)))
    } else {
        (from.y - size - fallen * fallen * (from.y - size - floor).max(0.0), size)
    };
    let center = Vec3::new(from.x, y, from.z);
    canvas.solid(MeshKind::Box, Solid::ball(center, radius, body.color).gloss(0.9));
}
