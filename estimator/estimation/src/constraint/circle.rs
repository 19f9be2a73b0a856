//! Circles and lines as one family, by curvature: a line is a circle of curvature zero, so nothing blows up between them.

use foundation::cancellation;
use haptics::Vec2;
use nalgebra::{Matrix3, Vector3};

/// A circle of signed curvature κ that touches the line at distance `offset_m` from the origin, whose direction is
/// `angle_rad`; κ = 0 is that line. Positive κ bends to the left of the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// 1/m.
    pub curvature: f64,
    /// Direction of the tangent at the foot point, rad.
    pub angle_rad: f64,
    /// Distance of the foot point from the origin along the left normal, m.
    pub offset_m: f64,
}

impl Arc {
    fn axes(&self) -> (Vec2, Vec2) {
        let (sin, cos) = self.angle_rad.sin_cos();
        (Vec2::new(cos, sin), Vec2::new(-sin, cos))
    }

    /// Signed distance of a point from the arc, m: positive outside for κ > 0 (Pratt 1987, written so that κ → 0 is exact).
    pub fn distance(&self, p: Vec2) -> f64 {
        let (along, left) = self.axes();
        let (x, y) = (along.dot(&p), left.dot(&p) - self.offset_m);
        let a = self.curvature * (x * x + y * y) - 2.0 * y;
        a / (1.0 + (1.0 + self.curvature * a).max(0.0).sqrt())
    }

    /// Centre, m; `None` for a line.
    pub fn center(&self) -> Option<Vec2> {
        let (_, left) = self.axes();
        (self.curvature != 0.0).then(|| left * (self.offset_m + 1.0 / self.curvature))
    }

    fn moved(&self, step: Vector3<f64>) -> Self {
        Self {
            curvature: self.curvature + step[0],
            angle_rad: self.angle_rad + step[1],
            offset_m: self.offset_m + step[2],
        }
    }

    /// The same arc with κ ≥ 0.
    fn turned(self) -> Self {
        if self.curvature >= 0.0 {
            return self;
        }
        Self { curvature: -self.curvature, angle_rad: self.angle_rad + std::f64::consts::PI, offset_m: -self.offset_m }
    }
}

/// Sum of squared distances, m².
pub fn cost(points: &[Vec2], arc: &Arc) -> f64 {
    points.iter().map(|p| arc.distance(*p).powi(2)).sum()
}

/// Derivatives of the distance with respect to curvature, angle and offset at one point, by central differences scaled to
/// the extent of the points.
pub fn gradient(arc: &Arc, p: Vec2, extent_m: f64) -> Vector3<f64> {
    let steps = [1e-5 / extent_m, 1e-6, 1e-6 * extent_m];
    Vector3::from_fn(|i, _| {
        let mut step = Vector3::zeros();
        step[i] = steps[i];
        (arc.moved(step).distance(p) - arc.moved(-step).distance(p)) / (2.0 * steps[i])
    })
}

/// Least-squares arc through points near `start` by Levenberg–Marquardt; `fixed_curvature` keeps κ.
pub fn refine(points: &[Vec2], start: Arc, fixed_curvature: bool, extent_m: f64) -> (Arc, f64) {
    // Curvature, angle and offset in comparable sizes.
    let scale = Vector3::new(if fixed_curvature { 0.0 } else { 1.0 / extent_m }, 1.0, extent_m);
    let (mut arc, mut best, mut damping) = (start, cost(points, &start), 1e-6);
    for _ in 0..60 {
        if !cancellation::is_wanted() {
            break;
        }
        let (mut normal, mut slope) = (Matrix3::zeros(), Vector3::zeros());
        for p in points {
            let g = gradient(&arc, *p, extent_m).component_mul(&scale);
            normal += g * g.transpose();
            slope += g * arc.distance(*p);
        }
        if fixed_curvature {
            normal[(0, 0)] = 1.0;
        }
        let trial = loop {
            let damped = normal + Matrix3::from_diagonal(&normal.diagonal()) * damping;
            let step = damped.try_inverse().map_or_else(Vector3::zeros, |i| -(i * slope).component_mul(&scale));
            let next = arc.moved(step);
            let next_cost = cost(points, &next);
            if next_cost < best {
                damping = (damping * 0.1).max(1e-12);
                break Some((next, next_cost));
            }
            damping *= 10.0;
            if damping > 1e6 {
                break None;
            }
        };
        let Some((next, next_cost)) = trial else { break };
        let done = best - next_cost <= 1e-14 * best;
        (arc, best) = (next, next_cost);
        if done {
            break;
        }
    }
    (arc, best)
}

