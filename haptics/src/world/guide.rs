//! Guides: a body whose middle follows a curve in the plane, held to it by a stiff spring and damper, as a slider in a slot.
//!
//! The curve is a uniform cubic B-spline over few control points (de Boor 1978): two make a straight rail, the ends of
//! an open one are its first and last point. The place on it is followed from part to part by projecting the body onto
//! the tangent. The cost of a part therefore does not depend on the length of the curve.

use super::error::{WorldError, finite, not_negative, positive, range_error};
use crate::Vec2;
use serde::{Deserialize, Serialize};

/// Most control points of a guide.
pub const MAX_GUIDE_POINTS: usize = 256;

/// Speed within which the direction of friction is blurred, m/s.
const BLUR_M_S: f64 = 2e-3;
/// Steps of the projection in one part: the body moves by far less than a span of the curve.
const PROJECTIONS: usize = 2;

/// A curve that a body's middle is held to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Guide {
    /// Control points, m in the world: at least two, four when closed.
    pub points_m: Vec<Vec2>,
    /// The curve leads back into itself.
    #[serde(default)]
    pub closed: bool,
    /// Stiffness across it, N/m, positive.
    pub stiffness_n_m: f64,
    /// Damping across it, N s/m, ≥ 0.
    pub damping_n_s_m: f64,
    /// Friction along it, N, ≥ 0.
    #[serde(default)]
    pub friction_n: f64,
}

/// Force of a guide on its body.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Guided {
    /// Place on the curve, in control points from the first.
    pub at: f64,
    /// Force on the body, N.
    pub force_n: Vec2,
}

impl Guide {
    /// Number of spans of the curve between control points.
    pub fn pieces(&self) -> usize {
        if self.closed { self.points_m.len() } else { self.points_m.len().saturating_sub(1) }
    }

    /// Control point `next − 1`, beyond the ends mirrored (open) or from the other end (closed).
    fn control(&self, next: usize) -> Vec2 {
        let n = self.points_m.len();
        let at = |k: usize| self.points_m.get(k).copied().unwrap_or_default();
        if self.closed {
            at((next + n.saturating_sub(1)) % n.max(1))
        } else if next == 0 {
            2.0 * at(0) - at(1)
        } else if next > n {
            2.0 * at(n.saturating_sub(1)) - at((2 * n).saturating_sub(next + 1))
        } else {
            at(next - 1)
        }
    }

