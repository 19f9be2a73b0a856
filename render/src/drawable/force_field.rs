//! Force vectors along a path, flat and thin (thesis, figure 5.10).

use super::canvas::{Canvas, at, mark_scale};
use crate::coordinates::vec2;
use crate::scene::SceneView;
use crate::shape::Stroke;
use glam::Vec2;

const WIDTH_PX: f32 = 1.6;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for vector in &view.options.force_vectors {
        let color = canvas.color(vector.role);
        let tail = vec2(vector.at_m);
        let along = vec2(vector.force_n) * view.options.vector_scale_m_per_n;
        let head = tail + along;
        canvas.overlay_stroke(Stroke::line(at(tail, 0.0), at(head, 0.0), WIDTH_PX, color));
        let barb = along.normalize_or_zero() * (0.3 * along.length()).min(0.0022 * mark_scale(view));
        for side in [0.42_f32, -0.42] {
            let end = head - Vec2::from_angle(side).rotate(barb);
            canvas.overlay_stroke(Stroke::line(at(head, 0.0), at(end, 0.0), WIDTH_PX, color));
        }
    }
}
