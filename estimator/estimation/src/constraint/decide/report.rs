//! Numbers of a decided shape: the content of a constraint beside its kind.

use super::shape::Shape;
use super::{CLOSE_SHARE, COMPACT_NOISES, COMPACT_SHARE, GUIDE_ALONG, RIGID_N_M};
use crate::constraint::spline;
use crate::constraint::yielding::{Manipulator, yielding};
use foundation::estimate::{Constraint, ConstraintKind, Guide, Leaning};
use nalgebra::Vector3;

impl Shape {
    pub(super) fn describe(&self, found: &mut Constraint, planar: bool) {
        let dimensions = if planar { 2 } else { 3 };
        let numbers = |v: Vector3<f64>| v.iter().take(dimensions).copied().collect::<Vec<f64>>();
        found.coverage_m = Some(self.frame.travelled_m);
        found.plane_residual_m = (!planar).then_some(self.frame.plane_rms_m);
        if !planar && self.leaves_plane() {
            found.evidence = format!(
                "{}; the path leaves its best plane by {:.1} mm (root mean square), so what is said of it in the plane is rough",
                found.evidence,
                1e3 * self.frame.plane_rms_m
            );
        }
        let (low, high) = self.interval;
        let interval = (1.0 / high.max(f64::MIN_POSITIVE), (low > 0.0).then(|| 1.0 / low));
        match found.kind {
            ConstraintKind::Revolute => {
                let radius = 1.0 / self.arc.curvature;
                let error = radius * radius * self.curvature_error;
                found.radius_m = Some(radius);
                found.radius_interval_m = Some(interval);
                found.center_m = self.arc.center().map(|c| numbers(self.frame.lift(c)));
                found.direction = Some(self.frame.axes[2].iter().copied().collect());
                found.std_error = [("radius_m", error), ("center_m", error)].map(|(k, v)| (k.to_owned(), v)).into();
                found.coverage_rad = Some(self.turned_rad());
                found.residual_m = Some(self.residual_m());
            }
            ConstraintKind::Prismatic => {
                found.direction = Some(numbers(self.travel()));
                found.std_error = [("direction_rad".to_owned(), self.angle_error)].into();
                found.radius_interval_m = Some(interval);
                found.residual_m = Some(self.frame.line_rms_m);
            }
            ConstraintKind::Undecided => {
                found.leaning = Some(self.leaning());
                found.radius_m = (self.arc.curvature * self.frame.extent_m > 1e-3).then(|| 1.0 / self.arc.curvature);
                found.radius_interval_m = Some(interval);
                found.residual_m = Some(self.residual_m());
            }
            ConstraintKind::Spline => {
                found.residual_m = Some(self.residual_m());
                found.guide = self.compact(&numbers);
            }
            _ => found.residual_m = Some(self.residual_m()),
        }
    }

    /// The path by few control points.
    fn compact(&self, numbers: &dyn Fn(Vector3<f64>) -> Vec<f64>) -> Option<Guide> {
        let bound = (COMPACT_NOISES * self.frame.noise_m).max(COMPACT_SHARE * self.frame.extent_m);
        let found = spline::fit(&self.frame.flat, self.frame.extent_m, bound)?;
        Some(Guide {
            points_m: found.curve.points_m.iter().map(|p| numbers(self.frame.lift(*p))).collect(),
            closed: found.curve.closed,
            length_m: found.length_m,
            rms_m: found.rms_m,
            largest_m: found.largest_m,
        })
    }

    /// The likelier kind where none is certain.
    fn leaning(&self) -> Leaning {
        if self.residual_m() > CLOSE_SHARE * self.frame.extent_m {
            let kind =
                if self.retrace.along_share > GUIDE_ALONG { ConstraintKind::Spline } else { ConstraintKind::Free };
            return Leaning { kind, probability: None };
        }
        let line = self.straight_probability;
        if line >= 0.5 {
            Leaning { kind: ConstraintKind::Prismatic, probability: Some(line) }
        } else {
            Leaning { kind: ConstraintKind::Revolute, probability: Some(1.0 - line) }
        }
    }

    /// Direction of a slide, from its first point to its last.
    fn travel(&self) -> Vector3<f64> {
        let flat = &self.frame.flat;
        let forward = flat.last().map_or(0.0, |l| l.x) - flat.first().map_or(0.0, |f| f.x);
        if forward < 0.0 { -self.frame.axes[0] } else { self.frame.axes[0] }
    }

    /// Angle between the two ends of the arc that was covered, rad; more than 2π when it went round.
    fn turned_rad(&self) -> f64 {
        let Some(center) = self.arc.center() else { return 0.0 };
        let angles: Vec<f64> = self.frame.flat.iter().map(|p| (p.y - center.y).atan2(p.x - center.x)).collect();
        let angles = crate::identify::mechanism::path::unwrap(&angles);
        let (low, high) = angles.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), a| (l.min(*a), h.max(*a)));
        high - low
    }

    /// Mean constraint force along the outward normal, and whether the constraint yields to it.
    pub(super) fn add_forces(&self, found: &mut Constraint, points: &[Vector3<f64>], forces: &[Vector3<f64>]) {
        let Some(center) = self.arc.center().map(|c| self.frame.lift(c)) else { return };
        let axis = self.frame.axes[2];
        let outward = |i: usize| {
            let arm = points[i] - center;
            (arm - axis * axis.dot(&arm)).try_normalize(1e-12).unwrap_or_else(Vector3::zeros)
        };
        let normal: Vec<f64> = self.frame.kept.iter().map(|&i| outward(i).dot(&forces[i])).collect();
        found.constraint_force_n = Some(normal.iter().sum::<f64>() / normal.len() as f64);
        let deviation: Vec<f64> = self.frame.flat.iter().map(|p| self.arc.distance(*p)).collect();
        let hand = Manipulator { stiffness_n_m: RIGID_N_M, give_m_n: (0.0, 0.0) };
        (found.rigid, found.yielding) = yielding(&deviation, &normal, &hand);
    }
}