    /// Place, m, and its derivative by `at`, m, `at` control points from the first.
    pub fn point(&self, at: f64) -> (Vec2, Vec2) {
        let piece = at.floor().clamp(0.0, self.pieces().saturating_sub(1) as f64);
        let (t, before) = (at - piece, piece as usize);
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| self.control(before + k));
        let (t2, t3, back) = (t * t, t * t * t, 1.0 - t);
        let place = a * (back * back * back)
            + b * (3.0 * t3 - 6.0 * t2 + 4.0)
            + c * (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0)
            + d * t3;
        let slope = a * (-back * back) + b * (3.0 * t2 - 4.0 * t) + c * (-3.0 * t2 + 2.0 * t + 1.0) + d * t2;
        (place / 6.0, slope / 2.0)
    }

    /// The nearest place of the whole curve: for the start.
    pub fn nearest(&self, point_m: Vec2) -> f64 {
        let tries = 16 * self.pieces();
        let distance = |at: f64| (self.point(at).0 - point_m).norm_squared();
        let coarse = (0..=tries).map(|k| k as f64 / 16.0).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        (0..8).fold(coarse.unwrap_or(0.0), |at, _| self.projected(at, point_m))
    }

    /// One step of the projection from `at`, at most one control point far.
    fn projected(&self, at: f64, point_m: Vec2) -> f64 {
        let (place, slope) = self.point(at);
        let step = (point_m - place).dot(&slope) / slope.norm_squared().max(f64::MIN_POSITIVE);
        let (next, end) = (at + step.clamp(-1.0, 1.0), self.pieces() as f64);
        if self.closed { next.rem_euclid(end.max(1.0)) } else { next.clamp(0.0, end) }
    }

    /// The force on a body at `point_m` that was at `at` before; at an end, the guide holds it along the curve, too.
    pub(super) fn hold(&self, at: f64, point_m: Vec2, velocity_m_s: Vec2) -> Guided {
        let at = (0..PROJECTIONS).fold(at, |at, _| self.projected(at, point_m));
        let (place, slope) = self.point(at);
        let along = slope / slope.norm().max(f64::MIN_POSITIVE);
        let off = point_m - place;
        let speed = along.dot(&velocity_m_s);
        let across = velocity_m_s - along * speed;
        let beyond = off.dot(&along);
        let stopped = !self.closed && (at <= 0.0 || at >= self.pieces() as f64) && beyond * speed > 0.0;
        let brake = if stopped { velocity_m_s } else { across };
        let friction = along * (self.friction_n * (speed / BLUR_M_S).tanh());
        Guided { at, force_n: -off * self.stiffness_n_m - brake * self.damping_n_s_m - friction }
    }

    /// Damping that a part must be short enough for, N s/m: friction is steepest at rest.
    pub(super) fn steepest_n_s_m(&self) -> f64 {
        self.damping_n_s_m + self.friction_n / BLUR_M_S
    }

    pub(super) fn check(&self, object: &str) -> Result<(), WorldError> {
        let (n, least) = (self.points_m.len(), if self.closed { 4 } else { 2 });
        if !(least..=MAX_GUIDE_POINTS).contains(&n) {
            let must = "2 (4 when closed) to 256 points";
            return Err(range_error(object, "guide.points_m", n as f64, must));
        }
        for point in &self.points_m {
            finite(object, "guide.points_m", point.x)?;
            finite(object, "guide.points_m", point.y)?;
        }
        if self.points_m.windows(2).any(|w| (w[1] - w[0]).norm() < 1e-6) {
            return Err(range_error(object, "guide.points_m", 0.0, "points that lie apart"));
        }
        positive(object, "guide.stiffness_n_m", self.stiffness_n_m)?;
        not_negative(object, "guide.damping_n_s_m", self.damping_n_s_m)?;
        not_negative(object, "guide.friction_n", self.friction_n)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Block, Input, State, World, step};
    use super::*;

    fn guide(points: &[(f64, f64)], closed: bool) -> Guide {
        let points_m = points.iter().map(|p| Vec2::new(p.0, p.1)).collect();
        Guide { points_m, closed, stiffness_n_m: 4000.0, damping_n_s_m: 4.0, friction_n: 0.0 }
    }

    fn slider_world(guide: Guide, start: Vec2) -> World {
        let mut world = World::empty("guide");
        world.floor = None;
        let mut slider = Block::upright("slider", 0.05, 0.01, 0.01, start.x, start.y - 0.005);
        slider.guide = Some(guide);
        world.blocks = vec![slider];
        world
    }

    /// Far away fingers.
    fn alone() -> Input {
        Input { tip_in_world: [Vec2::new(-1.0, 1.0), Vec2::new(1.0, 1.0)], tip_velocity: [Vec2::zeros(); 2] }
    }

    #[test]
    fn two_points_make_a_straight_rail_and_ends_are_where_they_are() {
        let rail = guide(&[(0.0, 0.0), (0.03, 0.04)], false);
        for k in 0..=10 {
            let share = f64::from(k) / 10.0;
            let (place, slope) = rail.point(share);
            assert!((place - Vec2::new(0.03, 0.04) * share).norm() < 1e-15 && (slope.norm() - 0.05).abs() < 1e-15);
        }
        let bent = guide(&[(0.0, 0.0), (0.02, 0.01), (0.04, -0.01), (0.06, 0.0)], false);
        assert!(bent.point(0.0).0.norm() < 1e-15 && (bent.point(3.0).0 - Vec2::new(0.06, 0.0)).norm() < 1e-15);
        // Slopes are the derivative.
        for at in [0.3, 1.0, 1.7, 2.9] {
            let by = (bent.point(at + 1e-6).0 - bent.point(at - 1e-6).0) / 2e-6;
            assert!((by - bent.point(at).1).norm() < 1e-8);
        }
    }

    #[test]
    fn a_bead_on_a_wire_falls_as_its_height_says_and_keeps_its_energy() {
        // A frictionless slope: v² = 2 g h, whatever the shape.
        let wire = guide(&[(0.0, 0.05), (0.02, 0.04), (0.04, 0.01), (0.07, 0.0), (0.12, 0.0)], false);
        let start = wire.point(0.2).0;
        let world = slider_world(wire.clone(), start);
        world.check().expect("it can be stepped");
        let mut state = State::new(&world, alone().tip_in_world);
        let mut farthest = 0.0_f64;
        for _ in 0..4000 {
            step(&world, &mut state, &alone(), 2.5e-4);
            let body = &state.bodies[0];
            let on = wire.point(wire.nearest(body.center_m)).0;
            farthest = farthest.max((on - body.center_m).norm());
            if body.center_m.x > 0.10 {
                break;
            }
        }
        let body = &state.bodies[0];
        let expected = (2.0 * 9.81 * (start.y - body.center_m.y)).sqrt();
        assert!((body.velocity_m_s.norm() / expected - 1.0).abs() < 0.02, "{} {expected}", body.velocity_m_s.norm());
        assert!(farthest < 1e-3 && body.rate_rad_s == 0.0, "{farthest}");
    }

    #[test]
    fn a_closed_guide_has_no_end_and_an_open_one_stops() {
        let ring: Vec<(f64, f64)> = (0..12)
            .map(|k| std::f64::consts::TAU * f64::from(k) / 12.0)
            .map(|a| (0.03 * a.cos(), 0.03 * a.sin()))
            .collect();
        let ring = guide(&ring, true);
        let mut world = slider_world(ring.clone(), ring.point(0.0).0);
        world.gravity_m_s2 = 0.0;
        let mut state = State::new(&world, alone().tip_in_world);
        state.bodies[0].velocity_m_s = Vec2::new(0.0, 0.2);
        let mut turned = 0.0;
        let mut before = 0.0;
        for _ in 0..2000 {
            step(&world, &mut state, &alone(), 1e-3);
            let p = state.bodies[0].center_m;
            let angle = p.y.atan2(p.x);
            let way = angle - before;
            turned += way - std::f64::consts::TAU * (way / std::f64::consts::TAU).round();
            before = angle;
        }
        assert!(turned > 10.0, "{turned}");
        // Down a rail that ends: it comes to rest at the end.
        let rail = guide(&[(0.0, 0.1), (0.0, 0.0)], false);
        let world = slider_world(rail, Vec2::new(0.0, 0.05));
        let mut state = State::new(&world, alone().tip_in_world);
        for _ in 0..3000 {
            step(&world, &mut state, &alone(), 1e-3);
        }
        assert!(state.bodies[0].center_m.y.abs() < 1e-3 && state.bodies[0].velocity_m_s.norm() < 1e-3);
    }

    #[test]
    fn what_cannot_be_a_guide_is_said() {
        for bad in [
            guide(&[(0.0, 0.0)], false),
            guide(&[(0.0, 0.0), (0.0, 0.0)], false),
            guide(&[(0.0, 0.0), (f64::NAN, 1.0)], false),
        ] {
            assert!(slider_world(bad, Vec2::zeros()).check().is_err());
        }
    }
}
