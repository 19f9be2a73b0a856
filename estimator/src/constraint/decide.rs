//! Which kind of constraint a path shows.

use super::circle::{Arc, cost, fit, refine};
use super::existence::sentence;
use super::frame::Frame;
use super::guided;
use super::noise::{Direction, PathNoise, sensitivity};
use super::normals::{THESIS_SAMPLES, normals_center};
use super::retrace::Retrace;
use super::screw::{self, Helix};
use super::spline;
use super::yielding::{Manipulator, yielding};
use crate::estimate::{Constraint, ConstraintKind, Guide, Leaning};
use nalgebra::Vector3;

/// Kept points below which nothing is said.
const MIN_POINTS: usize = 8;
/// The kinds are decided at this level of error, the interval is given at 5 %.
const DECISION_P: f64 = 0.01;
const INTERVAL_P: f64 = 0.05;
/// Posterior probability from which on a path is called straight.
const STRAIGHT_PROBABILITY: f64 = 0.92;
/// … and below which, or where the interval leaves no doubt, it is called round.
const ROUND_PROBABILITY: f64 = 0.02;
/// … provided that it bends by no more than this over its length with 95 % certainty, rad.
const STRAIGHT_RAD: f64 = 0.5;
/// Hinges within reach lie this far away, m: their radii are taken as equally likely in logarithm …
const HINGE_M: (f64, f64) = (0.03, 2.0);
/// … as far as the path turns about them by at least this, rad (5°): who records a hinge moves it.
const HINGE_TURN_RAD: f64 = 0.087;
/// A path that bends by more than this, with certainty, is round whatever was thought before, rad.
const ROUND_RAD: f64 = 0.15;
/// Distance from line and plane, as a share of the extent, up to which a path is still one.
const CLOSE_SHARE: f64 = 0.025;
/// … and from which on it is certainly none.
const FAR_SHARE: f64 = 0.04;
/// Width of a path in its plane as a share of its length from which on it fills a region.
const REGION_SHARE: f64 = 0.15;
/// Passes must share this many times what they differ by to be told from noise that remembers …
const GUIDE_RATIO: f64 = 3.0;
/// … or this many times to put a circle in doubt, …
const SYSTEMATIC_RATIO: f64 = 1.5;
/// … and lie this share of the extent away from the best circle, …
const GUIDE_SHARE: f64 = 4e-3;
/// … over this share of the points, or over this share where the path crosses itself as well.
const GUIDE_ALONG: f64 = 0.3;
const GUIDE_ALONG_CROSSING: f64 = 0.6;
/// Passes along one guide lie this close to each other, as a share of the extent.
const SAME_SHARE: f64 = 0.012;
/// A compact path may miss the recorded one by so many times its noise, or by this share of its extent.
const COMPACT_NOISES: f64 = 1.2;
const COMPACT_SHARE: f64 = 2e-3;
/// A path in space that leaves its plane by more than this share of its extent is not called flat.
const PLANE_SHARE: f64 = 0.01;
/// A pitch counts from this many standard errors on.
const SCREW_ERRORS: f64 = 5.0;
/// A constrained grip may leave its path by this much, m: less is no sign of freedom.
const GRIP_SLIP_M: f64 = 2.5e-3;
/// Stiffness of a hand of which nothing is known, N/m: what is as stiff counts as rigid.
const RIGID_N_M: f64 = 2000.0;

/// What is known about a path beside its points.
#[derive(Clone, Debug, Default)]
pub struct Context {
    /// Name of the recording or trial.
    pub recording: Option<String>,
    /// The path lies in the x-y plane by construction.
    pub planar: bool,
    /// Sample times, s, one a point: inertia can then be told from constraint forces.
    pub time_s: Option<Vec<f64>>,
    /// Unit vector upwards; zero in a level plane.
    pub up: Vector3<f64>,
}

