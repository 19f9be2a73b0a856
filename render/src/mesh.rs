//! Stretchable unit meshes: every solid of the scene is one of a few, drawn many times.
//!
//! A vertex has a `corner` (the end or corner of the solid it belongs to, components −1, 0 or 1) and an `offset` (its
//! place on the rounding around that corner). An instance stretches both apart: `position = corner · half + offset ·
//! radius`, with the rims of plates drawn in by `inset · radius.z`. A bevel therefore keeps its radius whatever the
//! size, and a bar keeps round ends whatever its length.

mod geometry;
mod round;

pub use geometry::{Mesh, Vertex};
pub use round::{SHEET_STATIONS, dent};

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, TAU};

/// The unit meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MeshKind {
    /// Box with rounded edges; a sphere when its `half` is zero.
    Box,
    /// Plate in x–y with round corners and bevelled rims; a bar, a disc, a cylinder along z.
    Plate,
    /// The same with a finer outline, for large discs.
    Disc,
    /// Arrow along +x, its tip at `half.x`.
    Arrow,
    /// Box with finely rounded edges, for large balls.
    Ball,
    /// Slender shaft about x with a radius at each end.
    Cone,
    /// Back half of a cup's wall, about y.
    Shell,
    /// Back half of a level round sheet with a dent.
    Sheet,
}

impl MeshKind {
    /// All of them, in the order of their buffers.
    pub const ALL: [Self; 8] =
        [Self::Box, Self::Plate, Self::Disc, Self::Arrow, Self::Ball, Self::Cone, Self::Shell, Self::Sheet];

    /// Makes the mesh.
    pub fn build(self) -> Mesh {
        match self {
            Self::Box => rounded_box(2),
            Self::Plate => plate(5),
            Self::Disc => plate(12),
            Self::Arrow => arrow(20),
            Self::Ball => rounded_box(5),
            Self::Cone => round::cone(16),
            Self::Shell => round::shell(24),
            Self::Sheet => round::sheet(24),
        }
    }
}

/// Length of an arrow's head and largest radius, in shaft radii.
pub const ARROW_HEAD: [f32; 2] = [6.5, 2.6];

/// A cube whose edges and corners are rounded: six faces of a grid, `steps` segments for each eighth of a turn.
fn rounded_box(steps: u16) -> Mesh {
    let mut mesh = Mesh::default();
    let side = 2 * (steps + 1);
    // Each half of a grid line belongs to one corner; between them lies the flat part.
    let stations: Vec<(f32, f32)> = (0..side)
        .map(|i| {
            let (sign, step) =
                if i <= steps { (-1.0, f32::from(i) - f32::from(steps)) } else { (1.0, f32::from(i - steps - 1)) };
            (sign, (step / f32::from(steps) * FRAC_PI_4).tan())
        })
        .collect();
    for axis in 0..3 {
        for sign in [-1.0, 1.0_f32] {
            let first = mesh.vertices.len() as u16;
            for &(corner_v, v) in &stations {
                for &(corner_u, u) in &stations {
                    // u, v, axis form a right-handed frame when `sign` is positive.
                    let mut corner = [0.0; 3];
                    let mut direction = [0.0; 3];
                    (corner[(axis + 1) % 3], direction[(axis + 1) % 3]) = (corner_u, u);
                    (corner[(axis + 2) % 3], direction[(axis + 2) % 3]) = (corner_v, v);
                    (corner[axis], direction[axis]) = (sign, sign);
                    let normal = glam::Vec3::from(direction).normalize().to_array();
                    mesh.push(corner, normal, normal);
                }
            }
            for row in 0..side - 1 {
                for column in 0..side - 1 {
                    let a = first + row * side + column;
                    if sign > 0.0 {
                        mesh.quad(a, a + 1, a + side + 1, a + side);
                    } else {
                        mesh.quad(a, a + side, a + side + 1, a + 1);
                    }
                }
            }
        }
    }
    mesh
}

