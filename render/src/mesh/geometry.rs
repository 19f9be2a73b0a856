//! Vertices and triangles of a stretchable mesh.

use bytemuck::{Pod, Zeroable};

/// One vertex of a stretchable mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Vertex {
    /// Corner of the solid, components −1 to 1, times the instance's `half`.
    pub corner: [f32; 3],
    /// Place on the rounding, times the instance's `radius`.
    pub offset: [f32; 3],
    /// Unit normal.
    pub normal: [f32; 3],
    /// Direction in x–y in which a bevelled rim is drawn in, times the instance's `radius.z`.
    pub inset: [f32; 2],
}

/// Triangles, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertices.
    pub vertices: Vec<Vertex>,
    /// Three for each triangle.
    pub indices: Vec<u16>,
}

impl Mesh {
    pub(super) fn push(&mut self, corner: [f32; 3], offset: [f32; 3], normal: [f32; 3]) -> u16 {
        self.vertices.push(Vertex { corner, offset, normal, inset: [0.0; 2] });
        // The meshes have some hundred vertices each.
        (self.vertices.len() - 1) as u16
    }

    pub(super) fn quad(&mut self, a: u16, b: u16, c: u16, d: u16) {
        self.indices.extend([a, b, c, a, c, d]);
    }

    /// Joins two closed rings of `n` vertices that start at `low` and `high`.
    pub(super) fn join_rings(&mut self, low: u16, high: u16, n: u16) {
        for i in 0..n {
            let j = (i + 1) % n;
            self.quad(low + i, low + j, high + j, high + i);
        }
    }

    /// Closes a ring with a fan; `reversed` when its outside is on the far side.
    pub(super) fn cap(&mut self, first: u16, n: u16, reversed: bool) {
        for i in 1..n - 1 {
            let (b, c) = if reversed { (first + i + 1, first + i) } else { (first + i, first + i + 1) };
            self.indices.extend([first, b, c]);
        }
    }
}
