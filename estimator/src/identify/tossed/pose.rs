//! Positions with up as third axis, and orientations where there are some.

use crate::identify::mechanism::path;
use haptics::recording::Recording;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

/// One recording.
#[derive(Clone, Debug)]
pub(crate) struct Track {
    pub time_s: Vec<f64>,
    /// Two level coordinates and the height, m.
    pub points: Vec<Vector3<f64>>,
    /// From the body to the recording, turned as the points are.
    pub turned: Option<Vec<Rotation3<f64>>>,
}

impl Track {
    /// `None` without finite positions and times.
    pub(crate) fn of(recording: &Recording, up: Vector3<f64>) -> Option<Self> {
        let time_s = recording.time_s.clone()?;
        let points = path::points(recording)?;
        let frame = Rotation3::rotation_between(&up, &Vector3::z())
            .unwrap_or_else(|| Rotation3::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
        let finite = points.iter().all(|p| p.iter().all(|v| v.is_finite())) && time_s.iter().all(|t| t.is_finite());
        let quaternion = ["qw", "qx", "qy", "qz"].map(|name| recording.channel(name));
        let turned = if let [Some(w), Some(x), Some(y), Some(z)] = quaternion {
            let at = |i: usize| UnitQuaternion::from_quaternion(Quaternion::new(w[i], x[i], y[i], z[i]));
            Some((0..points.len()).map(|i| frame * at(i).to_rotation_matrix()).collect::<Vec<_>>())
                .filter(|all| all.iter().all(|r| r.matrix().iter().all(|v| v.is_finite())))
        } else {
            None
        };
        let points = points.iter().map(|p| frame * p).collect();
        finite.then_some(Self { time_s, points, turned })
    }

    /// Angle turned between two samples, rad; zero without orientations.
    pub(crate) fn angle(&self, from: usize, to: usize) -> f64 {
        self.turned.as_ref().map_or(0.0, |r| r[from].angle_to(&r[to]))
    }
}