/// Everything measured about the path's shape.
struct Shape {
    frame: Frame,
    arc: Arc,
    retrace: Retrace,
    rms_m: f64,
    /// Curvature interval at 5 %, 1/m, and lower end at the decision level.
    interval: (f64, f64),
    decision_low: f64,
    /// Probability of a straight line against a circle, even odds before.
    straight_probability: f64,
    curvature_error: f64,
    angle_error: f64,
}

/// Decides between revolute, prismatic, free and undecided.
///
/// `points`: tool positions in order of time, m (no clock needed); `forces`: force of the tool on the environment, N, same
/// length. Distances are taken along the path, so dwelling does not count.
pub fn detect(points: &[Vector3<f64>], forces: Option<&[Vector3<f64>]>, context: &Context) -> Constraint {
    let finite = points.iter().all(|p| p.iter().all(|v| v.is_finite()));
    let frame = if finite { Frame::new(points, context.planar) } else { None };
    let Some(frame) = frame else { return blank(context, "the tool does not move, so no constraint can be seen") };
    if frame.flat.len() < MIN_POINTS {
        let text = format!("only {} distinct points of a path; {MIN_POINTS} are needed", frame.flat.len());
        return blank(context, &text);
    }
    let Some(shape) = Shape::new(frame) else { return blank(context, "the path is too short against its noise") };
    let (mut kind, mut evidence) = shape.kind();
    let forces = forces.filter(|f| f.len() == points.len());
    let held = forces.and_then(|f| guided::existence_of(&shape.frame, points, f, context));
    if let (Some((tested, _)), true) = (&held, kind == ConstraintKind::Undecided && shape.is_neither()) {
        kind = match tested.exists {
            Some(true) => ConstraintKind::Spline,
            Some(false) => ConstraintKind::Free,
            None => kind,
        };
        evidence = format!("{}; {evidence}", sentence(tested));
    }
    let winding = if context.planar || kind == ConstraintKind::Prismatic { None } else { shape.winds() };
    if let Some(helix) = &winding {
        kind = ConstraintKind::Screw;
        evidence.clone_from(&helix.1);
    }
    let mut found = blank(context, &evidence);
    found.kind = kind;
    shape.describe(&mut found, context.planar);
    found.screw = guided::screw_of(&found, winding.as_ref().map(|w| &w.0));
    if let Some((helix, _)) = &winding {
        guided::describe(&mut found, helix);
    }
    if let Some((existence, sided)) = held {
        (found.existence, found.sided) = (Some(existence), sided);
    }
    if let Some(forces) = forces.filter(|_| kind == ConstraintKind::Revolute) {
        shape.add_forces(&mut found, points, forces);
    }
    found
}

fn blank(context: &Context, evidence: &str) -> Constraint {
    Constraint::blank(context.recording.clone(), evidence)
}

impl Shape {
    fn new(frame: Frame) -> Option<Self> {
        let extent = frame.extent_m;
        let (arc, best) = fit(&frame.flat, extent);
        let noise = PathNoise::new(&frame.flat, &arc, extent, Direction::Curvature)?;
        let turn = PathNoise::new(&frame.flat, &arc, extent, Direction::Angle)?;
        let size = sensitivity(&frame.flat, &arc, extent, Direction::Curvature);
        let bounds = |p: f64| profile(&frame, &arc, best, noise.quantile(p), size);
        Some(Self {
            interval: bounds(INTERVAL_P),
            decision_low: bounds(DECISION_P).0,
            straight_probability: straight_probability(&noise, arc.curvature, size, extent),
            curvature_error: noise.quantile(0.317) / size,
            angle_error: turn.quantile(0.317) / sensitivity(&frame.flat, &arc, extent, Direction::Angle),
            retrace: Retrace::of(&frame, &arc),
            rms_m: (best / frame.flat.len() as f64).sqrt(),
            arc,
            frame,
        })
    }

    /// Root mean square distance from the fitted circle in space, m.
    fn residual_m(&self) -> f64 {
        self.rms_m.hypot(self.frame.plane_rms_m)
    }

