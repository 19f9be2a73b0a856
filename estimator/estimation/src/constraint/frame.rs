//! A path in its own plane: mean, axes, evenly spaced points in travelled order.

use foundation::signal::noise::{white_noise, white_noise_uneven};
use haptics::Vec2;
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// Points along the extent of the path that are kept.
const POINTS_PER_EXTENT: f64 = 400.0;
/// Most points that are kept of a path that goes round and round.
const MAX_POINTS: usize = 1500;

/// A path flattened onto its best plane.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Mean of the kept points, m.
    pub origin: Vector3<f64>,
    /// Unit vectors: longest direction, second, normal of the plane (right-handed).
    pub axes: [Vector3<f64>; 3],
    /// Kept points in the plane, m.
    pub flat: Vec<Vec2>,
    /// The same points in space, m.
    pub space: Vec<Vector3<f64>>,
    /// Index of each kept point in the recording.
    pub kept: Vec<usize>,
    /// Root mean square distance from the plane, m.
    pub plane_rms_m: f64,
    /// Root mean square distance from the best line, m.
    pub line_rms_m: f64,
    /// Length along the longest direction, m.
    pub extent_m: f64,
    /// Length along the second direction, m.
    pub width_m: f64,
    /// Travelled length, m.
    pub travelled_m: f64,
    /// White part of the noise of a coordinate, m.
    pub noise_m: f64,
}

impl Frame {
    /// `points`: n ≥ 2 tool positions, m; `planar`: all in the x-y plane, whose normal is then +z. `None` when nothing moves.
    pub fn new(points: &[Vector3<f64>], planar: bool) -> Option<Self> {
        let noise_m = noise(points);
        let kept = thin(points, noise_m)?;
        let chosen = averaged(points, &kept);
        let n = chosen.len() as f64;
        let origin = chosen.iter().sum::<Vector3<f64>>() / n;
        let spread: Matrix3<f64> = chosen.iter().map(|p| (p - origin) * (p - origin).transpose()).sum();
        let eigen = SymmetricEigen::new(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let axis = |k: usize| eigen.eigenvectors.column(order[k]).into_owned();
        let (first, normal) = if planar { (in_plane(axis(0)), Vector3::z()) } else { (axis(0), upward(axis(2))) };
        let axes = [first, normal.cross(&first), normal];
        let flat: Vec<Vec2> =
            chosen.iter().map(|p| Vec2::new(axes[0].dot(&(p - origin)), axes[1].dot(&(p - origin)))).collect();
        let out: f64 = chosen.iter().map(|p| axes[2].dot(&(p - origin)).powi(2)).sum::<f64>() / n;
        let aside: f64 = flat.iter().map(|p| p.y * p.y).sum::<f64>() / n;
        let length = |of: fn(&Vec2) -> f64| {
            let (low, high) =
                flat.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
            high - low
        };
        Some(Self {
            extent_m: length(|p| p.x),
            width_m: length(|p| p.y),
            travelled_m: chosen.windows(2).map(|w| (w[1] - w[0]).norm()).sum(),
            plane_rms_m: out.sqrt(),
            line_rms_m: (out + aside).sqrt(),
            noise_m,
            origin,
            axes,
            flat,
            space: chosen,
            kept,
        })
    }

    /// A point of the plane in space, m.
    pub fn lift(&self, p: Vec2) -> Vector3<f64> {
        self.origin + self.axes[0] * p.x + self.axes[1] * p.y
    }
}

/// The larger part of an axis points up, so that two trials of one mechanism agree about its sign.
fn upward(axis: Vector3<f64>) -> Vector3<f64> {
    let largest = axis.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(1.0);
    if largest < 0.0 { -axis } else { axis }
}

/// Mean of the samples about each kept one: those on the way to its neighbours that lie nearer to it. Otherwise the
/// samples between two kept points would be thrown away, and with them noise that averages out.
fn averaged(points: &[Vector3<f64>], kept: &[usize]) -> Vec<Vector3<f64>> {
    let mut sums: Vec<(Vector3<f64>, f64)> = kept.iter().map(|&i| (points[i], 1.0)).collect();
    for (k, &first) in kept.iter().enumerate() {
        let next = kept.get(k + 1).copied();
        for point in &points[first + 1..next.unwrap_or(points.len())] {
            let nearer = next.is_some_and(|n| (point - points[n]).norm() < (point - points[first]).norm());
            let sum = &mut sums[if nearer { k + 1 } else { k }];
            sum.0 += point;
            sum.1 += 1.0;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / count).collect()
}

fn in_plane(axis: Vector3<f64>) -> Vector3<f64> {
    Vector3::new(axis.x, axis.y, 0.0).try_normalize(1e-12).unwrap_or_else(Vector3::x)
}

/// Paths of up to this many points are sparse: from one to the next, the path itself bends more than the noise.
const SPARSE_POINTS: usize = 64;

/// White noise of the noisiest coordinate, m.
fn noise(points: &[Vector3<f64>]) -> f64 {
    let coordinate = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
    let in_order = (0..3).map(|k| white_noise(&coordinate(k))).fold(0.0, f64::max);
    if points.len() > SPARSE_POINTS {
        return in_order;
    }
    // Over the travelled distance instead of the sample number, however unevenly the points lie.
    let mut moved: Vec<Vector3<f64>> = points.to_vec();
    moved.dedup();
    let mut travelled = 0.0;
    let along: Vec<f64> = moved
        .iter()
        .enumerate()
        .map(|(i, p)| {
            travelled += if i > 0 { (p - moved[i - 1]).norm() } else { 0.0 };
            travelled
        })
        .collect();
    let over_distance = |k: usize| white_noise_uneven(&along, &moved.iter().map(|p| p[k]).collect::<Vec<f64>>());
    (0..3).map(over_distance).fold(0.0, f64::max).min(in_order)
}

/// Indices of points at even distance along the path: time spent at rest must not count.
fn thin(points: &[Vector3<f64>], noise: f64) -> Option<Vec<usize>> {
    let first = points.first()?;
    let (mut low, mut high) = (*first, *first);
    for p in points {
        low = low.inf(p);
        high = high.sup(p);
    }
    let extent = (high - low).norm();
    let mut spacing = (extent / POINTS_PER_EXTENT).max(3.0 * noise);
    if extent.is_nan() || extent <= 0.0 {
        return None;
    }
    loop {
        let mut kept = vec![0];
        for i in 1..points.len() {
            if (points[i] - points[kept[kept.len() - 1]]).norm() >= spacing {
                kept.push(i);
            }
        }
        if kept.len() <= MAX_POINTS {
            return Some(kept);
        }
        spacing *= 1.2 * kept.len() as f64 / MAX_POINTS as f64;
    }
}
