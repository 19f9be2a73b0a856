//! Evidence of forces and screws about a path: a guide, if there is one, and the motion it allows.

use super::context::Context;
use super::existence::{Rows, existence};
use super::frame::Frame;
use super::screw::Helix;
use foundation::estimate::{Constraint, ConstraintKind, Existence, Screw, Sided};
use foundation::signal::derive::savitzky_golay;
use haptics::Vec2;
use nalgebra::Vector3;

/// Half of the window over which motion is smoothed for its acceleration, s.
const HALF_S: f64 = 0.06;
/// Slower than this share of the usual speed, the direction is a guess.
const SLOW_SHARE: f64 = 0.3;
/// Half of the chord for the direction of a path without a clock, kept points.
const CHORD: usize = 3;

/// The test of [`existence`] on a tool's path in its plane, with the clock where there is one.
pub(super) fn existence_of(
    frame: &Frame,
    points: &[Vector3<f64>],
    forces: &[Vector3<f64>],
    context: &Context,
) -> Option<(Existence, Option<Sided>)> {
    let flat = |v: Vector3<f64>| Vec2::new(frame.axes[0].dot(&v), frame.axes[1].dot(&v));
    if forces.iter().any(|f| f.iter().any(|v| !v.is_finite())) {
        return None;
    }
    let rows = match context.time_s.as_deref().filter(|t| t.len() == points.len() && t.len() > 8) {
        Some(time) => {
            timed(time, &points.iter().map(|p| flat(p - frame.origin)).collect::<Vec<_>>(), |i| flat(forces[i]))
        }
        None => timeless(frame, |i| flat(forces[i])),
    };
    existence(&Rows { up: flat(context.up), rubs: true, ..rows })
}

fn timed(time: &[f64], position: &[Vec2], force: impl Fn(usize) -> Vec2) -> Rows {
    let n = time.len();
    let period = (time[n - 1] - time[0]) / (n - 1) as f64;
    let half = ((HALF_S / period).round() as usize).max(3);
    let [x, y] = [0, 1].map(|k| savitzky_golay(time, &position.iter().map(|p| p[k]).collect::<Vec<f64>>(), half, 3));
    let velocity: Vec<Vec2> = x.first.iter().zip(&y.first).map(|(x, y)| Vec2::new(*x, *y)).collect();
    let square: f64 = velocity.iter().map(Vec2::norm_squared).sum::<f64>() / n as f64;
    let inside = (half..n.saturating_sub(half)).step_by(2 * half + 1);
    let picked: Vec<usize> = inside.filter(|&i| velocity[i].norm() > SLOW_SHARE * square.sqrt()).collect();
    let mean = |i: usize| (i - half..=i + half).map(&force).sum::<Vec2>() / (2 * half + 1) as f64;
    Rows {
        velocity: picked.iter().map(|&i| velocity[i]).collect(),
        acceleration: picked.iter().map(|&i| Vec2::new(x.second[i], y.second[i])).collect(),
        force: picked.iter().map(|&i| mean(i)).collect(),
        ..Rows::default()
    }
}

/// Without a clock the motion is taken as slow: no inertia.
fn timeless(frame: &Frame, force: impl Fn(usize) -> Vec2) -> Rows {
    let flat = &frame.flat;
    let picked: Vec<usize> = (CHORD..flat.len().saturating_sub(CHORD)).collect();
    Rows {
        velocity: picked.iter().map(|&i| flat[i + CHORD] - flat[i - CHORD]).collect(),
        acceleration: vec![Vec2::zeros(); picked.len()],
        force: picked.iter().map(|&i| force(frame.kept[i])).collect(),
        ..Rows::default()
    }
}

/// The allowed motion of a hinge, a slide or a screw.
pub(super) fn screw_of(found: &Constraint, helix: Option<&Helix>) -> Option<Screw> {
    let three = |v: &[f64]| -> [f64; 3] { std::array::from_fn(|k| v.get(k).copied().unwrap_or(0.0)) };
    match found.kind {
        ConstraintKind::Screw => helix.map(|h| Screw {
            point_m: h.point.into(),
            axis: h.axis.into(),
            pitch_m_rad: Some(h.pitch_m_rad),
            pitch_std_error: Some(h.pitch_error),
        }),
        ConstraintKind::Revolute => Some(Screw {
            point_m: three(found.center_m.as_ref()?),
            axis: three(found.direction.as_ref()?),
            pitch_m_rad: Some(0.0),
            pitch_std_error: None,
        }),
        ConstraintKind::Prismatic => Some(Screw {
            point_m: [0.0; 3],
            axis: three(found.direction.as_ref()?),
            pitch_m_rad: None,
            pitch_std_error: None,
        }),
        _ => None,
    }
}

/// Numbers of a screw.
pub(super) fn describe(found: &mut Constraint, helix: &Helix) {
    found.center_m = Some(helix.point.iter().copied().collect());
    found.direction = Some(helix.axis.iter().copied().collect());
    found.radius_m = Some(helix.radius_m);
    found.coverage_rad = Some(helix.turned_rad);
    found.residual_m = Some(helix.rms_m);
    found.std_error = [("pitch_m_rad".to_owned(), helix.pitch_error)].into();
}
