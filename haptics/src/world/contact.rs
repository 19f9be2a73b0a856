//! Compliant contact with a stick state: the force between two surfaces from their overlap and relative motion.
//!
//! Normal: Kelvin–Voigt spring and damper that never pulls. Tangential: an elastic anchor that is carried along when the
//! Coulomb limit is reached (Cundall & Strack 1979), so that a sticking contact holds without creep.

use super::state::{Contact, Surface};
use crate::Vec2;
use crate::law::contact::StiffnessHardening;

/// Contact law of a pair of surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Normal elastic force over depth.
    pub elastic: StiffnessHardening,
    /// Normal damping, N s/m.
    pub damping_n_s_m: f64,
    /// Tangential stiffness while sticking, N/m.
    pub shear_stiffness_n_m: f64,
    /// Tangential damping while sticking, N s/m.
    pub shear_damping_n_s_m: f64,
    /// Coulomb coefficient.
    pub friction: f64,
}

impl Material {
    /// Hard contact: tangential stiffness and damping in proportion to the normal ones (2/3, Mindlin 1949 for common solids).
    pub fn hard(stiffness_n_m: f64, damping_n_s_m: f64, friction: f64) -> Self {
        const TANGENTIAL_SHARE: f64 = 2.0 / 3.0;
        Self {
            elastic: StiffnessHardening { k1: stiffness_n_m, ..StiffnessHardening::default() },
            damping_n_s_m,
            shear_stiffness_n_m: TANGENTIAL_SHARE * stiffness_n_m,
            shear_damping_n_s_m: TANGENTIAL_SHARE * damping_n_s_m,
            friction,
        }
    }
}

/// Where two surfaces overlap, before any force is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// The body that is pushed along `normal`, and the one that pushes.
    pub pair: (Surface, Surface),
    /// Tells points of one pair apart.
    pub feature: u8,
    /// Contact point in the world, m.
    pub point_m: Vec2,
    /// Unit vector from the pusher into the pushed.
    pub normal: Vec2,
    /// Overlap, m, positive.
    pub depth_m: f64,
    /// Velocity of the pushed body relative to the pusher at the point, m/s.
    pub relative_velocity: Vec2,
}

/// The contact force, given the elastic tangential displacement left by the tick before (zero for a new contact).
pub fn resolve(overlap: &Overlap, material: &Material, shear_before_m: f64, dt_s: f64) -> Contact {
    let normal = overlap.normal;
    let tangent = Vec2::new(normal.y, -normal.x);
    let opening = overlap.relative_velocity.dot(&normal);
    let slip = overlap.relative_velocity.dot(&tangent);
    let normal_force = (material.elastic.force_n(overlap.depth_m) - material.damping_n_s_m * opening).max(0.0);

    let mut shear = shear_before_m + slip * dt_s;
    let limit = material.friction * normal_force;
    let stuck = -(material.shear_stiffness_n_m * shear + material.shear_damping_n_s_m * slip);
    let tangent_force = stuck.clamp(-limit, limit);
    let sliding = stuck != tangent_force;
    if sliding {
        // The anchor slides along: the spring keeps what the limit can carry, the damper none of it.
        shear = -tangent_force / material.shear_stiffness_n_m;
    }
    Contact {
        on: overlap.pair.0,
        by: overlap.pair.1,
        feature: overlap.feature,
        point_m: overlap.point_m,
        normal,
        depth_m: overlap.depth_m,
        shear_m: shear,
        normal_force_n: normal_force,
        tangent_force_n: tangent_force,
        sliding,
    }
}

/// A rectangle in the world.
#[derive(Clone, Copy, Debug)]
pub struct Rect {
    /// Centre, m.
    pub center_m: Vec2,
    /// Half width and half height, m.
    pub half_m: Vec2,
    /// First axis (along the width); the second is this turned by +90°.
    pub axis_x: Vec2,
}

impl Rect {
    /// Second axis (along the height).
    pub fn axis_y(&self) -> Vec2 {
        Vec2::new(-self.axis_x.y, self.axis_x.x)
    }

