//! The key light: its direction, and the box of space whose shadows are recorded in its map.

use crate::shape::Solid;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Unit vector towards the key light: from the upper left, in front of the plane.
pub(crate) const KEY: Vec3 = Vec3::new(-0.4240, 0.7067, 0.5664);

/// Side of the shadow map, texels: half a millimetre each for the default hand.
pub(crate) const MAP_TEXELS: u32 = 512;

/// Size of the table's light map, texels: twice as long as deep, as the table is.
pub(crate) const TABLE_TEXELS: [u32; 2] = [384, 192];

/// Size of the map of the sky over it, texels: that is never sharp.
pub(crate) const SKY_TEXELS: [u32; 2] = [192, 96];

/// Width of the light, as the tangent of half the angle that it is seen under: how fast shadows grow soft with distance.
const SOFTNESS: f32 = 0.085;

/// The box grows in steps of this, m: a box that followed every movement would make edges of shadows crawl.
const STEP_M: f32 = 0.02;

/// Shadow map as the shaders know it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KeyLight {
    /// From the world to the map: x and y from 0 to 1 (y down), z from 0 at the light to 1.
    pub map_from_world: Mat4,
    /// Texels of a side, size of a texel (m), depth of the box (m), width of the light.
    pub measures: Vec4,
}

impl KeyLight {
    /// A light whose box holds all `casters`.
    pub(crate) fn around<'a>(casters: impl Iterator<Item = &'a Solid>) -> Self {
        let axes = axes();
        let spans = casters.filter(|solid| solid.is_finite()).map(|solid| axes.map(|axis| span(solid, axis)));
        let all = spans.reduce(|a, b| [0, 1, 2].map(|i| Vec2::new(a[i].x.min(b[i].x), a[i].y.max(b[i].y))));
        // Nothing casts a shadow: any box will do.
        let all = all.unwrap_or([Vec2::new(-0.1, 0.1); 3]);
        let stepped = all.map(|Vec2 { x: low, y: high }| {
            Vec2::new((low / STEP_M).floor() - 0.5, (high / STEP_M).ceil() + 0.5) * STEP_M
        });
        let size = stepped.map(|s| s.y - s.x);
        let side = size[0].max(size[1]);
        let [x, y, z] = [0, 1, 2].map(|i| 0.5 * (stepped[i].x + stepped[i].y));
        let row = |axis: Vec3, middle: f32, scale: f32| (axis * scale).extend(0.5 - middle * scale);
        let rows = [row(axes[0], x, 1.0 / side), row(axes[1], y, 1.0 / side), row(axes[2], z, 1.0 / size[2])];
        Self {
            map_from_world: Mat4::from_cols(rows[0], rows[1], rows[2], Vec4::W).transpose(),
            measures: Vec4::new(MAP_TEXELS as f32, side / MAP_TEXELS as f32, size[2], SOFTNESS),
        }
    }
}

/// Right, down and away, as the light sees the world.
fn axes() -> [Vec3; 3] {
    let right = Vec3::Y.cross(KEY).normalize();
    [right, -KEY.cross(right), -KEY]
}

/// The least and the greatest coordinate of a solid along an axis.
fn span(solid: &Solid, axis: Vec3) -> Vec2 {
    let rows = solid.rows.map(Vec4::from);
    let along = axis.x * rows[0] + axis.y * rows[1] + axis.z * rows[2];
    let half = Vec4::from(solid.half_and_gloss).truncate().abs();
    let radius = Vec4::from(solid.radius_and_unlit).truncate().abs();
    let reach = along.truncate().abs().dot(half + radius);
    Vec2::new(along.w - reach, along.w + reach)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Color;

    const GREY: Color = Color::rgb8(0x80, 0x80, 0x80);

    #[test]
    fn the_key_light_is_a_direction() {
        assert!((KEY.length() - 1.0).abs() < 1e-4);
        let [x, y, z] = axes();
        assert!(x.cross(y).distance(z) < 1e-5, "right, down and away are right-handed");
    }

    #[test]
    fn the_map_holds_every_corner_and_what_is_nearer_to_the_light_is_nearer_to_zero() {
        let center = Vec3::new(0.03, -0.1, 0.0);
        let solids = [
            Solid::rounded_box(center, Vec3::new(0.02, 0.01, 0.01), 0.3, 0.001, GREY),
            Solid::ball(Vec3::new(-0.05, 0.02, 0.01), 0.004, GREY),
        ];
        let light = KeyLight::around(solids.iter());
        for corner in [Vec3::new(1.0, 1.0, 1.0), Vec3::new(-1.0, 1.0, -1.0), Vec3::new(1.0, -1.0, -1.0)] {
            let turned = Vec2::from_angle(0.3).rotate((corner * 0.02).truncate()).extend(corner.z * 0.01);
            let found = light.map_from_world.project_point3(center + turned.with_y(0.5 * turned.y));
            assert!(found.min_element() > 0.0 && found.max_element() < 1.0, "{found}");
        }
        let depth = |point: Vec3| light.map_from_world.project_point3(point).z;
        assert!((depth(center - 0.01 * KEY) - depth(center)) * light.measures.z - 0.01 < 1e-5);
        assert!(depth(center + 0.01 * KEY) < depth(center));
    }

    #[test]
    fn small_movements_leave_the_map_where_it_is() {
        let ball = |x: f32| [Solid::ball(Vec3::new(x, -0.1, 0.0), 0.004, GREY)];
        let at = |x: f32| KeyLight::around(ball(x).iter());
        let same = (0..20_u8).filter(|i| {
            let x = f32::from(*i) * 0.001;
            at(x) == at(x + 0.0002)
        });
        assert!(same.count() > 15);
        assert_ne!(at(0.0), at(0.1));
    }
}
