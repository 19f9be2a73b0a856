//! A tool path as a mechanism: the constraint it follows, the coordinate along it, the force along it.

use foundation::estimate::{Constraint, ConstraintKind, EstimateError};
use haptics::recording::Recording;
use haptics::world::MechanismPath;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// A recording seen along a path.
#[derive(Clone, Debug)]
pub struct Projected {
    /// m or rad (unwrapped), one a sample.
    pub position: Vec<f64>,
    /// N or N m along +coordinate; `None` without force columns.
    pub force: Option<Vec<f64>>,
    /// Upward unit vector along +coordinate; `None` when up is `none`.
    pub up_along: Option<Vec<f64>>,
}

/// Tool positions, 3-D; z = 0 for a planar recording.
pub fn points(recording: &Recording) -> Option<Vec<Vector3<f64>>> {
    vectors(recording, ["x_m", "y_m", "z_m"])
}

/// Tool forces on the environment, N.
pub fn forces(recording: &Recording) -> Option<Vec<Vector3<f64>>> {
    vectors(recording, ["fx_N", "fy_N", "fz_N"])
}

fn vectors(recording: &Recording, names: [&str; 3]) -> Option<Vec<Vector3<f64>>> {
    let (x, y) = (recording.channel(names[0])?, recording.channel(names[1])?);
    let z = recording.channel(names[2]);
    Some((0..x.len()).map(|i| Vector3::new(x[i], y[i], z.map_or(0.0, |z| z[i]))).collect())
}

/// The upward unit vector of a recording; `None` for a horizontal plane.
pub fn up(recording: &Recording) -> Option<Vector3<f64>> {
    match recording.meta.up.as_deref().unwrap_or("y") {
        "y" => Some(Vector3::y()),
        "-y" => Some(-Vector3::y()),
        "x" => Some(Vector3::x()),
        "-x" => Some(-Vector3::x()),
        "z" => Some(Vector3::z()),
        "-z" => Some(-Vector3::z()),
        _ => None,
    }
}

fn vector(values: &[f64]) -> Vector3<f64> {
    let at = |i: usize| values.get(i).copied().unwrap_or(0.0);
    Vector3::new(at(0), at(1), at(2))
}

/// The constraint as a path, with its zero at the start of the recording; `None` when it is neither line nor circle.
pub fn from_constraint(constraint: &Constraint, recording: &Recording) -> Option<MechanismPath> {
    let points = points(recording)?;
    let first = points.first()?;
    match constraint.kind {
        ConstraintKind::Prismatic => {
            let direction = vector(constraint.direction.as_ref()?).normalize();
            let mean = points.iter().sum::<Vector3<f64>>() / points.len() as f64;
            let origin = mean + direction * direction.dot(&(first - mean));
            Some(MechanismPath::Prismatic { origin_m: origin.into(), direction: direction.into() })
        }
        ConstraintKind::Revolute => {
            let axis = constraint.direction.as_ref().map_or_else(Vector3::z, |d| vector(d).normalize());
            let center = vector(constraint.center_m.as_ref()?);
            let arm = first - center;
            let zero = (arm - axis * axis.dot(&arm)).try_normalize(1e-12)?;
            Some(MechanismPath::Revolute {
                center_m: center.into(),
                axis: axis.into(),
                radius_m: constraint.radius_m?,
                zero: zero.into(),
            })
        }
        _ => None,
    }
}

/// Largest distance of a tool from its path when the object is held again, in multiples of the usual one.
/// Choice: no case of the ablation reads it.
const WORSE: f64 = 3.0;
/// Addition to this distance, as a share of the path's extent.
/// Choice: no case of the ablation reads it.
const SPARE: f64 = 0.005;

/// Largest distance of a recording of the same object, in the same frame, from the path that was found in `like`, m.
pub fn spare_m(path: &MechanismPath, like: &Recording) -> Option<f64> {
    let points = points(like)?;
    let extent_m = |axis: usize| {
        let (low, high) = points.iter().fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p[axis]), h.max(p[axis])));
        (high - low).max(0.0)
    };
    let extent_m = (0..3).map(|axis| extent_m(axis).powi(2)).sum::<f64>().sqrt();
    Some(WORSE * beside_m(&points, path) + SPARE * extent_m)
}

/// True if a recording keeps to a path within [`spare_m`], so that one coordinate holds in it and in the recording of
/// the path.
pub fn keeps_to(recording: &Recording, path: &MechanismPath, spare_m: f64) -> bool {
    // Written so that not-a-number is false.
    points(recording).is_some_and(|own| beside_m(&own, path) <= spare_m)
}

/// True if a recording keeps to the path that was found in `like`: the same object in the same frame.
pub fn lies_on(recording: &Recording, path: &MechanismPath, like: &Recording) -> bool {
    spare_m(path, like).is_some_and(|spare_m| keeps_to(recording, path, spare_m))
}

/// Root mean square of the points' distances from a path, m.
fn beside_m(points: &[Vector3<f64>], path: &MechanismPath) -> f64 {
    let square = |p: &Vector3<f64>| match *path {
        MechanismPath::Prismatic { origin_m, direction } => {
            let (from, along) = (p - Vector3::from(origin_m), Vector3::from(direction));
            (from - along * along.dot(&from)).norm_squared()
        }
        MechanismPath::Revolute { center_m, axis, radius_m, .. } => {
            let (arm, axis) = (p - Vector3::from(center_m), Vector3::from(axis));
            let aside = axis.dot(&arm);
            ((arm - axis * aside).norm() - radius_m).powi(2) + aside * aside
        }
    };
    (points.iter().map(square).sum::<f64>() / points.len().max(1) as f64).sqrt()
}