    /// A world point in the rectangle's own frame, m from its centre.
    pub fn to_local(&self, point_in_world: Vec2) -> Vec2 {
        let offset = point_in_world - self.center_m;
        Vec2::new(offset.dot(&self.axis_x), offset.dot(&self.axis_y()))
    }

    /// Corner `index` (0 lower left, 1 lower right, 2 upper right, 3 upper left) in the world.
    pub fn corner(&self, index: u8) -> Vec2 {
        let sx = if index == 1 || index == 2 { 1.0 } else { -1.0 };
        let sy = if index >= 2 { 1.0 } else { -1.0 };
        self.center_m + self.axis_x * (sx * self.half_m.x) + self.axis_y() * (sy * self.half_m.y)
    }

    /// Outward normal of face 0 (+x), 1 (+y), 2 (−x), 3 (−y), and its distance from the centre, m.
    pub fn face(&self, index: u8) -> (Vec2, f64) {
        match index {
            0 => (self.axis_x, self.half_m.x),
            1 => (self.axis_y(), self.half_m.y),
            2 => (-self.axis_x, self.half_m.x),
            _ => (-self.axis_y(), self.half_m.y),
        }
    }

    /// Radius of the circle around it, m.
    pub fn reach_m(&self) -> f64 {
        self.half_m.norm()
    }
}

/// The face of `rect` through which a point inside it is pushed out, and its depth, m. `kept` is the face of an existing
/// contact: it stays, so that a pad that sinks in does not jump to another side. `None` outside.
pub fn point_in_rect(rect: &Rect, point_in_world: Vec2, kept: Option<u8>) -> Option<(u8, f64)> {
    let local = rect.to_local(point_in_world);
    let depths = [rect.half_m.x - local.x, rect.half_m.y - local.y, rect.half_m.x + local.x, rect.half_m.y + local.y];
    if depths.iter().any(|d| *d <= 0.0) {
        return None;
    }
    let face = kept.unwrap_or_else(|| {
        let mut best = 0_u8;
        for index in 1..4_u8 {
            if depths[usize::from(index)] < depths[usize::from(best)] {
                best = index;
            }
        }
        best
    });
    Some((face, depths[usize::from(face)]))
}

/// A contact point of two rectangles: position, m, and depth, m, with its feature number.
pub type ManifoldPoint = (Vec2, f64, u8);

/// Contact of two rectangles by separating axes and face clipping. Returns the normal from `b` into `a` and up to two points.
pub fn rect_rect(a: &Rect, b: &Rect) -> Option<(Vec2, [Option<ManifoldPoint>; 2])> {
    let reach = a.reach_m() + b.reach_m();
    if (a.center_m - b.center_m).norm_squared() > reach * reach {
        return None;
    }
    // Least overlap over the eight face normals. A face of `a` must win clearly, so that nearly equal overlaps do not
    // make the reference face flicker.
    let (face_b, depth_b) = least_overlap(b, a)?;
    let (face_a, depth_a) = least_overlap(a, b)?;
    let prefer_a = depth_a < 0.95 * depth_b - 1e-6;
    let (reference, incident, face) = if prefer_a { (a, b, face_a) } else { (b, a, face_b) };
    let (normal, offset) = reference.face(face);
    let points = clip(reference, incident, face, normal, offset, (u8::from(prefer_a) << 3) | (face << 1));
    let into_a = if prefer_a { -normal } else { normal };
    Some((into_a, points))
}

/// The face of `reference` with the least overlap by `other`, with that overlap, m; `None` when separated.
fn least_overlap(reference: &Rect, other: &Rect) -> Option<(u8, f64)> {
    let between = other.center_m - reference.center_m;
    let mut best: Option<(u8, f64)> = None;
    for face in 0..4_u8 {
        let (normal, offset) = reference.face(face);
        let extent =
            other.half_m.x * normal.dot(&other.axis_x).abs() + other.half_m.y * normal.dot(&other.axis_y()).abs();
        let depth = offset + extent - between.dot(&normal);
        if depth <= 0.0 {
            return None;
        }
        if best.is_none_or(|(_, least)| depth < least) {
            best = Some((face, depth));
        }
    }
    best
}

