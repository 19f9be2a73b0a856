//! Needles: a plastic hub that the pads hold and a thin steel shaft whose point is the middle of the body's lower edge.

use super::body::Body;
use super::canvas::Canvas;
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::shape::Solid;
use crate::theme::{Color, Theme};
use glam::{Vec2, Vec3};

/// Height of the hub's lower end above the point, as a share of the whole; and of the shaft's shoulder below it.
const HUB: f32 = 0.50;
const SHOULDER: f32 = 0.42;
/// Length of the ground point, share of the whole.
const POINT: f32 = 0.13;
/// Radius of the shaft, share of the hub's.
const SHAFT: f32 = 0.17;
/// Grooves of the hub, shares of its height from below.
const GROOVES: [f32; 4] = [0.14, 0.24, 0.76, 0.86];

pub(super) fn draw(canvas: &mut Canvas<'_>, body: Body) {
    // Thin things need more contrast than large ones.
    let towards = if canvas.theme == Theme::Light { canvas.palette.frame } else { canvas.palette.pin };
    let steel = canvas.palette.steel.mix(towards, 0.3);
    let (radius, height) = (body.half.x, 2.0 * body.half.y);
    let tip = body.center - Vec2::Y * body.half.y;
    let at = |share: f32| (tip + Vec2::Y * share * height).extend(0.0);
    hub(canvas, body, [at(HUB), at(1.0)]);
    let mut shaft = |from: f32, to: f32, radii: [f32; 2], color: Color| {
        let solid = Solid::cone(at(from), at(to), radii.map(|share| share * radius), color);
        canvas.solid(MeshKind::Cone, solid.gloss(0.8).of(Material::Polished).unlit(body.unlit));
    };
    let collar = body.color.mix(steel, 0.45);
    shaft(HUB + 0.005, SHOULDER, [0.72, 0.34], collar);
    shaft(SHOULDER + 0.005, POINT, [SHAFT, SHAFT], steel);
    shaft(POINT, 0.0, [SHAFT, 0.0], steel);
}

/// A ribbed cylinder as wide as the body, with a cap.
fn hub(canvas: &mut Canvas<'_>, body: Body, [low, high]: [Vec3; 2]) {
    let radius = body.half.x;
    let (frame, height) = (canvas.palette.frame, high.y - low.y);
    let groove = body.color.mix(frame, 0.55);
    let mut drum = |from: f32, to: f32, wide: f32, color: Color| {
        let center = low + Vec3::Y * 0.5 * (from + to) * height;
        let solid = Solid::drum(center, Vec2::splat(wide * radius), 0.5 * (to - from) * height, 0.0, color);
        canvas.solid(MeshKind::Plate, solid.gloss(0.35).unlit(body.unlit));
    };
    drum(0.0, 0.97, 0.93, groove);
    let mut start = 0.0;
    for at in GROOVES {
        drum(start, at - 0.02, 1.0, body.color);
        start = at + 0.02;
    }
    drum(start, 0.97, 1.0, body.color);
    drum(0.97, 1.0, 0.78, frame);
}
