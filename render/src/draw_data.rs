//! The plain list of shapes that makes one picture: built without a graphics device, so it can be made on any thread.

use crate::drawable;
use crate::light::{KEY, KeyLight};
use crate::mesh::MeshKind;
use crate::scene::SceneView;
use crate::shape::{Solid, Stroke};
use crate::theme::Theme;
use crate::{Camera, vec2};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec4};

/// Order of drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// Solids of the world.
    World,
    /// The table, with its grid.
    Table,
    /// Translucent solids among the others: the ghost.
    Ghost,
    /// Translucent solids in front of everything: the uncertainty of a centre.
    Glass,
    /// Solids in front of everything: force arrows.
    Overlay,
}

impl Layer {
    /// The table only receives them; translucent and overlaid shapes cast none.
    pub(crate) fn casts_shadows(self) -> bool {
        self == Self::World
    }
}

/// Everything that one picture needs.
#[derive(Clone, Debug)]
pub struct DrawData {
    pub(crate) globals: Globals,
    /// Size of the picture, pixels.
    pub(crate) size: [u32; 2],
    /// Solids with their layer and mesh; sorted so that equal ones are drawn together.
    pub(crate) solids: Vec<(Layer, MeshKind, Solid)>,
    /// Lines that solids can hide.
    pub(crate) strokes: Vec<Stroke>,
    /// Lines in front of everything.
    pub(crate) overlay_strokes: Vec<Stroke>,
}

/// The uniform buffer; see `common.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct Globals {
    clip_from_world: Mat4,
    eye: Vec4,
    viewport: Vec4,
    background_top: Vec4,
    background_bottom: Vec4,
    glow: Vec4,
    grid: Vec4,
    shadow: Vec4,
    table: Vec4,
    map_from_world: Mat4,
    map: Vec4,
    key: Vec4,
}

/// The part of them that light maps depend on: the box of the map, its measures, the table and where it stands.
pub(crate) type LightGlobals = (Mat4, Vec4, Vec4, f32);

impl Globals {
    pub(crate) fn of_light(&self) -> LightGlobals {
        (self.map_from_world, self.map, self.table, self.shadow.w)
    }
}

impl DrawData {
    /// Lists the shapes of `view` in a picture of `size` pixels.
    pub fn new(view: &SceneView<'_>, size: [u32; 2]) -> Self {
        let mut data = Self {
            globals: globals(view, size),
            size,
            solids: Vec::with_capacity(128),
            strokes: Vec::with_capacity(256),
            overlay_strokes: Vec::with_capacity(1024),
        };
        drawable::draw_scene(&mut data, view);
        data.solids.retain(|(_, _, solid)| solid.is_finite());
        data.strokes.retain(Stroke::is_finite);
        data.overlay_strokes.retain(Stroke::is_finite);
        data.solids.sort_by_key(|(layer, mesh, _)| (*layer, *mesh));
        data.set_light();
        data
    }

    /// Fits the key light's map around the shapes that cast shadows.
    fn set_light(&mut self) {
        let casters = self.solids.iter().filter(|(layer, _, _)| layer.casts_shadows());
        let light = KeyLight::around(casters.map(|(_, _, solid)| solid));
        (self.globals.map_from_world, self.globals.map) = (light.map_from_world, light.measures);
    }

    /// Number of shapes: solids, strokes.
    pub fn counts(&self) -> [usize; 2] {
        [self.solids.len(), self.strokes.len() + self.overlay_strokes.len()]
    }
}

fn globals(view: &SceneView<'_>, size: [u32; 2]) -> Globals {
    let camera = &view.options.camera;
    let palette = view.options.theme.palette();
    let [width, height] = size.map(|n| n.max(1) as f32);
    let hand = vec2(view.world.hand.workspace.center_m).extend(0.0);
    let glow_height = 1.0 - 2.0 * camera.pixel(hand, size).y / height;
    let table = drawable::table::extent(view.world);
    Globals {
        clip_from_world: camera.clip_from_world(size),
        eye: eye(camera, size),
        viewport: Vec4::new(width, height, 1.0 / width, 1.0 / height),
        background_top: palette.background_top.display(),
        background_bottom: palette.background_bottom.display(),
        glow: palette.glow.rgb.extend(glow_height.clamp(-1.0, 1.0)),
        grid: palette.grid.rgb.extend(grid_strength(view.options.theme)),
        shadow: palette.shadow.rgb.extend(table.center_z),
        table: table.top.map_or(Vec4::new(-1e3, 0.0, 1.0, 1.0), |top| {
            let Vec2 { x, y } = table.half;
            Vec4::new(top, 0.45, x, y)
        }),
        map_from_world: Mat4::IDENTITY,
        map: Vec4::ZERO,
        key: KEY.extend(palette.shadow.alpha),
    }
}

fn eye(camera: &Camera, size: [u32; 2]) -> Vec4 {
    match camera.projection {
        crate::Projection::Perspective => camera.eye_m(size).extend(1.0),
        crate::Projection::Orthographic => camera.backwards().extend(0.0),
    }
}

fn grid_strength(theme: Theme) -> f32 {
    match theme {
        Theme::Light => 0.55,
        Theme::Dark => 0.45,
    }
}