/// Clips the incident rectangle's facing edge to the sides of the reference face and keeps what lies below the face.
fn clip(
    reference: &Rect,
    incident: &Rect,
    face: u8,
    normal: Vec2,
    offset: f64,
    feature: u8,
) -> [Option<ManifoldPoint>; 2] {
    let incident_face = (0..4_u8)
        .min_by(|i, j| incident.face(*i).0.dot(&normal).total_cmp(&incident.face(*j).0.dot(&normal)))
        .unwrap_or(0);
    let (edge_normal, edge_offset) = incident.face(incident_face);
    let along = Vec2::new(-edge_normal.y, edge_normal.x);
    let edge_half = if incident_face.is_multiple_of(2) { incident.half_m.y } else { incident.half_m.x };
    let middle = incident.center_m + edge_normal * edge_offset;

    let side = Vec2::new(-normal.y, normal.x);
    let side_half = if face.is_multiple_of(2) { reference.half_m.y } else { reference.half_m.x };
    // The edge as middle + u along, u in [-edge_half, edge_half]; |coordinate along the side| must be ≤ side_half.
    let (start, slope) = ((middle - reference.center_m).dot(&side), along.dot(&side));
    let (mut low, mut high) = (-edge_half, edge_half);
    if slope.abs() > 1e-9 {
        let (first, second) = ((-side_half - start) / slope, (side_half - start) / slope);
        low = low.max(first.min(second));
        high = high.min(first.max(second));
    }
    if low > high {
        return [None, None];
    }
    let point = |u: f64, last_bit: u8| {
        let p = middle + along * u;
        let depth = offset - (p - reference.center_m).dot(&normal);
        (depth > 0.0).then_some((p, depth, feature | last_bit))
    };
    [point(low, 0), point(high, 1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, angle: f64) -> Rect {
        Rect { center_m: Vec2::new(x, y), half_m: Vec2::new(0.01, 0.01), axis_x: Vec2::new(angle.cos(), angle.sin()) }
    }

    #[test]
    fn a_block_on_a_block_touches_at_two_points() {
        let (normal, points) = rect_rect(&square(0.003, 0.0195, 0.0), &square(0.0, 0.0, 0.0)).expect("they overlap");
        assert!((normal - Vec2::new(0.0, 1.0)).norm() < 1e-12);
        let mut xs: Vec<f64> = points.iter().flatten().map(|(p, _, _)| p.x).collect();
        xs.sort_by(f64::total_cmp);
        assert!((xs[0] + 0.007).abs() < 1e-12 && (xs[1] - 0.01).abs() < 1e-12, "{xs:?}");
        assert!(points.iter().flatten().all(|(_, d, _)| (d - 0.0005).abs() < 1e-12));
    }

    #[test]
    fn apart_is_none_and_a_tilted_block_touches_with_its_corner() {
        assert!(rect_rect(&square(0.0, 0.0201, 0.0), &square(0.0, 0.0, 0.0)).is_none());
        let (normal, points) =
            rect_rect(&square(0.0, 0.0238, 0.6), &square(0.0, 0.0, 0.0)).expect("the corner reaches in");
        assert!((normal - Vec2::new(0.0, 1.0)).norm() < 1e-9);
        assert_eq!(points.iter().flatten().count(), 1);
    }

    #[test]
    fn friction_sticks_below_the_cone_and_slides_at_it() {
        let material = Material::hard(1000.0, 0.0, 0.5);
        let overlap = Overlap {
            pair: (Surface::Block(0), Surface::Floor),
            feature: 0,
            point_m: Vec2::zeros(),
            normal: Vec2::new(0.0, 1.0),
            depth_m: 0.001,
            relative_velocity: Vec2::new(0.0, 0.0),
        };
        // 1 N normal, so 0.5 N friction at most; the anchor gives 2/3 N per mm.
        let stuck = resolve(&overlap, &material, 0.0003, 1e-3);
        assert!(!stuck.sliding && (stuck.tangent_force_n + 0.2).abs() < 1e-12);
        let slid = resolve(&overlap, &material, 0.003, 1e-3);
        assert!(slid.sliding && (slid.tangent_force_n + 0.5).abs() < 1e-12);
        assert!((slid.shear_m - 0.00075).abs() < 1e-12, "the anchor was dragged along");
    }
}
