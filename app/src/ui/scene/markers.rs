//! Detected constraints as marks in the picture.

use super::path_extent::bounds;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use estimator::estimate::{Constraint, ConstraintKind};
use haptics::Vec2;
use haptics::world::Guide;
use render::ConstraintMarker;

/// Half axes of an ellipse that holds 95 % of a normal distribution in the plane, in standard errors: √χ²₂(0.95).
const ELLIPSE_95: f64 = 2.4477;
/// Minimum longer half-axis of an error ellipse, as a share of the radius; smaller ones are magnified by a round
/// factor.
const SEEN: f64 = 0.16;
/// Number of positions between two control points of a guide.
const PIECES: usize = 12;

/// A constraint of the shown recording, with its mark.
pub struct Marked<'a> {
    /// Detected constraint.
    pub constraint: &'a Constraint,
    /// Mark of the constraint; `None` if it is not drawn.
    pub marker: Option<ConstraintMarker>,
    /// Magnification of its drawn error.
    pub magnified: f64,
}

/// Constraints of the fit that belong to a recording.
pub fn of<'a>(document: &'a Document, calibration: &'a Calibration, prepared: &Prepared) -> Vec<Marked<'a>> {
    let Some(analysis) = &calibration.analysis else { return Vec::new() };
    let of_this = |c: &&Constraint| {
        document.recordings.len() < 2 || c.recording.as_deref().is_none_or(|name| names(prepared, name))
    };
    analysis.fit.constraints.iter().filter(of_this).map(|c| marked(c, prepared)).collect()
}

fn names(prepared: &Prepared, name: &str) -> bool {
    prepared.recording.name == name || prepared.recording.trial.as_deref() == Some(name)
}

fn planar(v: &[f64]) -> Option<Vec2> {
    (v.len() >= 2).then(|| Vec2::new(v[0], v[1]))
}

/// Standard error of a value of the constraint, m; 0 where none is known.
pub fn error_of(constraint: &Constraint, name: &str) -> f64 {
    constraint.std_error.get(name).copied().unwrap_or(0.0)
}

fn marked<'a>(constraint: &'a Constraint, prepared: &Prepared) -> Marked<'a> {
    let mut magnified = 1.0;
    let marker = match constraint.kind {
        ConstraintKind::Revolute => revolute(constraint, prepared, &mut magnified),
        ConstraintKind::Prismatic => prismatic(constraint, prepared),
        ConstraintKind::Spline => path(constraint),
        ConstraintKind::Unilateral => surface(constraint),
        _ => None,
    };
    Marked { constraint, marker, magnified }
}

fn revolute(constraint: &Constraint, prepared: &Prepared, magnified: &mut f64) -> Option<ConstraintMarker> {
    let (center_m, radius_m) = (planar(constraint.center_m.as_ref()?)?, constraint.radius_m?);
    let points: Vec<Vec2> = prepared.path_samples.iter().filter_map(|i| prepared.point_at(*i)).collect();
    let largest = ELLIPSE_95 * error_of(constraint, "center_m");
    if largest > 0.0 {
        *magnified = round_factor(SEEN * radius_m / largest);
    }
    let center_axes_m = error_axes(&points, center_m).map(|axis| axis * largest * *magnified);
    Some(ConstraintMarker::Revolute { center_m, radius_m, center_axes_m })
}

/// Largest number of the series 1, 2, 5, 10, 20 … that does not exceed `most`; at least 1.
fn round_factor(most: f64) -> f64 {
    let decade = 10_f64.powf(most.max(1.0).log10().floor());
    [5.0, 2.0, 1.0].map(|step| step * decade).into_iter().find(|f| *f <= most).unwrap_or(1.0)
}