/// The best arc through centred points: from the algebraic circle (Kåsa 1976) and from the line, whichever ends lower.
/// Curvature ≥ 0.
pub fn fit(points: &[Vec2], extent_m: f64) -> (Arc, f64) {
    let line = Arc { curvature: 0.0, angle_rad: 0.0, offset_m: 0.0 };
    let starts = [kasa(points), Some(line)];
    let fits = starts.into_iter().flatten().map(|start| refine(points, start, false, extent_m));
    let (arc, cost) = fits.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((line, f64::INFINITY));
    (arc.turned(), cost)
}

/// Algebraic circle: x² + y² = 2 a x + 2 b y + c.
fn kasa(points: &[Vec2]) -> Option<Arc> {
    let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
    for p in points {
        let row = Vector3::new(2.0 * p.x, 2.0 * p.y, 1.0);
        normal += row * row.transpose();
        right += row * p.norm_squared();
    }
    let solution = normal.try_inverse()? * right;
    let center = Vec2::new(solution[0], solution[1]);
    let radius = (solution[2] + center.norm_squared()).max(0.0).sqrt();
    // A full turn is centred on its own mean: any direction will do.
    let left = center.try_normalize(1e-9 * radius).unwrap_or_else(Vec2::y);
    (radius > 0.0 && radius.is_finite()).then(|| Arc {
        curvature: 1.0 / radius,
        angle_rad: (-left.x).atan2(left.y),
        offset_m: center.norm() - radius,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn circles_and_lines_are_found_exactly() {
        for (radius, sweep) in [(0.3, 1.5), (0.3, 6.2), (2.0, 0.3), (0.02, 12.0)] {
            let points: Vec<Vec2> = (0..100)
                .map(|i| {
                    let a = sweep * f64::from(i) / 100.0;
                    Vec2::new(radius * a.cos(), radius * a.sin())
                })
                .collect();
            let mean = points.iter().sum::<Vec2>() / 100.0;
            let centred: Vec<Vec2> = points.iter().map(|p| p - mean).collect();
            let (arc, cost) = fit(&centred, radius);
            assert!((arc.curvature * radius - 1.0).abs() < 1e-6, "{radius} {sweep}: {arc:?}");
            assert!((arc.center().expect("a circle") + mean).norm() < 1e-6 && cost < 1e-12);
        }
        let line: Vec<Vec2> = (-50..50).map(|i| Vec2::new(0.01 * f64::from(i), 0.005 * f64::from(i))).collect();
        let (arc, cost) = fit(&line, 1.0);
        assert!(arc.curvature.abs() < 1e-6 && cost < 1e-15, "{arc:?} {cost}");
    }

    #[test]
    fn distance_is_geometric() {
        let arc = Arc { curvature: 2.0, angle_rad: 0.0, offset_m: 0.1 };
        // Centre (0, 0.6), radius 0.5.
        assert!((arc.distance(Vec2::new(0.0, 0.0)) - 0.1).abs() < 1e-15);
        assert!((arc.distance(Vec2::new(1.0, 0.6)) - 0.5).abs() < 1e-15);
        assert!((arc.distance(Vec2::new(0.2, 0.6)) + 0.3).abs() < 1e-15);
    }
}
