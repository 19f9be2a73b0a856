//! Paper cups: a tapering wall with a rolled rim, a sleeve around the middle, and the visible part of the inside from
//! above. A crushed one shows its tear.

use super::barrel::crack;
use super::body::Body;
use super::canvas::Canvas;
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::shape::Solid;
use crate::theme::Color;
use glam::Vec2;

/// Excess of the radius at the top over that at the middle, where the fingers are, as a share of it; the bottom is as
/// much narrower.
const TAPER: f32 = 0.07;
/// Half the thickness of the rolled rim and how far it stands out, in shares of the radius.
const RIM: f32 = 0.05;
/// Beginning and end of the sleeve, in shares of the half height; `SLEEVE_OUT`: its protrusion, in shares of the
/// radius.
const SLEEVE: [f32; 2] = [-0.62, 0.42];
const SLEEVE_OUT: f32 = 0.015;
/// The inside begins so far below the rim, in shares of the radius: the world does not say how full it is.
const INSIDE: f32 = 0.01;
/// White card, as paper cups are.
const CARD: Color = Color::rgb8(0xF1, 0xEC, 0xE0);

pub(super) fn draw(canvas: &mut Canvas<'_>, body: Body, broken: bool) {
    let (radius, top) = (body.half.x, body.half.y);
    wall(canvas, body, [-top, top], 0.0, CARD);
    wall(canvas, body, SLEEVE.map(|at| at * top), SLEEVE_OUT * radius, body.color);
    let rim = wide(body, top) + RIM * radius;
    disc(canvas, body, rim, [top - 2.0 * RIM * radius, top], CARD);
    let inside = CARD.mix(canvas.palette.frame, 0.55);
    disc(canvas, body, rim - 2.2 * RIM * radius, [top - 0.001, top + INSIDE * radius], inside);
    if broken {
        crack(canvas, body);
    }
}

/// Radius of the wall at a height of its own frame, m.
fn wide(body: Body, height: f32) -> f32 {
    body.half.x * (1.0 + TAPER * height / body.half.y)
}

/// The tapering wall between two heights, `out` m thicker.
fn wall(canvas: &mut Canvas<'_>, body: Body, heights: [f32; 2], out: f32, color: Color) {
    let [a, b] = heights.map(|height| body.to_world(Vec2::Y * height).extend(0.0));
    let cone = Solid::cone(a, b, heights.map(|height| wide(body, height) + out), color);
    canvas.solid(MeshKind::Cone, cone.gloss(0.1).of(Material::Paper).unlit(body.unlit));
}

fn disc(canvas: &mut Canvas<'_>, body: Body, radius: f32, [low, high]: [f32; 2], color: Color) {
    let center = body.to_world(Vec2::Y * 0.5 * (low + high)).extend(0.0);
    let drum = Solid::drum(center, Vec2::splat(radius), 0.5 * (high - low), body.turn, color);
    canvas.solid(MeshKind::Disc, drum.gloss(0.15).of(Material::Paper).unlit(body.unlit));
}