/// Directions of the half-axes of the centre's error ellipse, the longer one of length 1. The accuracy of a circle's
/// centre in each direction follows from the covered arc, whatever the noise (normal equations of centre and radius,
/// with the radius eliminated).
fn error_axes(points: &[Vec2], center: Vec2) -> [Vec2; 2] {
    let outwards = || points.iter().filter_map(|point| (point - center).try_normalize(1e-12));
    let n = outwards().count().max(1) as f64;
    let mean: Vec2 = outwards().sum::<Vec2>() / n;
    let [xx, xy, yy] = outwards()
        .map(|out| out - mean)
        .fold([0.0; 3], |[xx, xy, yy], d| [xx + d.x * d.x, xy + d.x * d.y, yy + d.y * d.y]);
    // The direction that the arc determines best; the error is largest perpendicular to it.
    let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
    let (middle, spread) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
    let share = ((middle - spread).max(0.0) / (middle + spread)).sqrt();
    let share = if share.is_finite() { share } else { 1.0 };
    [Vec2::new(-sin, cos), Vec2::new(cos, sin) * share]
}

fn prismatic(constraint: &Constraint, prepared: &Prepared) -> Option<ConstraintMarker> {
    let (low, high) = bounds(prepared)?;
    Some(ConstraintMarker::Prismatic {
        origin_m: 0.5 * (low + high),
        direction: planar(constraint.direction.as_ref()?)?,
        length_m: constraint.coverage_m.unwrap_or((high - low).norm()).min(1.2 * (high - low).norm()),
        std_m: constraint.residual_m.unwrap_or(0.0),
    })
}

fn path(constraint: &Constraint) -> Option<ConstraintMarker> {
    let found = constraint.guide.as_ref()?;
    let points_m = found.points_m.iter().map(|p| planar(p)).collect::<Option<Vec<_>>>()?;
    let guide = Guide { points_m, closed: found.closed, stiffness_n_m: 0.0, damping_n_s_m: 0.0, friction_n: 0.0 };
    let places = PIECES * guide.pieces();
    let at = |k: usize| guide.point(k as f64 / PIECES as f64).0;
    (places > 0).then(|| ConstraintMarker::Path { points_m: (0..=places).map(at).collect() })
}

fn surface(constraint: &Constraint) -> Option<ConstraintMarker> {
    let touched = constraint.surface.as_ref()?;
    Some(ConstraintMarker::Surface {
        ends_m: [planar(&touched.touched_from_m)?, planar(&touched.touched_to_m)?],
        normal: planar(&touched.normal)?,
        std_m: touched.offset_std_error_m,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arc(from: f64, to: f64) -> Vec<Vec2> {
        (0..200)
            .map(|i| {
                let turn = from + (to - from) * f64::from(i) / 199.0;
                0.02 * Vec2::new(turn.cos(), turn.sin())
            })
            .collect()
    }

    #[test]
    fn a_whole_turn_knows_the_centre_alike_in_all_directions() {
        let [long, short] = error_axes(&arc(0.0, std::f64::consts::TAU), Vec2::zeros());
        assert!((long.norm() - 1.0).abs() < 1e-9 && short.norm() > 0.95);
    }

    #[test]
    fn a_short_arc_leaves_the_centre_open_along_its_middle() {
        let middle = 0.7_f64;
        let [long, short] = error_axes(&arc(middle - 0.3, middle + 0.3), Vec2::zeros());
        let along = Vec2::new(middle.cos(), middle.sin());
        assert!(long.dot(&along).abs() > 0.99 && long.dot(&short).abs() < 1e-9 && short.norm() < 0.3, "{long} {short}");
    }

    #[test]
    fn factors_are_round() {
        let found = [0.3, 1.0, 3.9, 7.0, 19.0, 1200.0].map(round_factor);
        assert_eq!(found, [1.0, 1.0, 2.0, 5.0, 10.0, 1000.0]);
    }

    #[test]
    fn without_points_it_is_round() {
        let [long, short] = error_axes(&[], Vec2::zeros());
        assert_eq!((long.norm(), short.norm()), (1.0, 1.0));
    }
}
