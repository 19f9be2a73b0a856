//! Force vectors along the path: the force of the hand (thesis, figure 5.10), and the part of it that only a constraint
//! explains (figure 5.12).

use super::path_extent::window;
use crate::ui::calibrate::state::Calibration;
use crate::ui::document::prepared::Prepared;
use crate::ui::document::state::Document;
use crate::ui::session::Session;
use haptics::Vec2;
use render::{ColorRole, ConstraintMarker, ForceVector};

/// Number of force vectors drawn along a path.
const VECTORS: usize = 48;

/// Net force of the hand, at even intervals.
pub fn net(document: &Document, prepared: &Prepared) -> Vec<ForceVector> {
    let vector = |i: usize| {
        Some(ForceVector { at_m: prepared.point_at(i)?, force_n: prepared.force_at(i)?, role: ColorRole::Measured })
    };
    thinned(document, prepared).into_iter().filter_map(vector).collect()
}

/// Residual of the net force after weight and friction. With a known constraint it is the part perpendicular to the
/// motion, minus that of the weight (thesis, eq. 5.1); otherwise it is the residual of the replay in the fitted world.
pub fn unexplained(session: &Session, prepared: &Prepared, marker: Option<&ConstraintMarker>) -> Vec<ForceVector> {
    let weight_n = session.calibration.analysis.as_ref().and_then(|a| a.fit.value("crank", "weight_N")).unwrap_or(0.0);
    let vector = |i: usize| {
        let (at_m, force) = (prepared.point_at(i)?, prepared.force_at(i)?);
        let force_n = match marker.and_then(|marker| normal_at(marker, at_m)) {
            Some(normal) => normal * normal.dot(&(force - Vec2::new(0.0, weight_n))),
            None => force - predicted(session, i)?,
        };
        Some(ForceVector { at_m, force_n, role: ColorRole::Constraint })
    };
    thinned(&session.document, prepared).into_iter().filter_map(vector).collect()
}

fn thinned(document: &Document, prepared: &Prepared) -> Vec<usize> {
    let samples = window(document, prepared);
    let every = samples.len().div_ceil(VECTORS).max(1);
    samples.into_iter().step_by(every).collect()
}

/// Unit vector perpendicular to the motion that a constraint allows.
fn normal_at(marker: &ConstraintMarker, at: Vec2) -> Option<Vec2> {
    let across = |v: Vec2| Vec2::new(-v.y, v.x);
    let direction = match marker {
        ConstraintMarker::Revolute { center_m, .. } => at - center_m,
        ConstraintMarker::Prismatic { direction, .. } => across(*direction),
        ConstraintMarker::Surface { normal, .. } => *normal,
        ConstraintMarker::Path { points_m } => {
            let apart = |pair: &[Vec2]| (0.5 * (pair[0] + pair[1]) - at).norm_squared();
            let nearest = points_m.windows(2).min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
            across(nearest[1] - nearest[0])
        }
    };
    direction.try_normalize(1e-12)
}

/// Simulated force at a sample: both fingers together, or the tool.
fn predicted(session: &Session, sample: usize) -> Option<Vec2> {
    let fingers = tips(session, sample);
    let one = || {
        Some(Vec2::new(
            channel(&session.document, &session.calibration, "fx_N", sample)?,
            channel(&session.document, &session.calibration, "fy_N", sample)?,
        ))
    };
    fingers.map(|[a, b]| a + b).or_else(one)
}

/// Simulated force of each finger at a sample, N.
pub fn tips(session: &Session, sample: usize) -> Option<[Vec2; 2]> {
    let of = |x: &str, y: &str| {
        Some(Vec2::new(
            channel(&session.document, &session.calibration, x, sample)?,
            channel(&session.document, &session.calibration, y, sample)?,
        ))
    };
    Some([of("fx1_N", "fy1_N")?, of("fx2_N", "fy2_N")?])
}

fn channel(document: &Document, calibration: &Calibration, name: &str, sample: usize) -> Option<f64> {
    let simulation = calibration.replay(document.current)?.simulation.as_ref()?;
    simulation.predicted.iter().find(|c| c.name == name)?.values.get(sample).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn across_a_circle_is_along_its_radius_and_across_a_line_is_square_to_it() {
        let center_m = Vec2::new(0.01, 0.02);
        let circle = ConstraintMarker::Revolute { center_m, radius_m: 0.02, center_axes_m: [Vec2::zeros(); 2] };
        let found = normal_at(&circle, center_m + Vec2::new(0.0, 0.5)).expect("off the centre");
        assert!((found - Vec2::new(0.0, 1.0)).norm() < 1e-12);
        assert_eq!(normal_at(&circle, center_m), None);
        let direction = Vec2::new(3.0, 4.0);
        let line = ConstraintMarker::Prismatic { origin_m: center_m, direction, length_m: 0.1, std_m: 0.0 };
        assert!(normal_at(&line, center_m).expect("a line").dot(&direction).abs() < 1e-12);
        let bent = vec![Vec2::zeros(), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0)];
        let path = ConstraintMarker::Path { points_m: bent };
        assert!(normal_at(&path, Vec2::new(0.4, 0.1)).expect("a path").x.abs() < 1e-12);
        assert!(normal_at(&path, Vec2::new(1.1, 0.6)).expect("a path").y.abs() < 1e-12);
    }
}
