//! Positions with up as third axis, and orientations where there are some.

use crate::identify::mechanism::path;
use haptics::recording::Recording;
use nalgebra::{Quaternion, Rotation3, UnitQuaternion, Vector3};

/// One recording.
#[derive(Clone, Debug)]
pub struct Track {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Two level coordinates and the height, m.
    pub points: Vec<Vector3<f64>>,
    /// From the body to the recording, turned as the points are.
    pub turned: Option<Vec<Rotation3<f64>>>,
}

impl Track {
    /// `None` without finite positions and times.
    pub fn of(recording: &Recording, up: Vector3<f64>) -> Option<Self> {
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

    /// Mean time between samples, s.
    pub fn step_s(&self) -> f64 {
        match self.time_s.as_slice() {
            [first, .., last] => (last - first) / (self.time_s.len() - 1) as f64,
            _ => 0.0,
        }
    }

    /// Samples that come nearest to a time, one at least: the event has a duration, whatever the rate.
    pub fn steps(&self, seconds: f64) -> usize {
        /// Largest number of steps; more than any track has, for a clock that stands.
        /// Choice: halved or doubled, none of 6 answers changes.
        const MOST: f64 = 1e9;
        (seconds / self.step_s()).round().clamp(1.0, MOST) as usize
    }

    /// Velocity about a sample, m/s: slope of the straight line through it and `reach` samples on either side, as far as there are any.
    pub fn velocity(&self, i: usize, reach: usize) -> Vector3<f64> {
        self.slope(i, reach, |k| self.points[k] - self.points[i])
    }

    /// Angular velocity about a sample in the track's frame, rad/s; zero without orientations.
    pub fn spin(&self, i: usize, reach: usize) -> Vector3<f64> {
        let Some(turned) = &self.turned else { return Vector3::zeros() };
        self.slope(i, reach, |k| (turned[k] * turned[i].inverse()).scaled_axis())
    }

    fn slope(&self, i: usize, reach: usize, of: impl Fn(usize) -> Vector3<f64>) -> Vector3<f64> {
        let range = i.saturating_sub(reach)..(i + reach + 1).min(self.points.len());
        let middle_s = range.clone().map(|k| self.time_s[k]).sum::<f64>() / range.len() as f64;
        let since = |k: usize| self.time_s[k] - middle_s;
        let square: f64 = range.clone().map(|k| since(k).powi(2)).sum();
        range.map(|k| of(k) * since(k)).sum::<Vector3<f64>>() / square.max(f64::MIN_POSITIVE)
    }

    /// Noise of a velocity, m/s, and of a level component of the angular velocity, rad/s, as [`Self::velocity`] and [`Self::spin`] tell them. Out of
    /// third differences of the height and second ones of the orientation: flight, sliding and rest have none but by noise.
    pub fn slope_noise(&self, reach: usize) -> (f64, f64) {
        /// Root sum of squares of the weights of a third difference.
        /// Derived: √(1² + 3² + 3² + 1²) = √20.
        const THIRD: f64 = 4.472;
        /// Root sum of squares of the weights of a second difference.
        /// Derived: √(1² + 2² + 1²) = √6.
        const SECOND: f64 = 2.449;
        /// Median size of a normal variable with unit variance.
        /// Derived: Φ⁻¹(0.75).
        const SIZE_OF_ONE: f64 = 0.6745;
        /// Median size of two independent normal variables with unit variance.
        /// Derived: √(2 ln 2), of the Rayleigh distribution.
        const SIZE_OF_TWO: f64 = 1.1774;
        let n = self.points.len();
        let z = |i: usize| self.points[i].z;
        let third = (3..n).map(|i| (z(i) - 3.0 * z(i - 1) + 3.0 * z(i - 2) - z(i - 3)).abs()).collect();
        let bent = |i: usize, turned: &[Rotation3<f64>]| {
            let step = |k: usize| (turned[k] * turned[k - 1].inverse()).scaled_axis();
            let change = step(i) - step(i - 1);
            change.x.hypot(change.y)
        };
        let second = self.turned.as_ref().map_or_else(Vec::new, |r| (2..n).map(|i| bent(i, r)).collect());
        let h = reach as f64;
        let span_s = self.step_s() * (h * (h + 1.0) * (2.0 * h + 1.0) / 3.0).sqrt();
        (median(third) / (SIZE_OF_ONE * THIRD * span_s), median(second) / (SIZE_OF_TWO * SECOND * span_s))
    }
}

/// Zero of nothing.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
