//! Barrels: small steel drums with two hoops, a band with a placard between them, and a lid. A broken one shows its
//! crack; its filling can never be seen.

use super::body::Body;
use super::canvas::Canvas;
use crate::mesh::MeshKind;
use crate::shape::Solid;
use crate::theme::Color;
use glam::{Vec2, Vec3};

/// Heights of hoops, as shares of the half height.
const HOOPS: [f32; 2] = [-0.30, 0.36];
/// Half the height of a hoop, of the chimes at both ends and how far they stand out, in shares of the radius.
const HOOP_HALF: f32 = 0.055;
const CHIME_HALF: f32 = 0.07;
const OUT: f32 = 0.03;

/// Corners of the crack, in shares of radius and half height, with the half width of the line in shares of the radius.
const CRACK: [[f32; 3]; 7] = [
    [0.20, -0.06, 0.008],
    [0.30, -0.15, 0.020],
    [0.19, -0.27, 0.028],
    [0.35, -0.37, 0.036],
    [0.24, -0.48, 0.030],
    [0.37, -0.55, 0.022],
    [0.34, -0.63, 0.008],
];
/// Side branches: corners of the crack that they leave, and where they end.
const BRANCHES: [(usize, [f32; 2]); 3] = [(2, [0.05, -0.32]), (3, [0.50, -0.33]), (4, [0.11, -0.53])];

pub(super) fn draw(canvas: &mut Canvas<'_>, body: Body, broken: bool) {
    shell(canvas, body);
    lid(canvas, body);
    placard(canvas, body);
    if broken {
        crack(canvas, body);
    }
}

/// A ring or cylinder of the barrel between two heights in its own frame.
fn ring(canvas: &mut Canvas<'_>, body: Body, radius: f32, [low, high]: [f32; 2], color: Color, gloss: f32) {
    let center = body.to_world(Vec2::Y * 0.5 * (low + high)).extend(0.0);
    let drum = Solid::drum(center, Vec2::splat(radius), 0.5 * (high - low), body.turn, color);
    canvas.solid(MeshKind::Disc, drum.gloss(gloss).unlit(body.unlit));
}

/// Radius of the wall between the hoops.
fn wall(body: Body) -> f32 {
    body.half.x * (1.0 - OUT)
}

fn shell(canvas: &mut Canvas<'_>, body: Body) {
    let (radius, top) = (body.half.x, body.half.y);
    let dark = body.color.mix(canvas.palette.frame, 0.35);
    ring(canvas, body, wall(body), [-top, top - 0.02 * radius], body.color, 0.55);
    for at in HOOPS {
        ring(canvas, body, radius, [at * top - HOOP_HALF * radius, at * top + HOOP_HALF * radius], body.color, 0.6);
    }
    let chime = 2.0 * CHIME_HALF * radius;
    ring(canvas, body, radius, [-top, chime - top], dark, 0.5);
    ring(canvas, body, radius, [top - chime, top], dark, 0.6);
}

/// The lid lies inside the upper chime; its closed bung tells nothing about the content.
fn lid(canvas: &mut Canvas<'_>, body: Body) {
    let (radius, top) = (body.half.x, body.half.y);
    let (steel, inset) = (canvas.palette.steel, body.color.mix(canvas.palette.frame, 0.15));
    ring(canvas, body, 0.88 * radius, [top - 0.001, top + 0.00006], inset, 0.3);
    let across = Vec2::from_angle(body.turn);
    let up = across.perp();
    let bung = body.center + top * up + 0.42 * radius * across;
    let center = (bung + 0.0003 * up).extend(0.25 * radius);
    let drum = Solid::drum(center, Vec2::splat(0.17 * radius), 0.0005, body.turn, steel);
    canvas.solid(MeshKind::Plate, drum.gloss(0.8));
}

/// A band and a placard with an exclamation mark between the hoops: careful, it holds something.
fn placard(canvas: &mut Canvas<'_>, body: Body) {
    let (brass, mark) = (canvas.palette.brass, canvas.palette.frame);
    let (radius, top) = (body.half.x, body.half.y);
    let [low, high] = [HOOPS[0] * top, HOOPS[1] * top];
    let (middle, room) = (0.5 * (low + high), 0.5 * (high - low) - HOOP_HALF * radius);
    ring(canvas, body, wall(body) + 0.00008, [middle - 0.62 * room, middle + 0.62 * room], brass, 0.35);
    let front = wall(body);
    let mut slab = |at: Vec2, half: Vec2, turn: f32, raised: f32, edge: f32, color: Color| {
        // Deep enough that its edges reach into the round wall.
        let depth = 0.5 * (0.0014 + raised);
        let center = body.to_world(at).extend(front + raised - depth);
        let solid = Solid::rounded_box(center, half.extend(depth), body.turn + turn, edge, color);
        canvas.solid(MeshKind::Box, solid.gloss(0.2).unlit(body.unlit));
    };
    let side = 0.62 * room;
    let eighth = std::f32::consts::FRAC_PI_4;
    let at = Vec2::Y * middle;
    slab(at, Vec2::splat(1.16 * side), eighth, 0.00020, 0.00012, mark);
    slab(at, Vec2::splat(side), eighth, 0.00034, 0.00012, Color::rgb8(0xF4, 0xF1, 0xE8));
    slab(at + Vec2::Y * 0.22 * side, Vec2::new(0.13, 0.50) * side, 0.0, 0.00048, 0.00008, mark);
    slab(at - Vec2::Y * 0.60 * side, Vec2::splat(0.14 * side), 0.0, 0.00048, 0.00008, mark);
}

/// Starting points of drips from the crack, in the barrel's frame: its lower end and two corners.
pub(super) fn drip_starts(half: Vec2) -> [Vec2; 3] {
    let [x, y, _] = CRACK[5];
    let [left_x, left_y, _] = CRACK[4];
    let (_, [right_x, right_y]) = BRANCHES[1];
    [[x, y], [left_x, left_y], [right_x, right_y]].map(|corner| Vec2::from(corner) * half)
}

/// A crack in a round wall, in its lower half.
pub(super) fn crack(canvas: &mut Canvas<'_>, body: Body) {
    let color = Color::rgb8(0x16, 0x18, 0x1C);
    let scale = |[x, y, width]: [f32; 3]| (Vec2::new(x, y) * body.half, width * body.half.x);
    let mut line = |(a, thick): (Vec2, f32), (b, thin): (Vec2, f32)| {
        let [a, b] = [a, b].map(|p| on_front(body, p, 0.0001));
        // A flat ribbon would be cut by the round wall; a sunk shaft shows its front only.
        canvas.solid(MeshKind::Cone, Solid::cone(a, b, [thick, thin], color).gloss(0.0).unlit(0.6));
    };
    for pair in CRACK.windows(2) {
        line(scale(pair[0]), scale(pair[1]));
    }
    for (from, [x, y]) in BRANCHES {
        let (start, width) = scale(CRACK[from]);
        line((start, 0.7 * width), scale([x, y, 0.004]));
    }
}

/// A place on the front of the round hull, `raised` above the wall.
pub(super) fn on_front(body: Body, local: Vec2, raised: f32) -> Vec3 {
    let radius = body.half.x * (1.0 - OUT) + raised;
    let depth = (radius * radius - local.x * local.x).max(0.0).sqrt();
    body.to_world(local).extend(depth)
}
