//! A single tool instead of two fingers: a slim probe whose ball end is at the tip of finger 1.

use super::canvas::{Canvas, at, thing_scale, tip};
use crate::material::Material;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use crate::theme::ColorRole;
use glam::{Vec2, Vec3};

/// Radius of the ball end, m.
const BALL_M: f32 = 0.0024;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let Some(tip) = tip(view.state, 0) else { return };
    let scale = thing_scale(view);
    let role = if view.options.saturated[0] { ColorRole::Saturated } else { ColorRole::Finger(0) };
    let (accent, steel, frame) = (canvas.color(role), canvas.palette.steel, canvas.palette.frame);
    canvas.solid(MeshKind::Box, Solid::ball(at(tip, 0.0), scale * BALL_M, accent).gloss(0.5));
    let mut rod = |[from, to]: [f32; 2], radius: f32, color, material| {
        let [from, to, radius] = [from, to, radius].map(|length| scale * length);
        let half = Vec3::new(radius, 0.5 * (to - from), radius);
        let center = at(tip + Vec2::Y * 0.5 * (from + to), 0.0);
        canvas.solid(MeshKind::Box, Solid::rounded_box(center, half, 0.0, radius, color).gloss(0.6).of(material));
    };
    rod([0.001, 0.034], 0.0011, steel, Material::Polished);
    rod([0.030, 0.037], 0.0026, accent, Material::Plain);
    rod([0.034, 0.075], 0.0042, frame, Material::Rubber);
}