/// Coordinate and force of a recording along `path`.
pub fn project(recording: &Recording, path: &MechanismPath) -> Result<Projected, EstimateError> {
    let points = points(recording).ok_or_else(|| EstimateError::MissingColumn {
        task: "a mechanism's tool path".to_owned(),
        column: "x_m and y_m".to_owned(),
        recording: recording.name.clone(),
    })?;
    let forces = forces(recording);
    let up = up(recording);
    Ok(match *path {
        MechanismPath::Prismatic { origin_m, direction } => {
            let (origin, along) = (Vector3::from(origin_m), Vector3::from(direction));
            Projected {
                position: points.iter().map(|p| along.dot(&(p - origin))).collect(),
                force: forces.map(|f| f.iter().map(|f| along.dot(f)).collect()),
                up_along: up.map(|up| vec![up.dot(&along); points.len()]),
            }
        }
        MechanismPath::Revolute { center_m, axis, radius_m, zero } => {
            let (center, axis, zero) = (Vector3::from(center_m), Vector3::from(axis), Vector3::from(zero));
            let side = axis.cross(&zero);
            let angle: Vec<f64> =
                points.iter().map(|p| side.dot(&(p - center)).atan2(zero.dot(&(p - center)))).collect();
            let tangent: Vec<Vector3<f64>> = angle.iter().map(|a| side * a.cos() - zero * a.sin()).collect();
            Projected {
                position: unwrap(&angle),
                force: forces.map(|f| f.iter().zip(&tangent).map(|(f, t)| radius_m * t.dot(f)).collect()),
                up_along: up.map(|up| tangent.iter().map(|t| up.dot(t)).collect()),
            }
        }
    })
}

/// Angles made continuous: steps of more than half a turn are taken the other way round.
pub fn unwrap(angles: &[f64]) -> Vec<f64> {
    let mut turns = 0.0;
    let mut previous = angles.first().copied().unwrap_or(0.0);
    angles
        .iter()
        .map(|&angle| {
            let step = angle - previous;
            if step > PI {
                turns -= TAU;
            } else if step < -PI {
                turns += TAU;
            }
            previous = angle;
            angle + turns
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use haptics::recording::Channel;

    #[test]
    fn two_turns_unwrap_and_a_tangential_force_is_a_torque() {
        let angles: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.06).collect();
        let channel = |name: &str, of: &dyn Fn(f64) -> f64| Channel {
            name: name.to_owned(),
            unit: String::new(),
            values: angles.iter().map(|&a| of(a)).collect(),
        };
        let recording = Recording {
            channels: vec![
                channel("x_m", &|a| 1.0 + 0.2 * a.cos()),
                channel("y_m", &|a| 2.0 + 0.2 * a.sin()),
                channel("fx_N", &|a| -3.0 * a.sin() + a.cos()),
                channel("fy_N", &|a| 3.0 * a.cos() + a.sin()),
            ],
            ..Recording::default()
        };
        let path = MechanismPath::Revolute {
            center_m: [1.0, 2.0, 0.0],
            axis: [0.0, 0.0, 1.0],
            radius_m: 0.2,
            zero: [1.0, 0.0, 0.0],
        };
        let seen = project(&recording, &path).expect("projects");
        assert!((seen.position[199] - 199.0 * 0.06).abs() < 1e-9);
        assert!(seen.force.expect("a torque").iter().all(|t| (t - 0.6).abs() < 1e-12));
        assert!((seen.up_along.expect("up is y")[0] - 1.0).abs() < 1e-12);
    }

    #[test]
    fn another_recording_keeps_to_the_path_unless_the_object_or_the_frame_was_moved() {
        let turned = |first: f64, shifted_m: f64, radius_m: f64| {
            let channel = |name: &str, of: &dyn Fn(f64) -> f64| Channel {
                name: name.to_owned(),
                unit: "m".to_owned(),
                values: (0..300).map(|i| of(first + 0.004 * f64::from(i))).collect(),
            };
            let channels = vec![
                channel("x_m", &|a| shifted_m + radius_m * a.cos() + 2e-4 * (97.0 * a).sin()),
                channel("y_m", &|a| radius_m * a.sin() + 2e-4 * (89.0 * a).cos()),
            ];
            Recording { channels, ..Recording::default() }
        };
        let like = turned(0.0, 0.0, 0.3);
        let path =
            MechanismPath::Revolute { center_m: [0.0; 3], axis: [0.0, 0.0, 1.0], radius_m: 0.3, zero: [1.0, 0.0, 0.0] };
        assert!(lies_on(&turned(2.0, 0.0, 0.3), &path, &like), "elsewhere on the same circle");
        assert!(!lies_on(&turned(0.0, 0.01, 0.3), &path, &like), "the frame was moved by a centimetre");
        assert!(!lies_on(&turned(0.0, 0.0, 0.32), &path, &like), "the handle is another one");
        assert!(!lies_on(&turned(0.0, f64::NAN, 0.3), &path, &like));
    }
}
