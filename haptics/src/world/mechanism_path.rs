//! Path of a mechanism's tool point.

use serde::{Deserialize, Serialize};

/// Path of a mechanism's tool point, in the frame of its recording (3-D; z = 0 for planar recordings).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum MechanismPath {
    /// Along a line.
    Prismatic {
        /// A point of the line, m.
        origin_m: [f64; 3],
        /// Unit vector of +s.
        direction: [f64; 3],
    },
    /// About an axis.
    Revolute {
        /// Centre of the circle, m.
        center_m: [f64; 3],
        /// Unit vector of the axis; +θ is right-handed about it.
        axis: [f64; 3],
        /// Radius, m.
        radius_m: f64,
        /// Unit vector from the centre towards θ = 0.
        zero: [f64; 3],
    },
}

impl MechanismPath {
    /// Position of the tool point at a coordinate, m or rad.
    pub fn point_m(&self, coordinate: f64) -> [f64; 3] {
        match self {
            Self::Prismatic { origin_m, direction } => added(*origin_m, *direction, coordinate),
            Self::Revolute { center_m, axis, radius_m, zero } => {
                let (sin, cos) = coordinate.sin_cos();
                added(added(*center_m, *zero, radius_m * cos), cross(*axis, *zero), radius_m * sin)
            }
        }
    }

    /// Unit vector of its motion there, towards larger coordinates.
    pub fn along(&self, coordinate: f64) -> [f64; 3] {
        match self {
            Self::Prismatic { direction, .. } => *direction,
            Self::Revolute { axis, zero, .. } => {
                let (sin, cos) = coordinate.sin_cos();
                added(cross(*axis, *zero).map(|v| v * cos), *zero, -sin)
            }
        }
    }

    /// The force at the tool point, N, that a drive along the coordinate (N, or N m) amounts to where it is.
    pub fn force_n(&self, coordinate: f64, drive: f64) -> [f64; 3] {
        let lever_m = match self {
            Self::Prismatic { .. } => 1.0,
            Self::Revolute { radius_m, .. } => *radius_m,
        };
        self.along(coordinate).map(|v| v * drive / lever_m)
    }
}

fn added(a: [f64; 3], b: [f64; 3], times: f64) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + times * b[k])
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    fn near(a: [f64; 3], b: [f64; 3]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12), "{a:?}, not {b:?}");
    }

    #[test]
    fn a_quarter_turn_about_an_upright_axis_goes_from_x_to_minus_z() {
        let path = MechanismPath::Revolute {
            center_m: [1.0, 2.0, 3.0],
            axis: [0.0, 1.0, 0.0],
            radius_m: 0.5,
            zero: [1.0, 0.0, 0.0],
        };
        near(path.point_m(0.0), [1.5, 2.0, 3.0]);
        near(path.point_m(FRAC_PI_2), [1.0, 2.0, 2.5]);
        near(path.along(0.0), [0.0, 0.0, -1.0]);
        near(path.along(FRAC_PI_2), [-1.0, 0.0, 0.0]);
        // 2 N m at half a metre.
        near(path.force_n(0.0, 2.0), [0.0, 0.0, -4.0]);
    }

    #[test]
    fn a_drawer_goes_straight_on() {
        let path = MechanismPath::Prismatic { origin_m: [0.1, 0.0, 0.0], direction: [0.6, 0.8, 0.0] };
        near(path.point_m(0.5), [0.4, 0.4, 0.0]);
        near(path.force_n(0.5, 3.0), [1.8, 2.4, 0.0]);
    }
}
