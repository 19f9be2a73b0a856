//! The plain list of shapes that makes one picture: built without a graphics device, so it can be made on any thread.

use crate::mesh::MeshKind;
use crate::shape::{Solid, Stroke};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec4};

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
    pub(crate) clip_from_world: Mat4,
    pub(crate) eye: Vec4,
    pub(crate) viewport: Vec4,
    pub(crate) background_top: Vec4,
    pub(crate) background_bottom: Vec4,
    pub(crate) glow: Vec4,
    pub(crate) grid: Vec4,
    pub(crate) shadow: Vec4,
    pub(crate) table: Vec4,
    pub(crate) map_from_world: Mat4,
    pub(crate) map: Vec4,
    pub(crate) key: Vec4,
}

/// The part of them that light maps depend on: the box of the map, its measures, the table and where it stands.
pub(crate) type LightGlobals = (Mat4, Vec4, Vec4, f32);

impl Globals {
    pub(crate) fn of_light(&self) -> LightGlobals {
        (self.map_from_world, self.map, self.table, self.shadow.w)
    }
}

impl DrawData {
    /// Number of shapes: solids, strokes.
    pub fn counts(&self) -> [usize; 2] {
        [self.solids.len(), self.strokes.len() + self.overlay_strokes.len()]
    }
}
