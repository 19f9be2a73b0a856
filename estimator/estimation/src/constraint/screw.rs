//! Turning and sliding at once: a path in space that winds about an axis with a constant pitch.
//!
//! Positions alone show a pitch only while they wind; the body's orientation is not needed. All directions of motion
//! make one and the same angle with the axis; axis, centre, radius and pitch are then refined together.

use foundation::cancellation;
use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};

/// A path that winds by less shows no pitch, rad.
const LEAST_TURN_RAD: f64 = 1.5;
/// Gauss–Newton rounds.
const ROUNDS: usize = 40;

/// A fitted screw.
#[derive(Clone, Debug)]
pub struct Helix {
    /// A point of the axis, m.
    pub point: Vector3<f64>,
    /// Unit vector of the axis.
    pub axis: Vector3<f64>,
    /// m.
    pub radius_m: f64,
    /// m/rad, right-handed positive.
    pub pitch_m_rad: f64,
    /// Its standard error, m/rad; the residual counted as if one correlation length were a tenth of the path.
    pub pitch_error: f64,
    /// Angle turned, rad.
    pub turned_rad: f64,
    /// Root mean square distance of the path, m.
    pub rms_m: f64,
}

/// Offset of the axis in its own frame (2), tilt (2), radius, pitch, height.
type Parameters = [f64; 7];

/// The screw through `points` in travelled order; `None` when they do not wind.
pub fn fit(points: &[Vector3<f64>]) -> Option<Helix> {
    if points.len() < 20 {
        return None;
    }
    let lag = (points.len() / 40).max(1);
    let tangents: Vec<Vector3<f64>> =
        (lag..points.len()).filter_map(|i| (points[i] - points[i - lag]).try_normalize(1e-12)).collect();
    let mean = tangents.iter().sum::<Vector3<f64>>() / tangents.len().max(1) as f64;
    let spread: Matrix3<f64> = tangents.iter().map(|t| (t - mean) * (t - mean).transpose()).sum();
    let eigen = SymmetricEigen::new(spread);
    let least = (0..3).min_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]))?;
    let axis: Vector3<f64> = eigen.eigenvectors.column(least).into_owned();
    refine(points, axis)
}

/// Two unit vectors across an axis.
fn across(axis: Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
    let helper = if axis.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
    let u = axis.cross(&helper).normalize();
    (u, axis.cross(&u))
}

struct Windings {
    middle: Vector3<f64>,
    axis: Vector3<f64>,
    u: Vector3<f64>,
    v: Vector3<f64>,
}

impl Windings {
    fn axis_of(&self, p: &Parameters) -> (Vector3<f64>, Vector3<f64>) {
        let axis = (self.axis + self.u * p[2] + self.v * p[3]).normalize();
        (axis, self.middle + self.u * p[0] + self.v * p[1])
    }

    /// Angles about the axis, continuous, and (distance, height) of each point.
    fn seen(&self, points: &[Vector3<f64>], p: &Parameters) -> (Vec<f64>, Vec<(f64, f64)>) {
        let (axis, at) = self.axis_of(p);
        // A frame that turns smoothly with the axis, instead of a new choice.
        let u = (self.u - axis * axis.dot(&self.u)).normalize();
        let v = axis.cross(&u);
        let arms: Vec<Vector3<f64>> = points.iter().map(|q| q - at).collect();
        let angles: Vec<f64> = arms.iter().map(|a| v.dot(a).atan2(u.dot(a))).collect();
        let sizes = arms.iter().map(|a| (u.dot(a).hypot(v.dot(a)), axis.dot(a))).collect();
        (crate::identify::mechanism::path::unwrap(&angles), sizes)
    }

    /// Radial and axial residuals.
    fn residuals(&self, points: &[Vector3<f64>], p: &Parameters) -> DVector<f64> {
        let (angles, sizes) = self.seen(points, p);
        DVector::from_fn(2 * points.len(), |k, _| {
            let i = k / 2;
            if k % 2 == 0 { sizes[i].0 - p[4] } else { sizes[i].1 - p[5] * angles[i] - p[6] }
        })
    }

    /// The helix of refined parameters; `inverse` and `scale` are those of the pitch. `None` for less than a turn.
    fn helix(
        &self,
        points: &[Vector3<f64>],
        p: &Parameters,
        best: &DVector<f64>,
        inverse: f64,
        scale: f64,
    ) -> Option<Helix> {
        let n = points.len() as f64;
        let (axis, point) = self.axis_of(p);
        let angles = self.seen(points, p).0;
        let (low, high) = angles.iter().fold((f64::MAX, f64::MIN), |(l, h), a| (l.min(*a), h.max(*a)));
        let rms_m = (best.norm_squared() / n).sqrt();
        // Ten independent blocks, however many samples.
        let variance = rms_m * rms_m * n / 10.0;
        let found = Helix {
            point,
            axis,
            radius_m: p[4],
            pitch_m_rad: p[5],
            pitch_error: (inverse * variance).max(0.0).sqrt() * scale,
            turned_rad: high - low,
            rms_m,
        };
        let fine = [rms_m, p[4], p[5]].iter().all(|v| v.is_finite()) && p[4] > 0.0;
        (fine && found.turned_rad > LEAST_TURN_RAD).then_some(found)
    }
}

