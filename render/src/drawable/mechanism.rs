//! A mechanism with one degree of freedom: the line or the circle that its tool moves along, in space.

use super::canvas::{Canvas, angle};
use crate::scene::SceneView;
use crate::shape::Stroke;
use crate::theme::ColorRole;
use glam::Vec3;
use haptics::world::MechanismPath;

/// Half the length of a line drawn for a prismatic mechanism, m.
const HALF_LENGTH_M: f32 = 0.05;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let Some(path) = view.world.mechanism.as_ref().and_then(|m| m.path.as_ref()) else { return };
    let color = canvas.color(ColorRole::Neutral);
    match path {
        MechanismPath::Prismatic { origin_m, direction } => {
            let (origin, along) = (vec3(origin_m), HALF_LENGTH_M * vec3(direction));
            canvas.overlay_stroke(Stroke::line(origin - along, origin + along, 2.0, color).dashed(0.004, 0.0));
        }
        MechanismPath::Revolute { center_m, axis, radius_m, zero } => {
            let (center, first) = (vec3(center_m), *radius_m as f32 * vec3(zero));
            let second = vec3(axis).cross(first);
            let steps = 72;
            let on_circle = |i: usize| {
                let turn = angle(i as f32 / steps as f32);
                center + turn.x * first + turn.y * second
            };
            for i in 0..steps {
                canvas.overlay_stroke(Stroke::line(on_circle(i), on_circle(i + 1), 2.0, color));
            }
            canvas.overlay_stroke(Stroke::line(center, center + first, 1.4, color));
        }
    }
}

fn vec3(v: &[f64; 3]) -> Vec3 {
    Vec3::from(v.map(|x| x as f32))
}
