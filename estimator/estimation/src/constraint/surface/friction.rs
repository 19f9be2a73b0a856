//! Friction on the surface: force along it where the tool slides, over the push.

use super::fit::Plane;
use super::split::{Pressed, Split};
use crate::regression::linear::least_squares;
use nalgebra::Vector3;

/// Slower than this share of the usual speed along the surface it may stick.
const SLIDING_SHARE: f64 = 0.4;
/// Fewer rows tell nothing.
const LEAST_ROWS: usize = 20;
/// Model error of Coulomb's law for a compliant contact, as a share of the coefficient.
const MODEL_SHARE: f64 = 0.02;
/// Half of the chord for direction and speed, as a share of the samples, and a least number of samples.
const CHORD_SHARE: f64 = 0.005;
const CHORD_LEAST: usize = 3;

/// Coulomb's coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rubbing {
    /// Force along the surface over the push.
    pub coefficient: f64,
    /// Its standard error.
    pub std_error: f64,
}

/// From both directions of sliding if there are two: the part that does not turn with the motion belongs to the slant.
pub(super) fn rubbing(pressed: &Pressed<'_>, split: &Split, plane: &Plane) -> Option<Rubbing> {
    let n = pressed.points.len();
    let half = ((CHORD_SHARE * n as f64) as usize).max(CHORD_LEAST);
    let flat = |v: Vector3<f64>| v - plane.normal * plane.normal.dot(&v);
    let moved = |i: usize| flat(pressed.points[i + half] - pressed.points[i - half]);
    let inside: Vec<usize> =
        (half..n.saturating_sub(half)).filter(|&i| (i - half..=i + half).all(|k| split.contact[k])).collect();
    let mut speeds: Vec<f64> = inside.iter().map(|&i| moved(i).norm()).collect();
    speeds.sort_by(f64::total_cmp);
    let usual = *speeds.get(speeds.len() * 3 / 4)?;
    if usual < 8.0 * split.position_noise_m {
        return None;
    }
    let rows: Vec<usize> = inside.into_iter().filter(|&i| moved(i).norm() > SLIDING_SHARE * usual).collect();
    if rows.len() < LEAST_ROWS {
        return None;
    }
    // Within a chord all samples say the same.
    let rows: Vec<usize> = rows.iter().copied().step_by((rows.len() / 400).max(1)).collect();
    let push = |i: usize| -plane.normal.dot(&split.force[i]);
    let way = |i: usize| moved(i).normalize();
    let turning: Vec<f64> = rows.iter().map(|&i| push(i)).collect();
    let along: Vec<f64> = rows.iter().map(|&i| way(i).dot(&split.force[i])).collect();
    let fixed: Vec<f64> = rows.iter().map(|&i| push(i) * way(i).dot(&plane.along)).collect();
    let forth = rows.iter().filter(|&&i| way(i).dot(&plane.along) > 0.0).count();
    let reverses = forth > LEAST_ROWS / 2 && rows.len() - forth > LEAST_ROWS / 2;
    let columns = if reverses { vec![turning, fixed] } else { vec![turning] };
    let fit = least_squares(&columns, &along, None).ok()?;
    let model = MODEL_SHARE * fit.values[0];
    // Without a reversal the slant's error goes into the coefficient, radian for unit.
    let slant = if reverses { 0.0 } else { plane.tilt_error_rad };
    fit.identified[0]
        .then(|| Rubbing { coefficient: fit.values[0], std_error: fit.std_errors[0].hypot(slant).hypot(model) })
}