/// A stadium-like plate: `steps` segments for each quarter turn, walls along z, a bevel at the front rim; the back is
/// never seen.
fn plate(steps: u16) -> Mesh {
    let mut mesh = Mesh::default();
    let outline: Vec<([f32; 2], [f32; 2])> = (0..4_u16)
        .flat_map(|quarter| {
            let corner = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]][quarter as usize];
            (0..=steps).map(move |i| {
                let angle = FRAC_PI_2 * (f32::from(quarter) + f32::from(i) / f32::from(steps));
                (corner, [angle.cos(), angle.sin()])
            })
        })
        .collect();
    let n = outline.len() as u16;
    // (z corner, bevelled, z offset, normal z) from the back face to the front face.
    let slope = std::f32::consts::FRAC_1_SQRT_2;
    let rings = [
        (-1.0, 0.0, -1.0, -1.0),
        (-1.0, 0.0, -1.0, 0.0),
        (1.0, 0.0, 0.0, 0.0),
        (1.0, 0.0, 0.0, slope),
        (1.0, 1.0, 1.0, slope),
        (1.0, 1.0, 1.0, 1.0),
    ];
    for (z_corner, bevelled, z_offset, normal_z) in rings {
        let flat = f32::sqrt(1.0 - normal_z * normal_z);
        for (corner, [cos, sin]) in &outline {
            mesh.vertices.push(Vertex {
                corner: [corner[0], corner[1], z_corner],
                offset: [*cos, *sin, z_offset],
                normal: [cos * flat, sin * flat, normal_z],
                inset: [-cos * bevelled, -sin * bevelled],
            });
        }
    }
    mesh.cap(0, n, true);
    for pair in [1, 3] {
        mesh.join_rings(pair * n, (pair + 1) * n, n);
    }
    mesh.cap(5 * n, n, false);
    mesh
}

/// A shaft and a cone about +x; the shaft has radius 1, the whole length is the instance's `half.x`.
fn arrow(n: u16) -> Mesh {
    let mut mesh = Mesh::default();
    let [head, wide] = ARROW_HEAD;
    let slant = wide / head.hypot(wide);
    let rise = head / head.hypot(wide);
    // (x corner, x offset, radius, normal x, radial part of the normal)
    let rings = [
        (0.0, 0.0, 1.0, -1.0, 0.0),
        (0.0, 0.0, 1.0, 0.0, 1.0),
        (1.0, -head, 1.0, 0.0, 1.0),
        (1.0, -head, 1.0, -1.0, 0.0),
        (1.0, -head, wide, -1.0, 0.0),
        (1.0, -head, wide, slant, rise),
        (1.0, 0.0, 0.0, slant, rise),
    ];
    for (corner, along, radius, normal_x, radial) in rings {
        for i in 0..n {
            let (sin, cos) = (TAU * f32::from(i) / f32::from(n)).sin_cos();
            mesh.push([corner, 0.0, 0.0], [along, cos * radius, sin * radius], [normal_x, cos * radial, sin * radial]);
        }
    }
    mesh.cap(0, n, true);
    for (low, high) in [(1, 2), (3, 4), (5, 6)] {
        mesh.join_rings(low * n, high * n, n);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Signed volume of the stretched mesh: positive and right only when it is closed and wound outwards.
    fn volume(mesh: &Mesh, half: Vec3, radius: Vec3) -> f32 {
        let at = |index: u16| {
            let v = &mesh.vertices[usize::from(index)];
            Vec3::from(v.corner) * half
                + Vec3::from(v.offset) * radius
                + glam::Vec2::from(v.inset).extend(0.0) * radius.z
        };
        mesh.indices.chunks_exact(3).map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum()
    }

    #[test]
    fn box_is_closed_and_wound_outwards() {
        let v = volume(&rounded_box(6), Vec3::new(1.0, 2.0, 3.0), Vec3::splat(1e-4));
        assert!((v - 48.0).abs() < 0.05, "{v}");
    }

    #[test]
    fn ball_has_nearly_the_volume_of_a_ball() {
        let v = volume(&rounded_box(6), Vec3::ZERO, Vec3::ONE);
        assert!((v - 4.19).abs() < 0.2, "{v}");
    }

    #[test]
    fn disc_has_the_volume_of_a_cylinder() {
        let v = volume(&plate(15), Vec3::new(0.0, 0.0, 0.49), Vec3::new(1.0, 1.0, 0.01));
        assert!((v - std::f32::consts::PI).abs() < 0.05, "{v}");
    }

    #[test]
    fn arrow_is_wound_outwards() {
        let v = volume(&arrow(20), Vec3::X * 20.0, Vec3::ONE);
        let expected = std::f32::consts::PI * (13.5 + 2.6 * 2.6 * 6.5 / 3.0);
        assert!((v - expected).abs() < 0.04 * expected, "{v} instead of {expected}");
    }

    #[test]
    fn normals_are_unit() {
        // A sheet's normals get their length from the depth of its dent.
        for kind in MeshKind::ALL.into_iter().filter(|kind| *kind != MeshKind::Sheet) {
            for vertex in kind.build().vertices {
                assert!((Vec3::from(vertex.normal).length() - 1.0).abs() < 1e-4, "{kind:?}");
            }
        }
    }
}
