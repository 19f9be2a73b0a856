//! The outline of the disc that the tips can reach.

use super::canvas::{Canvas, Line};
use crate::coordinates::vec2;
use crate::scene::SceneView;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let workspace = &view.world.hand.workspace;
    let color = canvas.palette.workspace;
    let line = Line { width_px: 1.4, color, dash_m: 0.0036 };
    canvas.circle(vec2(workspace.center_m), workspace.radius_m as f32, 0.0, line, false);
}
