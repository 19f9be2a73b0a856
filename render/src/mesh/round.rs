//! Round meshes with two radii or a dent: shafts, half a cup, half a sheet.

use super::geometry::{Mesh, Vertex};
use std::f32::consts::{PI, TAU};

/// Places between the apex (0) and the rim (1) of a sheet at which its mesh has a ring; closer where it bends most.
pub const SHEET_STATIONS: [f32; 10] = [0.0, 0.05, 0.12, 0.2, 0.3, 0.42, 0.55, 0.7, 0.85, 1.0];

/// Depth of a dent of depth 1 at a share of the way from its deepest place (0) to the rim (1), where it ends level.
pub fn dent(share: f32) -> f32 {
    let left = (1.0 - share).clamp(0.0, 1.0);
    left * left
}

/// Slope of [`dent`].
fn dent_slope(share: f32) -> f32 {
    -2.0 * (1.0 - share)
}

impl Mesh {
    fn corner_only(&mut self, corner: [f32; 3], normal: [f32; 3]) {
        self.push(corner, [0.0; 3], normal);
    }

    /// Joins two open strips of `n` vertices.
    fn join_strips(&mut self, low: u16, high: u16, n: u16, reversed: bool) {
        for i in 0..n - 1 {
            if reversed {
                self.quad(low + i, high + i, high + i + 1, low + i + 1);
            } else {
                self.quad(low + i, low + i + 1, high + i + 1, high + i);
            }
        }
    }
}

/// A shaft about x from radius `half.y` at −`half.x` to radius `radius.y` at `half.x`: a tube, a needle, its point. Its normals
/// are those of a tube, so it should be slender.
pub(super) fn cone(n: u16) -> Mesh {
    let mut mesh = Mesh::default();
    // (at the far end, normal along x)
    for (far, normal_x) in [(false, -1.0), (false, 0.0), (true, 0.0), (true, 1.0)] {
        for i in 0..n {
            let (sin, cos) = (TAU * f32::from(i) / f32::from(n)).sin_cos();
            let flat: f32 = 1.0 - f32::abs(normal_x);
            let normal = [normal_x, cos * flat, sin * flat];
            if far {
                mesh.push([1.0, 0.0, 0.0], [0.0, cos, sin], normal);
            } else {
                mesh.corner_only([-1.0, cos, sin], normal);
            }
        }
    }
    mesh.cap(0, n, true);
    mesh.join_rings(n, 2 * n, n);
    mesh.cap(3 * n, n, false);
    mesh
}

/// The back half (z ≤ 0) of a thin wall about y, from radius `radius.x` at −`half.y` to radius `half.x` at `half.y`, seen from
/// inside and from outside.
pub(super) fn shell(n: u16) -> Mesh {
    let mut mesh = Mesh::default();
    for inwards in [true, false] {
        let first = mesh.vertices.len() as u16;
        let sign = if inwards { -1.0 } else { 1.0 };
        for top in [false, true] {
            for i in 0..=n {
                let (sin, cos) = (PI + PI * f32::from(i) / f32::from(n)).sin_cos();
                let normal = [sign * cos, 0.0, sign * sin];
                if top {
                    mesh.corner_only([cos, 1.0, sin], normal);
                } else {
                    mesh.push([0.0, -1.0, 0.0], [cos, 0.0, sin], normal);
                }
            }
        }
        mesh.join_strips(first, first + n + 1, n + 1, !inwards);
    }
    mesh
}

/// The back half (z ≤ 0) of a level round sheet of radius 1, dented by `radius.y` at an apex that is `radius.x` beside its
/// middle, seen from above and from below.
///
/// Its normals are those of a dent as deep as the radius, not of unit length: [`crate::shape::Solid::sheet`] stretches
/// the instance so that they are right for every depth.
pub(super) fn sheet(n: u16) -> Mesh {
    let mut mesh = Mesh::default();
    for above in [true, false] {
        let first = mesh.vertices.len() as u16;
        let sign = if above { 1.0 } else { -1.0 };
        for share in SHEET_STATIONS {
            for i in 0..=n {
                let (sin, cos) = (PI + PI * f32::from(i) / f32::from(n)).sin_cos();
                let slope = dent_slope(share);
                mesh.vertices.push(Vertex {
                    corner: [share * cos, 0.0, share * sin],
                    offset: [1.0 - share, -dent(share), 0.0],
                    normal: [sign * slope * cos, sign, sign * slope * sin],
                    inset: [0.0; 2],
                });
            }
        }
        for ring in 0..SHEET_STATIONS.len() as u16 - 1 {
            let low = first + ring * (n + 1);
            mesh.join_strips(low, low + n + 1, n + 1, !above);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// Every triangle of a stretched mesh: its middle and its outward face normal (unit), with the stored normal there.
    fn faces(mesh: &Mesh, half: Vec3, radius: Vec3) -> Vec<(Vec3, Vec3)> {
        let at = |v: &Vertex| Vec3::from(v.corner) * half + Vec3::from(v.offset) * radius;
        let faces = mesh.indices.chunks_exact(3).map(|t| {
            let v = [0, 1, 2].map(|i| &mesh.vertices[usize::from(t[i])]);
            let across = (at(v[1]) - at(v[0])).cross(at(v[2]) - at(v[0]));
            let stored: Vec3 = v.iter().map(|v| Vec3::from(v.normal)).sum();
            (across, stored)
        });
        // The triangles at an apex have no area.
        faces.filter(|(across, _)| across.length() > 1e-7).collect()
    }

    #[test]
    fn cone_has_the_volume_of_a_frustum() {
        let mesh = cone(48);
        let at = |i: u16| {
            let v = &mesh.vertices[usize::from(i)];
            Vec3::from(v.corner) * Vec3::new(2.0, 1.5, 1.5) + Vec3::from(v.offset) * Vec3::new(0.0, 0.5, 0.5)
        };
        let volume: f32 = mesh.indices.chunks_exact(3).map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0).sum();
        let expected = PI * 4.0 / 3.0 * (1.5 * 1.5 + 1.5 * 0.5 + 0.5 * 0.5);
        assert!((volume / expected - 1.0).abs() < 0.01, "{volume} instead of {expected}");
    }

    #[test]
    fn open_meshes_are_wound_towards_their_normals() {
        let stretched = [
            (shell(12), Vec3::new(1.0, 0.5, 1.0), Vec3::new(1.2, 0.0, 1.2)),
            (sheet(12), Vec3::ONE, Vec3::new(0.3, 0.2, 0.0)),
        ];
        for (mesh, half, radius) in stretched {
            let faces = faces(&mesh, half, radius);
            assert!(faces.len() > 40);
            for (across, stored) in faces {
                assert!(across.dot(stored) > 0.0, "{across} against {stored}");
            }
        }
    }

    #[test]
    fn a_dent_is_deepest_at_its_apex_and_level_at_the_rim() {
        assert!((dent(0.0) - 1.0).abs() < 1e-6 && dent(1.0).abs() < 1e-6 && dent_slope(1.0).abs() < 1e-6);
        let numeric = (dent(0.41) - dent(0.39)) / 0.02;
        assert!((numeric - dent_slope(0.4)).abs() < 1e-3);
    }
}
