//! Fingertips: a flat blade pointing down with 2 mm of foam in the finger's colour on its inner face.
//!
//! The tip position is the middle of the foam's inner face. Pressed foam is drawn as thin as it is compressed.

use super::canvas::{Canvas, outwards, tip};
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use crate::theme::ColorRole;
use glam::Vec3;
use haptics::world::{State, Surface};

/// Thickness of the foam at rest, m (thesis: 2 mm).
const FOAM_M: f32 = 0.002;
/// Thickness of the blade behind it, m.
const BLADE_M: f32 = 0.0022;
/// The foam below and above the tip position, m.
const FOAM_DOWN_UP_M: [f32; 2] = [0.005, 0.006];
/// Top of the blade above the tip position, m; below the wrist of `link.rs`.
const BLADE_TOP_M: f32 = 0.0192;
/// Half depth of the blade along z, m.
const HALF_DEPTH_M: f32 = 0.0065;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for finger in 0..2 {
        let Some(tip) = tip(view.state, finger) else { continue };
        let role = if view.options.saturated[finger] { ColorRole::Saturated } else { ColorRole::Finger(finger) };
        let color = canvas.color(role);
        let out = outwards(finger);
        // A tip low over the table must not be drawn into it.
        let lowest = canvas.table_top_m.filter(|top| tip.y > top - 0.001).map_or(f32::MIN, |top| top + 0.0002);
        let bottom = (tip.y - FOAM_DOWN_UP_M[0]).max(lowest);

        let pressed = compression(view.state, finger).clamp(0.0, FOAM_M - 0.0004);
        let (face, back) = (tip.x + out * pressed, tip.x + out * FOAM_M);
        let foam = slab([face, back], [bottom, tip.y + FOAM_DOWN_UP_M[1]], HALF_DEPTH_M);
        let bulge = 0.0006 + 0.3 * pressed;
        canvas
            .solid(MeshKind::Box, Solid::rounded_box(foam.0, foam.1, 0.0, bulge, color).gloss(0.05).of(Material::Foam));

        let blade = slab([back, back + out * BLADE_M], [bottom, tip.y + BLADE_TOP_M], HALF_DEPTH_M + 0.0005);
        let steel = canvas.palette.steel;
        canvas.solid(
            MeshKind::Box,
            Solid::rounded_box(blade.0, blade.1, 0.0, 0.0007, steel).gloss(0.6).of(Material::Brushed),
        );
    }
}

/// Centre and half extents of the box between two x and two y.
fn slab(x: [f32; 2], y: [f32; 2], half_z: f32) -> (Vec3, Vec3) {
    let center = Vec3::new(0.5 * (x[0] + x[1]), 0.5 * (y[0] + y[1]), 0.0);
    (center, Vec3::new(0.5 * (x[1] - x[0]).abs(), 0.5 * (y[1] - y[0]).abs(), half_z))
}

/// Compression of a finger's foam sideways, m.
fn compression(state: &State, finger: usize) -> f32 {
    let touches = |s: Surface| s == Surface::Finger(finger as u8);
    let contacts = state.contacts.iter().filter(|c| touches(c.by) || touches(c.on));
    contacts.map(|c| (c.depth_m * c.normal.x.abs()) as f32).fold(0.0, f32::max)
}
