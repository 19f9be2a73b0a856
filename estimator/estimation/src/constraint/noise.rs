//! Bend of a path by its error. The part of the noise that looks exactly like curvature cannot be seen in the residual,
//! so it is extrapolated from the part that can.
//!
//! Path errors (a slipping hook, a yielding finger) are strongly correlated along the path. The residual is expanded in
//! cosines over the travelled distance. Their powers are taken to follow A k^−p (white noise p = 0, a random walk p =
//! 2). The exponent is averaged over its likelihood and the amplitude follows Student's t, which makes the answer
//! heavy-tailed if the residual says little. The give of the grip, which no residual shows, is added as a floor.

use super::circle::{Arc, gradient};
use haptics::Vec2;
use nalgebra::DMatrix;
use statrs::distribution::{Continuous, ContinuousCDF, StudentsT};
use std::f64::consts::PI;

/// Cosines that are used.
const MAX_MODES: usize = 30;
/// Cosines of a short path: as many as its points allow, up to this.
const FEW_MODES: usize = 8;
/// Cosines over which the direction of interest is spread out.
const SPREAD_MODES: usize = 80;
/// A cosine of which the fit leaves less than this share tells nothing.
const LEAST_SHARE: f64 = 0.3;
/// Give of a grip, m, one standard deviation: no path is trusted further. A quarter of the millimetre and more that the
/// thesis measured at its fingers and a hook slips on a handle.
const GRIP_M: f64 = 2.5e-4;
/// The same for small mechanisms, as a share of their extent.
const GRIP_SHARE: f64 = 2.5e-3;
/// Exponents that are averaged over.
const EXPONENTS: [f64; 9] = [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0];

/// A mixture of Student's t distributions for the amplitude of the noise along one direction of the sample space.
#[derive(Clone, Debug)]
pub struct PathNoise {
    /// Weight and scale, m · √samples.
    parts: Vec<(f64, f64)>,
    freedom: f64,
    grip: f64,
}

/// Direction of the sample space that is in question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// A change of curvature.
    Curvature,
    /// A change of direction.
    Angle,
}

impl PathNoise {
    /// From the residual of `arc` at `points`, which are in travelled order and evenly spaced; `None` when they are too few.
    pub fn new(points: &[Vec2], arc: &Arc, extent_m: f64, direction: Direction) -> Option<Self> {
        let n = points.len();
        let modes = (n / 4).max(FEW_MODES.min(n / 2)).min(MAX_MODES);
        if modes < 4 {
            return None;
        }
        let basis = basis(points, arc, extent_m, direction);
        let last = basis.ncols() - 1;
        let residual: Vec<f64> = points.iter().map(|p| arc.distance(*p)).collect();
        let mut seen = Vec::new();
        for k in 1..=modes {
            let wave = cosine(n, k);
            let leverage: f64 = basis.column_iter().map(|q| dot(q.as_slice(), &wave).powi(2)).sum();
            if 1.0 - leverage > LEAST_SHARE {
                seen.push((k as f64, dot(&residual, &wave).powi(2) / (1.0 - leverage)));
            }
        }
        if seen.len() < 3 {
            return None;
        }
        let target = basis.column(last);
        let spread: Vec<f64> =
            (1..=SPREAD_MODES.min(n - 1)).map(|k| dot(target.as_slice(), &cosine(n, k)).powi(2)).collect();
        let count = seen.len() as f64;
        let part = |p: f64| {
            let amplitude = seen.iter().map(|(k, c)| c * k.powf(p)).sum::<f64>() / count;
            let log_scale: f64 = seen.iter().map(|(k, _)| -p * k.ln()).sum();
            let log_likelihood = -0.5 * log_scale - 0.5 * count * amplitude.max(f64::MIN_POSITIVE).ln();
            let variance: f64 = spread.iter().enumerate().map(|(i, d)| d * (i as f64 + 1.0).powf(-p)).sum();
            (log_likelihood, (amplitude * variance).sqrt())
        };
        let raw = EXPONENTS.map(part);
        let top = raw.iter().map(|(l, _)| *l).fold(f64::NEG_INFINITY, f64::max);
        let sum: f64 = raw.iter().map(|(l, _)| (l - top).exp()).sum();
        Some(Self {
            parts: raw.iter().map(|(l, s)| ((l - top).exp() / sum, *s)).collect(),
            freedom: count,
            grip: GRIP_M.min(GRIP_SHARE * extent_m) * (n as f64).sqrt(),
        })
    }

    /// Probability that the amplitude exceeds `level` in size.
    fn exceeds(&self, level: f64) -> f64 {
        let Ok(student) = StudentsT::new(0.0, 1.0, self.freedom) else { return 1.0 };
        self.parts.iter().map(|(w, s)| w * 2.0 * (1.0 - student.cdf(level / s.hypot(self.grip).max(1e-300)))).sum()
    }

    /// Probability density of the amplitude at `level`.
    pub fn density(&self, level: f64) -> f64 {
        let Ok(student) = StudentsT::new(0.0, 1.0, self.freedom) else { return 0.0 };
        let at = |(w, s): &(f64, f64)| {
            let scale = s.hypot(self.grip).max(1e-300);
            w * student.pdf(level / scale) / scale
        };
        self.parts.iter().map(at).sum()
    }

    /// Amplitude that is exceeded with probability `p`, m · √samples.
    pub fn quantile(&self, p: f64) -> f64 {
        let largest = self.parts.iter().map(|(_, s)| s.hypot(self.grip)).fold(0.0, f64::max);
        let (mut low, mut high) = (0.0, 1e3 * largest + f64::MIN_POSITIVE);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if self.exceeds(middle) > p { low = middle } else { high = middle }
        }
        high
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// Orthonormal cosine (DCT-II) of order k ≥ 1.
fn cosine(n: usize, k: usize) -> Vec<f64> {
    let size = (2.0 / n as f64).sqrt();
    (0..n).map(|i| size * (PI * k as f64 * (i as f64 + 0.5) / n as f64).cos()).collect()
}

/// Orthonormal basis of the space that the fit can absorb, the direction in question last and orthogonal to the others.
fn basis(points: &[Vec2], arc: &Arc, extent_m: f64, direction: Direction) -> DMatrix<f64> {
    let rows: Vec<_> = points.iter().map(|p| gradient(arc, *p, extent_m)).collect();
    let order: &[usize] = match direction {
        Direction::Curvature => &[2, 1, 0],
        Direction::Angle => &[2, 1],
    };
    DMatrix::from_fn(points.len(), order.len(), |i, j| rows[i][order[j]]).qr().q()
}

/// Size of the direction's own part of the gradient: amplitude / size = error of the curvature (1/m) or angle (rad).
pub fn sensitivity(points: &[Vec2], arc: &Arc, extent_m: f64, direction: Direction) -> f64 {
    let q = basis(points, arc, extent_m, direction);
    let column = match direction {
        Direction::Curvature => 0,
        Direction::Angle => 1,
    };
    let gradient: Vec<f64> = points.iter().map(|p| gradient(arc, *p, extent_m)[column]).collect();
    dot(q.column(q.ncols() - 1).as_slice(), &gradient).abs()
}