/// An algebraic circle across the axis, and the line of height over angle, as a start.
fn start(points: &[Vector3<f64>], axis: Vector3<f64>) -> Option<(Windings, Parameters)> {
    let n = points.len() as f64;
    let mean = points.iter().sum::<Vector3<f64>>() / n;
    let (u, v) = across(axis);
    let flat: Vec<(f64, f64)> = points.iter().map(|p| (u.dot(&(p - mean)), v.dot(&(p - mean)))).collect();
    let rows = DMatrix::from_fn(points.len(), 3, |i, j| [2.0 * flat[i].0, 2.0 * flat[i].1, 1.0][j]);
    let right = DVector::from_fn(points.len(), |i, _| flat[i].0.powi(2) + flat[i].1.powi(2));
    let circle = rows.svd(true, true).solve(&right, 1e-12).ok()?;
    let radius = (circle[2] + circle[0].powi(2) + circle[1].powi(2)).max(0.0).sqrt();
    let wind = Windings { middle: mean, axis, u, v };
    let mut p: Parameters = [circle[0], circle[1], 0.0, 0.0, radius, 0.0, 0.0];
    let (angles, sizes) = wind.seen(points, &p);
    let (turn, height) = (angles.iter().sum::<f64>() / n, sizes.iter().map(|s| s.1).sum::<f64>() / n);
    let square: f64 = angles.iter().map(|a| (a - turn).powi(2)).sum();
    p[5] = angles.iter().zip(&sizes).map(|(a, s)| (a - turn) * (s.1 - height)).sum::<f64>() / square.max(1e-12);
    p[6] = height - p[5] * turn;
    Some((wind, p))
}

fn refine(points: &[Vector3<f64>], axis: Vector3<f64>) -> Option<Helix> {
    let (wind, mut p) = start(points, axis)?;
    let radius = p[4];
    let scale = [radius, radius, 1.0, 1.0, radius, radius, radius].map(|s: f64| s.max(1e-6));
    let (mut best, mut damping) = (wind.residuals(points, &p), 1e-4);
    let mut inverse = DMatrix::zeros(7, 7);
    for _ in 0..ROUNDS {
        cancellation::check().ok()?;
        let slopes = DMatrix::from_columns(&[0, 1, 2, 3, 4, 5, 6].map(|j: usize| {
            let (mut a, mut b) = (p, p);
            a[j] += 1e-6 * scale[j];
            b[j] -= 1e-6 * scale[j];
            (wind.residuals(points, &a) - wind.residuals(points, &b)) / 2e-6
        }));
        let normal = slopes.tr_mul(&slopes);
        inverse = normal.clone().try_inverse()?;
        let damped = &normal + DMatrix::from_diagonal(&normal.diagonal()) * damping;
        let step = damped.try_inverse()? * slopes.tr_mul(&best);
        let mut next = p;
        (0..7).for_each(|j| next[j] -= step[j] * scale[j]);
        let trial = wind.residuals(points, &next);
        if trial.norm_squared() < best.norm_squared() {
            let done = best.norm_squared() - trial.norm_squared() < 1e-12 * best.norm_squared();
            (p, best, damping) = (next, trial, (0.1 * damping).max(1e-12));
            if done {
                break;
            }
        } else {
            damping *= 10.0;
            if damping > 1e6 {
                break;
            }
        }
    }
    wind.helix(points, &p, &best, inverse[(5, 5)], scale[5])
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    #[test]
    fn axis_radius_and_pitch_of_a_winding_path_come_back() {
        let axis = Vector3::new(0.36, 0.48, 0.8);
        let (u, v) = across(axis);
        for (seed, turned, pitch) in [(1_u64, 2.5_f64, 0.02), (2, 7.0, -0.01), (3, 15.0, 0.003)] {
            let mut rng = StdRng::seed_from_u64(seed);
            let points: Vec<Vector3<f64>> = (0..500)
                .map(|i| turned * f64::from(i) / 500.0)
                .map(|a| {
                    Vector3::new(0.3, -0.1, 0.5)
                        + (u * a.cos() + v * a.sin()) * 0.05
                        + axis * (pitch * a)
                        + Vector3::from_fn(|_, _| 2e-4 * rng.sample::<f64, _>(StandardNormal))
                })
                .collect();
            let found = fit(&points).expect("it winds");
            let sign = found.axis.dot(&axis).signum();
            assert!(found.axis.dot(&axis).abs() > 0.9995, "{found:?}");
            // A right-handed screw stays one, whichever way its axis points.
            assert!(((found.pitch_m_rad - pitch) / pitch).abs() < 0.06, "{pitch} {sign} {found:?}");
            assert!((found.radius_m - 0.05).abs() < 1e-3 && found.rms_m < 4e-4, "{found:?}");
            assert!(found.pitch_error > 0.0 && found.pitch_error < 0.2 * pitch.abs(), "{found:?}");
        }
    }
}