    fn kind(&self) -> (ConstraintKind, String) {
        let extent = self.frame.extent_m;
        let share = self.residual_m() / extent;
        let bend = |curvature: f64| curvature * extent;
        let low = self.decision_low;
        let sizes = format!(
            "{:.1} mm from a circle, {:.1} mm from a line over {:.0} mm",
            1e3 * self.residual_m(),
            1e3 * self.frame.line_rms_m,
            1e3 * extent
        );
        let real = self.residual_m() > (4.0 * self.frame.noise_m).max(GRIP_SLIP_M);
        let wide = real && share > FAR_SHARE && self.frame.width_m > REGION_SHARE * extent;
        if let Some(text) = self.guide(&sizes) {
            return (ConstraintKind::Spline, text);
        }
        if wide && self.retrace.crossings > 0 {
            let text = format!("the path crosses itself {} times: {sizes} (root mean square)", self.retrace.crossings);
            return (ConstraintKind::Free, text);
        }
        if share > CLOSE_SHARE {
            let text = format!(
                "neither a line nor a circle fits ({sizes}); a free hand and a guide of another shape look alike: follow the path \
                 there and back"
            );
            return (ConstraintKind::Undecided, text);
        }
        let within_reach = 1.0 / self.arc.curvature < HINGE_M.1 * 1.25;
        let certain = bend(low) > ROUND_RAD && 1.0 / low < HINGE_M.1 * 1.25 && self.rms_m < 0.5 * self.frame.line_rms_m;
        let round = certain || (self.straight_probability < ROUND_PROBABILITY && within_reach);
        if round && self.systematic() {
            let text = format!("the passes stray from the circle at the same places: {sizes}; it may be another curve");
            return (ConstraintKind::Undecided, text);
        }
        if round {
            return (
                ConstraintKind::Revolute,
                format!("a circle fits and a line does not: {sizes}{}", self.thesis_center()),
            );
        }
        if self.straight_probability > STRAIGHT_PROBABILITY && bend(self.interval.1) < STRAIGHT_RAD {
            let text = format!(
                "a line fits: {sizes}; against all hinges within {:.0} m its probability is {:.3}",
                HINGE_M.1, self.straight_probability
            );
            return (ConstraintKind::Prismatic, text);
        }
        let text = format!(
            "a line and an arc of radius from {:.2} m fit alike ({sizes}); follow the mechanism further",
            1.0 / self.interval.1.max(f64::MIN_POSITIVE)
        );
        (ConstraintKind::Undecided, text)
    }

    /// Says so when the path follows one guide more than once that is neither a line nor a circle: what its passes have in common
    /// is far from the best circle, and far more than what they differ by.
    fn guide(&self, sizes: &str) -> Option<String> {
        let found = &self.retrace;
        let same = found.apart_m < (SAME_SHARE * self.frame.extent_m).max(4.0 * self.frame.noise_m);
        // A hand that wanders long enough goes along its own way here and there.
        let enough = if found.crossings > 0 { GUIDE_ALONG_CROSSING } else { GUIDE_ALONG };
        let other_shape = found.common_m > GUIDE_RATIO * found.differing_m
            && found.common_m > GUIDE_SHARE * self.frame.extent_m
            && found.common_m > 2.0 * self.frame.noise_m / (found.along_share * self.frame.flat.len() as f64).sqrt();
        (found.along_share > enough && same && other_shape).then(|| {
            format!(
                "the path is followed again within {:.2} mm over {:.0} % of its points, and is neither a line nor a circle: {sizes}",
                1e3 * found.apart_m,
                100.0 * found.along_share
            )
        })
    }

    /// Neither a line nor a circle.
    fn is_neither(&self) -> bool {
        self.residual_m() > CLOSE_SHARE * self.frame.extent_m
    }

    /// Out of the plane by more than noise and grip.
    fn leaves_plane(&self) -> bool {
        self.frame.plane_rms_m > (4.0 * self.frame.noise_m).max(PLANE_SHARE * self.frame.extent_m)
    }

