//! One drawable thing a file. Each looks at the scene and adds its shapes to a [`Canvas`].

mod arrow;
mod barrel;
mod block;
mod cable;
mod contact;
mod crank;
mod cup;
mod force_field;
mod guide;
mod leak;
mod link;
mod marker;
mod mechanism;
mod membrane;
mod needle;
mod pad;
mod plane;
mod switch;
pub(crate) mod table;
mod tool;
mod trajectory;
mod workspace;

use crate::draw_data::{DrawData, Layer};
use crate::mesh::MeshKind;
use crate::scene::{FingerStyle, SceneView};
use crate::shape::{Solid, Stroke};
use crate::theme::{Color, ColorRole, Palette, Theme};
use glam::{Vec2, Vec3};
use haptics::world::State;

/// Half the depth of blocks and handle along z, m.
pub(crate) const HALF_DEPTH_M: f32 = 0.010;

const WHITE: Color = Color::rgb8(0xFF, 0xFF, 0xFF);

/// Lists all shapes of a scene.
pub(crate) fn draw_scene(data: &mut DrawData, view: &SceneView<'_>) {
    let mut canvas = Canvas::new(data, view, Mode::Real);
    table::draw(&mut canvas, view);
    plane::draw(&mut canvas, view);
    if view.options.show_workspace {
        workspace::draw(&mut canvas, view);
    }
    draw_state(&mut canvas, view);
    if view.options.show_contacts {
        contact::draw(&mut canvas, view);
    }
    mechanism::draw(&mut canvas, view);
    trajectory::draw(&mut canvas, view);
    force_field::draw(&mut canvas, view);
    marker::draw(&mut canvas, view);
    if view.options.show_forces && view.options.fingers != FingerStyle::Hidden {
        arrow::draw(&mut canvas, view);
    }
    if let Some(ghost) = &view.options.ghost {
        let mut canvas = Canvas::new(data, view, Mode::Ghost);
        draw_state(&mut canvas, &SceneView { state: ghost, ..*view });
    }
}

/// The moving things: objects and fingers.
fn draw_state(canvas: &mut Canvas<'_>, view: &SceneView<'_>) {
    block::draw(canvas, view);
    leak::draw(canvas, view);
    guide::draw(canvas, view);
    cable::draw(canvas, view);
    membrane::draw(canvas, view);
    switch::draw(canvas, view);
    crank::draw(canvas, view);
    match view.options.fingers {
        FingerStyle::Linkage => {
            link::draw(canvas, view);
            pad::draw(canvas, view);
        }
        FingerStyle::Tips => pad::draw(canvas, view),
        FingerStyle::Tool => tool::draw(canvas, view),
        FingerStyle::Hidden => {}
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Real,
    Ghost,
}

/// Canvas to which drawables add their shapes; a ghost canvas makes everything translucent and leaves the table alone.
pub(crate) struct Canvas<'a> {
    data: &'a mut DrawData,
    mode: Mode,
    theme: Theme,
    palette: Palette,
    table_top_m: Option<f32>,
}

impl<'a> Canvas<'a> {
    fn new(data: &'a mut DrawData, view: &SceneView<'_>, mode: Mode) -> Self {
        let theme = view.options.theme;
        let table_top_m = view.world.floor.as_ref().map(|floor| floor.height_m as f32);
        Self { data, mode, theme, palette: theme.palette(), table_top_m }
    }

    fn color(&self, role: ColorRole) -> Color {
        self.theme.color(role)
    }

    /// Colour of an object, brighter while it is being talked about, and how much of it then shines by itself.
    fn body_color(&self, role: ColorRole, highlighted: bool) -> (Color, f32) {
        let color = self.color(role);
        if highlighted { (color.mix(WHITE, 0.35), 0.35) } else { (color, 0.0) }
    }

    fn solid(&mut self, mesh: MeshKind, solid: Solid) {
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

    fn solid_in(&mut self, layer: Layer, mesh: MeshKind, solid: Solid) {
        self.data.solids.push((layer, mesh, solid));
    }

    fn stroke(&mut self, stroke: Stroke) {
        if self.mode == Mode::Real {
            self.data.strokes.push(stroke);
        }
    }

    fn overlay_stroke(&mut self, stroke: Stroke) {
        self.data.overlay_strokes.push(stroke);
    }

    /// A circle in the plane `z`.
    fn circle(&mut self, center: Vec2, radius: f32, z: f32, line: Line, overlay: bool) {
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
fn mark_scale(view: &SceneView<'_>) -> f32 {
    view.options.camera.extent_m.max_element() / USUAL_EXTENT_M
}

/// Factor for a tool and its force: in a room they would be a needle's point, and beside the hand they are as large as they are.
fn thing_scale(view: &SceneView<'_>) -> f32 {
    match view.options.fingers {
        FingerStyle::Tool => (0.6 * mark_scale(view)).max(1.0),
        _ => 1.0,
    }
}

/// Look of a line.
#[derive(Clone, Copy)]
struct Line {
    width_px: f32,
    color: Color,
    /// Period of the dashes, m; 0: none.
    dash_m: f32,
}

impl Line {
    fn solid(width_px: f32, color: Color) -> Self {
        Self { width_px, color, dash_m: 0.0 }
    }
}

/// Unit vector at a fraction of a turn.
fn angle(turns: f32) -> Vec2 {
    Vec2::from_angle(turns * std::f32::consts::TAU)
}

/// The direction away from the other finger: −1 for finger 1 (index 0, left), 1 for finger 2.
fn outwards(finger: usize) -> f32 {
    if finger == 0 { -1.0 } else { 1.0 }
}

/// Tip of a finger in the plane, if it can be drawn.
fn tip(state: &State, finger: usize) -> Option<Vec2> {
    let tip = crate::vec2(state.input.tip_in_world[finger]);
    tip.is_finite().then_some(tip)
}

fn at(point: Vec2, z: f32) -> Vec3 {
    crate::lift(point, z)
}
