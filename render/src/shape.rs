//! The three kinds of things a picture is made of, as the graphics driver takes them: solids, strokes and shadows.

use crate::material::Material;
use crate::theme::Color;
use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

/// One stretched mesh. Built by the constructors below; lengths in m.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Solid {
    /// Rows of the rotation and translation, world from solid.
    pub rows: [[f32; 4]; 3],
    /// Half extents between the roundings, and gloss (0 matt, 1 polished).
    pub half_and_gloss: [f32; 4],
    /// Radii of the rounding, and how much of the colour shines by itself (0 lit, 1 flat).
    pub radius_and_unlit: [f32; 4],
    /// Colour (gamma 2 undone) and opacity.
    pub color: [f32; 4],
    /// Material, as the shader numbers it.
    pub material: u32,
}

impl Solid {
    /// A box with rounded edges about `center`, turned by `angle_rad` in the plane. `half` includes the rounding.
    pub fn rounded_box(center: Vec3, half: Vec3, angle_rad: f32, edge: f32, color: Color) -> Self {
        let edge = edge.min(half.min_element());
        Self::new(center, Vec2::from_angle(angle_rad), half - Vec3::splat(edge), Vec3::splat(edge), color)
    }

    /// A bar with round ends from `a` to `b`, `z` from back to front.
    pub fn bar(a: Vec2, b: Vec2, radius: f32, z: [f32; 2], color: Color) -> Self {
        let along = b - a;
        let half = Vec3::new(0.5 * along.length(), 0.0, 0.5 * (z[1] - z[0]));
        Self::plate_with(0.5 * (a + b), along.normalize_or(Vec2::X), half, radius, z, color)
    }

    /// A disc, `z` from back to front.
    pub fn disc(center: Vec2, radius: f32, z: [f32; 2], color: Color) -> Self {
        Self::bar(center, center, radius, z, color)
    }

    /// A flat ellipse with the half axes `axes`, at right angles to each other, `z` from back to front (mesh: plate or disc).
    pub fn ellipse(center: Vec2, axes: [Vec2; 2], z: [f32; 2], color: Color) -> Self {
        let frame = [axes[0].extend(0.0), axes[0].perp().normalize_or_zero().extend(0.0) * axes[1].length(), Vec3::Z];
        let half = Vec3::Z * 0.5 * (z[1] - z[0]);
        Self::with_axes(center.extend(0.5 * (z[0] + z[1])), frame, half, Vec3::new(1.0, 1.0, 0.0), color)
    }

    /// A plate with round corners; `half` includes them.
    pub fn plate(center: Vec2, half: Vec2, corner: f32, z: [f32; 2], color: Color) -> Self {
        let corner = corner.min(half.min_element());
        let inner = half - Vec2::splat(corner);
        Self::plate_with(center, Vec2::X, inner.extend(0.5 * (z[1] - z[0])), corner, z, color)
    }

    /// A ball.
    pub fn ball(center: Vec3, radius: f32, color: Color) -> Self {
        Self::new(center, Vec2::X, Vec3::ZERO, Vec3::splat(radius), color)
    }

    /// A stick with round ends between two points in space (mesh: box).
    pub fn capsule(a: Vec3, b: Vec3, radius: f32, color: Color) -> Self {
        let half = Vec3::X * 0.5 * a.distance(b);
        Self::with_axes(0.5 * (a + b), axes_along(b - a), half, Vec3::splat(radius), color)
    }

    /// A slender shaft from `a` to `b` with a radius at each end (mesh: cone).
    pub fn cone(a: Vec3, b: Vec3, radii: [f32; 2], color: Color) -> Self {
        let half = Vec3::new(0.5 * a.distance(b), radii[0], radii[0]);
        Self::with_axes(0.5 * (a + b), axes_along(b - a), half, Vec3::new(0.0, radii[1], radii[1]), color)
    }

    /// A cylinder about its height, standing upright when `angle_rad` is zero (mesh: plate or disc, turned up). `radii` are those
    /// across the plane and in depth. Its upper rim is bevelled.
    pub fn drum(center: Vec3, radii: Vec2, half_height: f32, angle_rad: f32, color: Color) -> Self {
        let across = Vec2::from_angle(angle_rad);
        let axes = [across.extend(0.0), Vec3::NEG_Z, across.perp().extend(0.0)];
        let bevel = (0.12 * radii.min_element()).min(0.0006).min(half_height);
        let half = Vec3::new(0.0, 0.0, half_height - bevel);
        Self::with_axes(center, axes, half, radii.extend(bevel), color)
    }

    /// The back half of a cup's wall: `radii` at the bottom and at the top, `y` from bottom to top (mesh: shell).
    pub fn shell(middle_x: f32, radii: [f32; 2], y: [f32; 2], color: Color) -> Self {
        let center = Vec3::new(middle_x, 0.5 * (y[0] + y[1]), 0.0);
        let half = Vec3::new(radii[1], 0.5 * (y[1] - y[0]), radii[1]);
        Self::new(center, Vec2::X, half, Vec3::new(radii[0], 0.0, radii[0]), color)
    }

