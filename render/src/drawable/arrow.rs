//! Force arrows: the force that each fingertip exerts on the environment, in front of everything.

use super::{Canvas, outwards, tip};
use crate::draw_data::Layer;
use crate::mesh::MeshKind;
use crate::scene::{ArrowAnchor, FingerStyle, SceneView};
use crate::shape::Solid;
use crate::theme::ColorRole;
use crate::vec2;
use glam::Vec2;

/// Forces below this have no direction worth showing, N.
const SMALLEST_N: f32 = 0.02;
const SHAFT_RADIUS_M: f32 = 0.00115;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    let fingers = if view.options.fingers == FingerStyle::Tool { 1 } else { 2 };
    for finger in 0..fingers {
        let Some(tip) = tip(view.state, finger) else { continue };
        let force = vec2(view.state.tip_force_n[finger]);
        if !force.is_finite() || force.length() < SMALLEST_N {
            continue;
        }
        let saturated = view.options.saturated[finger];
        let color = canvas.color(if saturated { ColorRole::Saturated } else { ColorRole::Finger(finger) });
        let arrow = force * view.options.force_scale_m_per_n;
        let (tail, head) = match view.options.arrow_anchor {
            // Just off the foam, so that the head does not hide what it pushes on.
            ArrowAnchor::HeadAtTip => (tip - arrow, tip),
            ArrowAnchor::TailAtTip => (tip, tip + arrow),
        };
        let shift = Vec2::new(outwards(finger) * 0.0002, 0.0);
        let solid = Solid::arrow(tail + shift, head + shift, 0.0, SHAFT_RADIUS_M, color).gloss(0.15).unlit(0.35);
        canvas.solid_in(Layer::Overlay, MeshKind::Arrow, solid);
    }
}
