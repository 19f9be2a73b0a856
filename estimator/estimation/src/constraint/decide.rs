//! Decision about the kind of constraint that a path shows.

mod odds;
mod report;
mod shape;

use super::circle::{Arc, cost, fit, refine};
use super::context::Context;
use super::existence::sentence;
use super::frame::Frame;
use super::guided;
use super::noise::{Direction, PathNoise, sensitivity};
use super::normals::{THESIS_SAMPLES, normals_center};
use super::retrace::Retrace;
use super::screw::{self, Helix};
use super::surface::{self, Pressed};
use super::whole::rests_at_both_ends;
use foundation::estimate::{Constraint, ConstraintKind};
use nalgebra::Vector3;
use shape::{HINGE_M, Shape};

/// Fewer samples show less surely that a motion begins and ends at rest.
const FEW_SAMPLES: usize = 100;
/// Kept points below which nothing is said.
const MIN_POINTS: usize = 8;
/// The kinds are decided at this level of error, the interval is given at 5 %.
const DECISION_P: f64 = 0.01;
const INTERVAL_P: f64 = 0.05;
/// Largest distance from line and plane of a path that may follow them, as a share of the extent.
const CLOSE_SHARE: f64 = 0.025;
/// Distance from line and plane above which it certainly does not follow them, as a share of the extent.
const FAR_SHARE: f64 = 0.04;
/// Width of a path in its plane as a share of its length from which on it fills a region.
const REGION_SHARE: f64 = 0.15;
/// Least ratio of the common part of passes to their difference for a guide, to be told from noise with a memory.
const GUIDE_RATIO: f64 = 3.0;
/// The same ratio to put a circle in doubt.
const SYSTEMATIC_RATIO: f64 = 1.5;
/// Least distance of the common part from the best circle, as a share of the extent.
const GUIDE_SHARE: f64 = 4e-3;
/// Least share of the points over which it is so; `GUIDE_ALONG_CROSSING`: the same for a path that crosses itself as
/// well.
const GUIDE_ALONG: f64 = 0.3;
const GUIDE_ALONG_CROSSING: f64 = 0.6;
/// Passes along one guide lie this close to each other, as a share of the extent.
const SAME_SHARE: f64 = 0.012;
/// Largest distance of a compact path from the recorded one, in multiples of its noise, or as a share of its extent.
const COMPACT_NOISES: f64 = 1.2;
const COMPACT_SHARE: f64 = 2e-3;
/// A path in space that leaves its plane by more than this share of its extent is not called flat.
const PLANE_SHARE: f64 = 0.01;
/// A pitch counts from this many standard errors on.
const SCREW_ERRORS: f64 = 5.0;
/// A constrained grip may leave its path by this much, m: less is no sign of freedom.
const GRIP_SLIP_M: f64 = 2.5e-3;
/// Stiffness of an unknown hand, N/m: a path as stiff as this counts as rigid.
const RIGID_N_M: f64 = 2000.0;

/// Decides between revolute, prismatic, free and undecided.
///
/// `points`: tool positions in order of time, m (no clock needed); `forces`: force of the tool on the environment, N, same
/// length. Distances are taken along the path, so dwelling does not count.
pub fn detect(points: &[Vector3<f64>], forces: Option<&[Vector3<f64>]>, context: &Context) -> Constraint {
    let pressed = forces.map(|forces| {
        let time_s = context.time_s.as_deref();
        surface::find(&Pressed { points, forces, time_s, planar: context.planar }, context.recording.clone())
    });
    if let Some(Some(found)) = pressed {
        return found;
    }
    let finite = points.iter().all(|p| p.iter().all(|v| v.is_finite()));
    let frame = if finite { Frame::new(points, context.planar) } else { None };
    let Some(frame) = frame else { return blank(context, "the tool does not move, so no constraint can be seen") };
    if frame.flat.len() < MIN_POINTS {
        let text = format!("only {} distinct points of a path; {MIN_POINTS} are needed", frame.flat.len());
        return blank(context, &text);
    }
    let Some(shape) = Shape::new(frame, points) else {
        return blank(context, "the path is too short against its noise");
    };
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
    fn new(frame: Frame, points: &[Vector3<f64>]) -> Option<Self> {
        let extent = frame.extent_m;
        let (arc, best) = fit(&frame.flat, extent);
        let noise = PathNoise::new(&frame.flat, &arc, extent, Direction::Curvature)?;
        let turn = PathNoise::new(&frame.flat, &arc, extent, Direction::Angle)?;
        let size = sensitivity(&frame.flat, &arc, extent, Direction::Curvature);
        let bounds = |p: f64| profile(&frame, &arc, best, noise.quantile(p), size);
        let retrace = Retrace::of(&frame, &arc);
        Some(Self {
            whole: rests_at_both_ends(points) || retrace.along_share > GUIDE_ALONG,
            few: points.len() < FEW_SAMPLES,
            interval: bounds(INTERVAL_P),
            decision_low: bounds(DECISION_P).0,
            straight_probability: odds::straight_probability(&noise, arc.curvature, size, extent),
            curvature_error: noise.quantile(0.317) / size,
            angle_error: turn.quantile(0.317) / sensitivity(&frame.flat, &arc, extent, Direction::Angle),
            retrace,
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
        let round = self.is_round();
        if round && self.systematic() {
            let text = format!("the passes stray from the circle at the same places: {sizes}; it may be another curve");
            return (ConstraintKind::Undecided, text);
        }
        if round {
            return (
                ConstraintKind::Revolute,
                format!(
                    "a circle fits and a line does not: {sizes}; the line's probability is {:.3}{}",
                    self.straight_probability,
                    self.thesis_center()
                ),
            );
        }
        if self.is_straight() {
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

    /// Says so if the path follows one guide more than once that is neither a line nor a circle. The common part of its
    /// passes is then far from the best circle, and far larger than their difference.
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

    /// True if the common part of the passes is not noise.
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
        // Close in by halving.
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
