//! Contacts of bodies: a ring around a point in front of everything, in the warning colour while they slide.

use super::canvas::{Canvas, Line, at};
use crate::coordinates::vec2;
use crate::draw_data::Layer;
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::Solid;
use crate::theme::ColorRole;

/// Radius of the point and, for a contact without force, of the ring, m.
const POINT_M: f32 = 0.0006;
const RING_M: f32 = 0.0011;
/// The ring grows by this with each newton, up to [`LARGEST_M`].
const RING_M_PER_N: f32 = 0.00035;
const LARGEST_M: f32 = 0.0024;

pub(super) fn draw(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    for contact in &view.state.contacts {
        let role = if contact.sliding { ColorRole::Saturated } else { ColorRole::Measured };
        let (color, place) = (canvas.color(role), vec2(contact.point_m));
        canvas.solid_in(Layer::Overlay, MeshKind::Box, Solid::ball(at(place, 0.0), POINT_M, color).unlit(0.8));
        let grown = RING_M + RING_M_PER_N * contact.normal_force_n.max(0.0) as f32;
        let line = Line::solid(1.3, color.with_alpha(0.75));
        canvas.circle(place, grown.min(LARGEST_M), 0.0, line, true);
    }
}
