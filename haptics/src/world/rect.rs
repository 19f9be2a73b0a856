//! Rectangles in the plane: where a point or another rectangle overlaps one.

use crate::Vec2;

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
    pub fn axis_y(self) -> Vec2 {
        Vec2::new(-self.axis_x.y, self.axis_x.x)
    }

    /// A world point in the rectangle's own frame, m from its centre.
    pub fn to_local(self, point_in_world: Vec2) -> Vec2 {
        let offset = point_in_world - self.center_m;
        Vec2::new(offset.dot(&self.axis_x), offset.dot(&self.axis_y()))
    }

    /// Corner `index` (0 lower left, 1 lower right, 2 upper right, 3 upper left) in the world.
    pub fn corner(self, index: u8) -> Vec2 {
        let sx = if index == 1 || index == 2 { 1.0 } else { -1.0 };
        let sy = if index >= 2 { 1.0 } else { -1.0 };
        self.center_m + self.axis_x * (sx * self.half_m.x) + self.axis_y() * (sy * self.half_m.y)
    }

    /// Outward normal of face 0 (+x), 1 (+y), 2 (−x), 3 (−y), and its distance from the centre, m.
    pub fn face(self, index: u8) -> (Vec2, f64) {
        match index {
            0 => (self.axis_x, self.half_m.x),
            1 => (self.axis_y(), self.half_m.y),
            2 => (-self.axis_x, self.half_m.x),
            _ => (-self.axis_y(), self.half_m.y),
        }
    }
}

/// The face of `rect` through which a point inside it is pushed out, and its depth, m. `kept` is the face of an existing
/// contact: it stays, so that a pad that sinks in does not jump to another side. A point less than `margin_m` outside one face
/// has a negative depth. `None` farther off.
pub fn point_in_rect(rect: &Rect, point_in_world: Vec2, kept: Option<u8>, margin_m: f64) -> Option<(u8, f64)> {
    let local = rect.to_local(point_in_world);
    let depths = [rect.half_m.x - local.x, rect.half_m.y - local.y, rect.half_m.x + local.x, rect.half_m.y + local.y];
    let outside = depths.iter().filter(|d| **d <= 0.0).count();
    if outside > 1 || depths.iter().any(|d| *d <= -margin_m) {
        return None;
    }
    // Outside one face, that face is the one it may come in by.
    let kept = kept.filter(|face| outside == 0 || depths[usize::from(*face)] <= 0.0);
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

/// Contact of two rectangles by separating axes and face clipping. Returns the normal from `b` into `a` and up to two points;
/// points less than `margin_m` apart count, with a negative depth.
pub fn rect_rect(a: &Rect, b: &Rect, margin_m: f64) -> Option<(Vec2, [Option<ManifoldPoint>; 2])> {
    // Least overlap over the eight face normals. A face of `a` must win clearly, so that nearly equal overlaps do not
    // make the reference face flicker.
    let (face_b, depth_b) = least_overlap(b, a, margin_m)?;
    let (face_a, depth_a) = least_overlap(a, b, margin_m)?;
    let prefer_a = depth_a < depth_b - 0.05 * depth_b.abs() - 1e-6;
    let (reference, incident, face) = if prefer_a { (a, b, face_a) } else { (b, a, face_b) };
    let points = clip(reference, incident, face, (u8::from(prefer_a) << 3) | (face << 1), margin_m);
    let normal = reference.face(face).0;
    let into_a = if prefer_a { -normal } else { normal };
    Some((into_a, points))
}

/// The face of `reference` with the least overlap by `other`, with that overlap, m; `None` when they are more than `margin_m`
/// apart.
fn least_overlap(reference: &Rect, other: &Rect, margin_m: f64) -> Option<(u8, f64)> {
    // In the frame of the reference the four faces are two pairs with one extent each.
    let between = reference.to_local(other.center_m);
    let cos = reference.axis_x.dot(&other.axis_x).abs();
    let sin = reference.axis_x.perp(&other.axis_x).abs();
    let reach_x = reference.half_m.x + other.half_m.x * cos + other.half_m.y * sin;
    let reach_y = reference.half_m.y + other.half_m.x * sin + other.half_m.y * cos;
    let (depth_x, depth_y) = (reach_x - between.x.abs(), reach_y - between.y.abs());
    if depth_x <= -margin_m || depth_y <= -margin_m {
        return None;
    }
    let face_x = if between.x > 0.0 { 0 } else { 2 };
    let face_y = if between.y > 0.0 { 1 } else { 3 };
    Some(if depth_x < depth_y { (face_x, depth_x) } else { (face_y, depth_y) })
}

/// Clips the incident rectangle's facing edge to the sides of the reference face and keeps the points below the face,
/// or less than `margin_m` above it.
fn clip(reference: &Rect, incident: &Rect, face: u8, feature: u8, margin_m: f64) -> [Option<ManifoldPoint>; 2] {
    let (normal, offset) = reference.face(face);
    // The incident face looks most against the normal.
    let (along_x, along_y) = (incident.axis_x.dot(&normal), incident.axis_y().dot(&normal));
    let incident_face = match (along_x.abs() > along_y.abs(), along_x > 0.0, along_y > 0.0) {
        (true, false, _) => 0,
        (true, true, _) => 2,
        (false, _, false) => 1,
        (false, _, true) => 3,
    };
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
        (depth > -margin_m).then_some((p, depth, feature | last_bit))
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
        let (normal, points) =
            rect_rect(&square(0.003, 0.0195, 0.0), &square(0.0, 0.0, 0.0), 0.0).expect("they overlap");
        assert!((normal - Vec2::new(0.0, 1.0)).norm() < 1e-12);
        let mut xs: Vec<f64> = points.iter().flatten().map(|(p, _, _)| p.x).collect();
        xs.sort_by(f64::total_cmp);
        assert!((xs[0] + 0.007).abs() < 1e-12 && (xs[1] - 0.01).abs() < 1e-12, "{xs:?}");
        assert!(points.iter().flatten().all(|(_, d, _)| (d - 0.0005).abs() < 1e-12));
    }

    #[test]
    fn apart_is_none_and_a_tilted_block_touches_with_its_corner() {
        assert!(rect_rect(&square(0.0, 0.0201, 0.0), &square(0.0, 0.0, 0.0), 0.0).is_none());
        let (normal, points) =
            rect_rect(&square(0.0, 0.0238, 0.6), &square(0.0, 0.0, 0.0), 0.0).expect("the corner reaches in");
        assert!((normal - Vec2::new(0.0, 1.0)).norm() < 1e-9);
        assert_eq!(points.iter().flatten().count(), 1);
    }
}