    /// The back half of a round sheet about `center`, dented downwards by `depth` at `apex` beside its middle (mesh: sheet).
    pub fn sheet(center: Vec3, radius: f32, apex: f32, depth: f32, color: Color) -> Self {
        // The stored normals suit a dent as deep as the radius. Shrinking the frame to the true slope makes them right, for the
        // shader normalises them; half extents and apex grow by as much, so that the places stay.
        let slope = depth / radius;
        let slope = if slope.abs() < 1e-3 { 1e-3 } else { slope };
        let axes = [Vec3::X * slope, Vec3::Y, Vec3::Z * slope];
        let half = Vec3::new(radius / slope, 0.0, radius / slope);
        Self::with_axes(center, axes, half, Vec3::new(apex / slope, depth, 0.0), color)
    }

    /// An arrow from `tail` to `tip` in the plane `z`; the head shrinks with short arrows.
    pub fn arrow(tail: Vec2, tip: Vec2, z: f32, shaft_radius: f32, color: Color) -> Self {
        let along = tip - tail;
        let length = along.length();
        let radius = shaft_radius.min(0.8 * length / crate::mesh::ARROW_HEAD[0]);
        let axis = along.normalize_or(Vec2::X);
        Self::new(tail.extend(z), axis, Vec3::X * length, Vec3::splat(radius), color)
    }

    /// The same with a shine: 0 matt, 1 polished.
    pub fn gloss(mut self, gloss: f32) -> Self {
        self.half_and_gloss[3] = gloss;
        self
    }

    /// The same, partly independent of the light: 0 lit, 1 flat.
    pub fn unlit(mut self, unlit: f32) -> Self {
        self.radius_and_unlit[3] = unlit;
        self
    }

    /// The same, made of something.
    pub fn of(mut self, material: Material) -> Self {
        self.material = material as u32;
        self
    }

    /// True when every number can be drawn.
    pub fn is_finite(&self) -> bool {
        let numbers = self.rows.iter().chain([&self.half_and_gloss, &self.radius_and_unlit, &self.color]);
        numbers.flatten().all(|x| x.is_finite())
    }

    fn plate_with(center: Vec2, axis: Vec2, mut half: Vec3, radius: f32, z: [f32; 2], color: Color) -> Self {
        let bevel = (0.12 * radius).min(0.0006).min(half.z);
        half.z -= bevel;
        Self::new(center.extend(0.5 * (z[0] + z[1])), axis, half, Vec3::new(radius, radius, bevel), color)
    }

    fn new(origin: Vec3, axis: Vec2, half: Vec3, radius: Vec3, color: Color) -> Self {
        Self::with_axes(origin, [axis.extend(0.0), axis.perp().extend(0.0), Vec3::Z], half, radius, color)
    }

    fn with_axes(origin: Vec3, [x, y, z]: [Vec3; 3], half: Vec3, radius: Vec3, color: Color) -> Self {
        Self {
            rows: [[x.x, y.x, z.x, origin.x], [x.y, y.y, z.y, origin.y], [x.z, y.z, z.z, origin.z]],
            half_and_gloss: half.extend(0.25).into(),
            radius_and_unlit: radius.extend(0.0).into(),
            color: color.linear().into(),
            material: Material::Plain as u32,
        }
    }
}

/// A right-handed frame whose first axis points along `direction`.
fn axes_along(direction: Vec3) -> [Vec3; 3] {
    let x = direction.normalize_or(Vec3::X);
    let y = x.any_orthonormal_vector();
    [x, y, x.cross(y)]
}

/// A straight line of constant width in pixels.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Stroke {
    /// Start, world, m, and half the width, pixels.
    pub start_and_half_width: [f32; 4],
    /// End, world, m, and the length of dash and gap together, m; 0: no dashes.
    pub end_and_dash: [f32; 4],
    /// Display colour and opacity.
    pub color: [f32; 4],
    /// Path length at start and end, m: keeps dashes in step along a polyline.
    pub path_m: [f32; 2],
}

impl Stroke {
    /// A plain line.
    pub fn line(start: Vec3, end: Vec3, width_px: f32, color: Color) -> Self {
        Self {
            start_and_half_width: start.extend(0.5 * width_px).into(),
            end_and_dash: end.extend(0.0).into(),
            color: color.display().into(),
            path_m: [0.0, (end - start).length()],
        }
    }

    /// The same, dashed with the given period (m), as the part of a path that starts at `path_m`.
    pub fn dashed(mut self, period_m: f32, path_m: f32) -> Self {
        self.end_and_dash[3] = period_m;
        self.path_m = [path_m, path_m + self.path_m[1]];
        self
    }

    /// True when every number can be drawn.
    pub fn is_finite(&self) -> bool {
        bytemuck::cast_ref::<Self, [f32; 14]>(self).iter().all(|x| x.is_finite())
    }
}
