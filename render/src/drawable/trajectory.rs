//! Curves in the plane: measured, simulated, planned.

use super::canvas::{Canvas, at};
use crate::coordinates::vec2;
use crate::scene::SceneView;
use crate::shape::Stroke;

/// Points closer than this to the last one drawn are left out, m: far below a pixel.
const STEP_M: f32 = 0.0002;
/// Period of dashes, m.
const DASH_M: f32 = 0.003;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for trajectory in &view.options.trajectories {
        let color = canvas.color(trajectory.role);
        let mut last = None;
        let mut path_m = 0.0;
        for point in &trajectory.points_m {
            let point = vec2(*point);
            if !point.is_finite() {
                last = None;
                continue;
            }
            let Some(from) = last else {
                last = Some(point);
                continue;
            };
            let length = point.distance(from);
            if length < STEP_M {
                continue;
            }
            let mut stroke = Stroke::line(at(from, 0.0), at(point, 0.0), trajectory.width_px, color);
            if trajectory.dashed {
                stroke = stroke.dashed(DASH_M, path_m);
            }
            canvas.overlay_stroke(stroke);
            path_m += length;
            last = Some(point);
        }
    }
}
