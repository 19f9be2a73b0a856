//! Force arrows: the force that each fingertip exerts on the environment, in front of everything; the slender ones
//! beside them are the forces of a model.

use super::canvas::{Canvas, outwards, thing_scale, tip};
use crate::coordinates::vec2;
use crate::draw_data::Layer;
use crate::mesh::MeshKind;
use crate::scene::{ArrowAnchor, FingerStyle, SceneView};
use crate::shape::Solid;
use crate::theme::{Color, ColorRole};
use glam::Vec2;

/// Forces below this have no direction worth showing, N.
const SMALLEST_N: f32 = 0.02;
const SHAFT_RADIUS_M: f32 = 0.00115;
const SLENDER_M: f32 = 0.0006;
/// Distance in front of the measured arrow, m: a predicted one is seen even if both are the same.
const IN_FRONT_M: f32 = 0.004;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let fingers = if view.options.fingers == FingerStyle::Tool { 1 } else { 2 };
    for finger in 0..fingers {
        let Some(tip) = tip(view.state, finger) else { continue };
        if let Some(predicted) = view.options.predicted_force_n {
            let color = canvas.color(ColorRole::Simulated);
            draw_arrow(canvas, view, (finger, tip), vec2(predicted[finger]), (SLENDER_M, IN_FRONT_M), color);
        }
        let saturated = view.options.saturated[finger];
        let color = canvas.color(if saturated { ColorRole::Saturated } else { ColorRole::Finger(finger) });
        draw_arrow(canvas, view, (finger, tip), vec2(view.state.tip_force_n[finger]), (SHAFT_RADIUS_M, 0.0), color);
    }
}

fn draw_arrow(
    canvas: &mut Canvas<'_>,
    view: &SceneView<'_>,
    (finger, tip): (usize, Vec2),
    force: Vec2,
    (shaft_m, z): (f32, f32),
    color: Color,
) {
    if !force.is_finite() || force.length() < SMALLEST_N {
        return;
    }
    let arrow = force * view.options.force_scale_m_per_n;
    let (tail, head) = match view.options.arrow_anchor {
        // Just off the foam, so that the head does not hide the pushed object.
        ArrowAnchor::HeadAtTip => (tip - arrow, tip),
        ArrowAnchor::TailAtTip => (tip, tip + arrow),
    };
    let shift = Vec2::new(outwards(finger) * 0.0002, 0.0);
    let shaft_m = shaft_m * thing_scale(view);
    let solid = Solid::arrow(tail + shift, head + shift, z, shaft_m, color).gloss(0.15).unlit(0.35);
    canvas.solid_in(Layer::Overlay, MeshKind::Arrow, solid);
}