    /// A screw that fits where the plane does not.
    fn winds(&self) -> Option<(Helix, String)> {
        let helix = self.leaves_plane().then(|| screw::fit(&self.frame.space))??;
        let certain = helix.pitch_m_rad.abs() > SCREW_ERRORS * helix.pitch_error;
        let fits = helix.rms_m < CLOSE_SHARE * self.frame.extent_m && helix.rms_m < 0.4 * self.residual_m();
        let text = format!(
            "a screw fits within {:.1} mm (root mean square) over {:.2} turns, the best circle in a plane within {:.1} mm",
            1e3 * helix.rms_m,
            helix.turned_rad / std::f64::consts::TAU,
            1e3 * self.residual_m()
        );
        (certain && fits && helix.radius_m < HINGE_M.1).then_some((helix, text))
    }

    /// What the passes have in common is not noise.
    fn systematic(&self) -> bool {
        let found = &self.retrace;
        found.along_share > GUIDE_ALONG
            && found.common_m > SYSTEMATIC_RATIO * found.differing_m
            && found.common_m > GUIDE_SHARE * self.frame.extent_m
    }

    /// The centre by the thesis's method, as a cross-check.
    fn thesis_center(&self) -> String {
        let (Some(found), Some(center)) = (normals_center(&self.frame.flat, THESIS_SAMPLES), self.arc.center()) else {
            return String::new();
        };
        format!(
            "; the normals over {THESIS_SAMPLES} samples meet {:.1} mm from its centre",
            1e3 * (found - center).norm()
        )
    }

    fn describe(&self, found: &mut Constraint, planar: bool) {
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
    fn add_forces(&self, found: &mut Constraint, points: &[Vector3<f64>], forces: &[Vector3<f64>]) {
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

/// Probability of curvature 0 against curvatures of hinges within reach, bending either way, even odds before.
fn straight_probability(noise: &PathNoise, curvature: f64, size: f64, extent_m: f64) -> f64 {
    let likelihood = |k: f64| noise.density((curvature - k) * size);
    let steps = 200;
    // No circle is shorter across than the path that lies on it.
    let nearest = HINGE_M.0.max(0.5 * extent_m);
    let ratio = (HINGE_M.1.min(extent_m / HINGE_TURN_RAD) / nearest).max(1.0);
    let round: f64 = (0..steps)
        .map(|i| 1.0 / (nearest * ratio.powf((f64::from(i) + 0.5) / f64::from(steps))))
        .map(|k| 0.5 * (likelihood(k) + likelihood(-k)))
        .sum::<f64>()
        / f64::from(steps);
    let line = likelihood(0.0);
    if line + round > 0.0 { line / (line + round) } else { 0.5 }
}

/// Curvatures whose best arcs exceed the best fit by less than `amplitude`²: the interval, asymmetric where the geometry is.
fn profile(frame: &Frame, arc: &Arc, best: f64, amplitude: f64, size: f64) -> (f64, f64) {
    let linear = amplitude / size.max(f64::MIN_POSITIVE);
    let bound = |side: f64| {
        let (mut inner, mut outer) = (*arc, *arc);
        let mut step = 0.5 * linear;
        // Grow until the fit is worse than the noise allows …
        for _ in 0..40 {
            let start = Arc { curvature: inner.curvature + side * step, ..inner };
            let (trial, trial_cost) = refine(&frame.flat, start, true, frame.extent_m);
            outer = trial;
            if trial_cost - best > amplitude * amplitude {
                break;
            }
            inner = trial;
            step *= 1.3;
        }
        // … and close in.
        for _ in 0..30 {
            let middle = Arc { curvature: 0.5 * (inner.curvature + outer.curvature), ..inner };
            let (trial, trial_cost) = refine(&frame.flat, middle, true, frame.extent_m);
            if trial_cost - best > amplitude * amplitude {
                outer = trial;
            } else {
                inner = trial;
            }
            if (outer.curvature - inner.curvature).abs() < 1e-4 * linear {
                break;
            }
        }
        inner.curvature
    };
    debug_assert!(best <= cost(&frame.flat, arc) * (1.0 + 1e-9) + f64::MIN_POSITIVE, "best is the arc's own cost");
    (bound(-1.0), bound(1.0))
}

#[cfg(test)]
mod tests;
