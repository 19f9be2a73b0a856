//! Links: each finger is a double parallelogram of machined bars, so its tip keeps upright.
//!
//! The linkage is drawn shifted by a constant vector (the wrist above the tip): because the tip does not turn, joint angles and
//! lengths are exactly those of the kinematics.

use super::canvas::{Canvas, outwards, tip};
use crate::coordinates::{lift, vec2};
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use crate::theme::{Color, ColorRole};
use glam::{Vec2, Vec3};

/// From the tip to the wrist joint: outwards and up, m.
const WRIST_M: Vec2 = Vec2::new(0.0085, 0.0165);
/// The second bar of the upper and of the lower link beside the first: outwards and up, m.
const UPPER_OFFSET_M: Vec2 = Vec2::new(0.0105, 0.0050);
const LOWER_OFFSET_M: Vec2 = Vec2::new(0.0020, 0.0105);

/// Depths, back to front, m: lower links behind the couplers, upper links before them.
const LOWER_Z: [f32; 2] = [-0.0052, -0.0024];
const COUPLER_Z: [f32; 2] = [-0.0020, 0.0020];
const UPPER_Z: [f32; 2] = [0.0024, 0.0052];

const BAR_RADIUS_M: f32 = 0.0040;
const SECOND_RADIUS_M: f32 = 0.0029;
const COUPLER_RADIUS_M: f32 = 0.0048;

/// The joints of one finger as drawn.
struct Joints {
    base: Vec2,
    elbow: Vec2,
    wrist: Vec2,
    /// From a joint to its twin on the second bar.
    upper: Vec2,
    lower: Vec2,
}

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for finger in 0..2 {
        let Some(joints) = joints(view, finger) else { continue };
        let accent = canvas.color(ColorRole::Finger(finger));
        links(canvas, &joints);
        couplers(canvas, &joints, outwards(finger));
        motor(canvas, &joints, accent);
        pins(canvas, &joints, accent);
    }
    if canvas.mode == super::canvas::Mode::Real {
        rail(canvas, view);
    }
}

/// `None` when the tip is out of reach: then only the fingertip is drawn.
fn joints(view: &SceneView<'_>, finger: usize) -> Option<Joints> {
    tip(view.state, finger)?;
    let model = &view.world.hand.fingers[finger];
    let tip_in_world = view.state.input.tip_in_world[finger];
    let q = model.joint_angles(tip_in_world)?;
    let mirror = Vec2::new(outwards(finger), 1.0);
    let shift = WRIST_M * mirror;
    Some(Joints {
        base: vec2(model.base_m) + shift,
        elbow: vec2(model.elbow_in_world(q)) + shift,
        wrist: vec2(tip_in_world) + shift,
        upper: UPPER_OFFSET_M * mirror,
        lower: LOWER_OFFSET_M * mirror,
    })
}

fn links(canvas: &mut Canvas<'_>, j: &Joints) {
    let (first, second) = (canvas.palette.link, canvas.palette.link_secondary);
    let mut bar = |a: Vec2, b: Vec2, radius, z, color| {
        canvas.solid(MeshKind::Plate, Solid::bar(a, b, radius, z, color).gloss(0.45).of(Material::Brushed));
    };
    bar(j.base, j.elbow, BAR_RADIUS_M, UPPER_Z, first);
    bar(j.base + j.upper, j.elbow + j.upper, SECOND_RADIUS_M, UPPER_Z, second);
    bar(j.elbow, j.wrist, BAR_RADIUS_M, LOWER_Z, first);
    bar(j.elbow + j.lower, j.wrist + j.lower, SECOND_RADIUS_M, LOWER_Z, second);
}

fn couplers(canvas: &mut Canvas<'_>, j: &Joints, out: f32) {
    let color = canvas.palette.coupler;
    let mut z = COUPLER_Z;
    let mut bar = |a: Vec2, b: Vec2, radius| {
        canvas.solid(MeshKind::Plate, Solid::bar(a, b, radius, z, color).gloss(0.3));
        // Faces in the very same plane would flicker where bars overlap.
        z[1] -= 0.00005;
    };
    bar(j.base, j.base + j.upper, COUPLER_RADIUS_M);
    bar(j.elbow, j.elbow + j.upper, COUPLER_RADIUS_M);
    bar(j.elbow, j.elbow + j.lower, COUPLER_RADIUS_M);
    bar(j.elbow + j.upper, j.elbow + j.lower, COUPLER_RADIUS_M - 0.001);
    // The wrist carries the blade of the fingertip.
    bar(j.wrist, j.wrist + j.lower, COUPLER_RADIUS_M);
    bar(j.wrist, j.wrist - Vec2::new(out * 0.0030, 0.0), 0.0032);
}

/// A motor behind the base joint, and its face in the finger's colour.
fn motor(canvas: &mut Canvas<'_>, j: &Joints, accent: Color) {
    let body = canvas.palette.frame;
    canvas.solid(MeshKind::Disc, Solid::disc(j.base, 0.0115, [-0.034, -0.0055], body).gloss(0.35));
    canvas.solid(MeshKind::Disc, Solid::disc(j.base, 0.0088, [-0.0056, -0.0046], accent).gloss(0.2));
}

fn pins(canvas: &mut Canvas<'_>, j: &Joints, accent: Color) {
    let (pin, z_back) = (canvas.palette.pin, LOWER_Z[0] - 0.0006);
    let all = [
        (j.base, 0.0021),
        (j.base + j.upper, 0.0016),
        (j.elbow + j.upper, 0.0016),
        (j.elbow + j.lower, 0.0016),
        (j.elbow, 0.0021),
        (j.wrist, 0.0021),
        (j.wrist + j.lower, 0.0016),
    ];
    for (center, radius) in all {
        let upper = center == j.base || center == j.elbow || center == j.base + j.upper || center == j.elbow + j.upper;
        let front = if upper { UPPER_Z[1] } else { COUPLER_Z[1] };
        canvas.solid(
            MeshKind::Plate,
            Solid::disc(center, radius, [z_back, front + 0.0008], pin).gloss(0.9).of(Material::Polished),
        );
        if radius > 0.002 {
            let ring = [front - 0.0001, front + 0.0004];
            canvas.solid(MeshKind::Plate, Solid::disc(center, radius + 0.0010, ring, accent).gloss(0.2));
        }
    }
}

/// The beam that both fingers hang from.
fn rail(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let [a, b] = [0, 1].map(|i| vec2(view.world.hand.fingers[i].base_m) + WRIST_M * Vec2::new(outwards(i), 1.0));
    let half = Vec3::new(0.5 * (b - a).length() + 0.018, 0.0055, 0.0045);
    let turn = (b - a).to_angle();
    let center = lift(0.5 * (a + b) + Vec2::Y * 0.004, -0.026);
    let frame = canvas.palette.frame;
    canvas.solid(MeshKind::Box, Solid::rounded_box(center, half, turn, 0.0012, frame).gloss(0.4));
}
