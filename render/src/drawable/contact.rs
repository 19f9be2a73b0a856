//! Small marks where bodies touch.

use super::{Canvas, at};
use crate::draw_data::Layer;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use crate::theme::ColorRole;
use crate::vec2;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for contact in &view.state.contacts {
        let role = if contact.sliding { ColorRole::Saturated } else { ColorRole::Measured };
        let color = canvas.color(role);
        let ball = Solid::ball(at(vec2(contact.point_m), 0.0), 0.0008, color).unlit(0.6);
        canvas.solid_in(Layer::Overlay, MeshKind::Box, ball);
    }
}
