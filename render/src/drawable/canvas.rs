//! The canvas that drawables put their shapes on, and what several of them draw alike.

use crate::coordinates::{lift, vec2};
use crate::draw_data::{DrawData, Layer};
use crate::mesh::MeshKind;
use crate::scene::{FingerStyle, SceneView};
use crate::shape::{Solid, Stroke};
use crate::theme::{Color, ColorRole, Palette, Theme};
use glam::{Vec2, Vec3};
use haptics::world::State;

/// Half the depth of blocks and handle along z, m.
pub(crate) const HALF_DEPTH_M: f32 = 0.010;

pub(super) const WHITE: Color = Color::rgb8(0xFF, 0xFF, 0xFF);

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    Real,
    Ghost,
}

/// Canvas to which drawables add their shapes; a ghost canvas makes everything translucent and leaves the table alone.
pub(crate) struct Canvas<'a> {
    pub(super) data: &'a mut DrawData,
    pub(super) mode: Mode,
    pub(super) theme: Theme,
    pub(super) palette: Palette,
    pub(super) table_top_m: Option<f32>,
}

impl<'a> Canvas<'a> {
    pub(super) fn new(data: &'a mut DrawData, view: &SceneView<'_>, mode: Mode) -> Self {
        let theme = view.options.theme;
        let table_top_m = view.world.floor.as_ref().map(|floor| floor.height_m as f32);
        Self { data, mode, theme, palette: theme.palette(), table_top_m }
    }

    pub(super) fn color(&self, role: ColorRole) -> Color {
        self.theme.color(role)
    }

    /// Colour of an object, brighter while it is being talked about, and how much of it then shines by itself.
    pub(super) fn body_color(&self, role: ColorRole, highlighted: bool) -> (Color, f32) {
        let color = self.color(role);
        if highlighted { (color.mix(WHITE, 0.35), 0.35) } else { (color, 0.0) }
    }

    pub(super) fn solid(&mut self, mesh: MeshKind, solid: Solid) {
        match self.mode {
            Mode::Real => self.data.solids.push((Layer::World, mesh, solid)),
            Mode::Ghost => {
                let ghost = self.palette.ghost.linear();
                let color = glam::Vec4::from(solid.color).lerp(ghost, 0.35);
                let solid = Solid { color: color.truncate().extend(0.45).into(), ..solid };
                self.data.solids.push((Layer::Ghost, mesh, solid.unlit(0.25)));
            }
        }
    }

    pub(super) fn solid_in(&mut self, layer: Layer, mesh: MeshKind, solid: Solid) {
        self.data.solids.push((layer, mesh, solid));
    }

    pub(super) fn stroke(&mut self, stroke: Stroke) {
        if self.mode == Mode::Real {
            self.data.strokes.push(stroke);
        }
    }

    pub(super) fn overlay_stroke(&mut self, stroke: Stroke) {
        self.data.overlay_strokes.push(stroke);
    }

    /// A circle in the plane `z`.
    pub(super) fn circle(&mut self, center: Vec2, radius: f32, z: f32, line: Line, overlay: bool) {
        // Small circles need fewer corners.
        let steps = if radius < 0.004 { 24 } else { 72 };
        let at = |i: usize| (center + radius * angle(i as f32 / steps as f32)).extend(z);
        let arc = radius * std::f32::consts::TAU / steps as f32;
        for i in 0..steps {
            let mut stroke = Stroke::line(at(i), at(i + 1), line.width_px, line.color);
            if line.dash_m > 0.0 {
                stroke = stroke.dashed(line.dash_m, i as f32 * arc);
            }
            if overlay { self.overlay_stroke(stroke) } else { self.stroke(stroke) }
        }
    }
}

/// The picture's extent that marks were sized for, m: the workspace of the hand.
const USUAL_EXTENT_M: f32 = 0.14;

/// Factor for marks that must be seen at any magnification.
pub(super) fn mark_scale(view: &SceneView<'_>) -> f32 {
    view.options.camera.extent_m.max_element() / USUAL_EXTENT_M
}

/// Factor for a tool and its force: in a room they would be a needle's point, and beside the hand they are as large as they are.
pub(super) fn thing_scale(view: &SceneView<'_>) -> f32 {
    match view.options.fingers {
        FingerStyle::Tool => (0.6 * mark_scale(view)).max(1.0),
        _ => 1.0,
    }
}

/// Look of a line.
#[derive(Clone, Copy)]
pub(super) struct Line {
    pub(super) width_px: f32,
    pub(super) color: Color,
    /// Period of the dashes, m; 0: none.
    pub(super) dash_m: f32,
}

impl Line {
    pub(super) fn solid(width_px: f32, color: Color) -> Self {
        Self { width_px, color, dash_m: 0.0 }
    }
}

/// Unit vector at a fraction of a turn.
pub(super) fn angle(turns: f32) -> Vec2 {
    Vec2::from_angle(turns * std::f32::consts::TAU)
}

/// The direction away from the other finger: −1 for finger 1 (index 0, left), 1 for finger 2.
pub(super) fn outwards(finger: usize) -> f32 {
    if finger == 0 { -1.0 } else { 1.0 }
}

/// Tip of a finger in the plane, if it can be drawn.
pub(super) fn tip(state: &State, finger: usize) -> Option<Vec2> {
    let tip = vec2(state.input.tip_in_world[finger]);
    tip.is_finite().then_some(tip)
}

pub(super) fn at(point: Vec2, z: f32) -> Vec3 {
    lift(point, z)
}
