//! A guided path written compactly: the fewest control points of a cubic B-spline whose distance from the recorded path
//! is within its noise (thesis, 4.3.1). Least squares as in de Boor 1978, with the places on the curve projected again
//! each round (Hoschek 1988).

use foundation::cancellation;
use haptics::Vec2;
use haptics::world::Guide;
use nalgebra::{DMatrix, Matrix2xX};

/// Numbers of control points that are tried.
const SIZES: [usize; 8] = [4, 5, 6, 8, 10, 12, 16, 24];
/// Projections and refits.
const ROUNDS: usize = 6;
/// A path that comes back to within this share of its extent, going on in its direction, is closed.
const CLOSED_SHARE: f64 = 0.04;
/// More control points must bring the distance down by this share to be worth them.
const WORTH: f64 = 0.9;

/// The fitted curve.
#[derive(Clone, Debug)]
pub struct Spline {
    /// The curve; its forces on a body are not meant here.
    pub curve: Guide,
    /// Root mean square and largest distance of the points, m.
    pub rms_m: f64,
    /// m.
    pub largest_m: f64,
    /// m.
    pub length_m: f64,
}

/// The curve through `points`, which are in travelled order over one or several passes; `None` when they are too few. `bound_m`:
/// root mean square distance that is good enough.
pub fn fit(points: &[Vec2], extent_m: f64, bound_m: f64) -> Option<Spline> {
    let (pass, closed) = one_pass(points, extent_m);
    if pass.len() < 8 {
        return None;
    }
    let mut best: Option<Spline> = None;
    for size in SIZES.into_iter().filter(|n| 2 * n <= pass.len()) {
        let Some(found) = with_size(points, &pass, closed, size) else { continue };
        if best.as_ref().is_none_or(|b| found.rms_m < WORTH * b.rms_m) {
            best = Some(found);
        }
        if best.as_ref().is_some_and(|b| b.rms_m <= bound_m) {
            break;
        }
    }
    best
}

/// The longest segment without a reversal, cut where it closes; and true if it does.
fn one_pass(points: &[Vec2], extent_m: f64) -> (Vec<Vec2>, bool) {
    let reach = 0.04 * extent_m;
    // A reversal: the way back to within reach is much shorter than the way gone.
    let turns = |i: usize| {
        let before = (0..i).rev().find(|&j| (points[j] - points[i]).norm() > reach);
        let after = (i + 1..points.len()).find(|&j| (points[j] - points[i]).norm() > reach);
        match (before, after) {
            (Some(b), Some(a)) => (points[i] - points[b]).dot(&(points[a] - points[i])) < -0.5 * reach * reach,
            _ => false,
        }
    };
    let mut cuts = vec![0];
    cuts.extend((1..points.len()).filter(|&i| turns(i)));
    cuts.push(points.len());
    let length = |a: usize, b: usize| points[a..b].windows(2).map(|w| (w[1] - w[0]).norm()).sum::<f64>();
    let longest = cuts.windows(2).max_by(|a, b| length(a[0], a[1]).total_cmp(&length(b[0], b[1])));
    let Some(range) = longest else { return (Vec::new(), false) };
    let pass = &points[range[0]..range[1]];
    let mut way = 0.0;
    for i in 1..pass.len() {
        way += (pass[i] - pass[i - 1]).norm();
        if way > 1.5 * extent_m && (pass[i] - pass[0]).norm() < CLOSED_SHARE * extent_m {
            return (pass[..i].to_vec(), true);
        }
    }
    (pass.to_vec(), false)
}

fn with_size(points: &[Vec2], pass: &[Vec2], closed: bool, size: usize) -> Option<Spline> {
    let ways: Vec<f64> = std::iter::once(0.0)
        .chain(pass.windows(2).scan(0.0, |sum, w| {
            *sum += (w[1] - w[0]).norm();
            Some(*sum)
        }))
        .collect();
    let total = *ways.last()?;
    let pieces = if closed { size } else { size - 1 } as f64;
    let places: Vec<f64> = ways.iter().map(|w| w / total * pieces).collect();
    let mut curve = solve(pass, &places, closed, size)?;
    for _ in 0..ROUNDS {
        cancellation::check().ok()?;
        let places: Vec<f64> = points.iter().map(|p| curve.nearest(*p)).collect();
        curve = solve(points, &places, closed, size)?;
    }
    let distances: Vec<f64> = points.iter().map(|p| (curve.point(curve.nearest(*p)).0 - p).norm()).collect();
    let n = distances.len() as f64;
    let steps = 32 * size;
    let at = |k: usize| curve.point(k as f64 / steps as f64 * curve.pieces() as f64).0;
    Some(Spline {
        rms_m: (distances.iter().map(|d| d * d).sum::<f64>() / n).sqrt(),
        largest_m: distances.iter().fold(0.0, |a, b| a.max(*b)),
        length_m: (0..steps).map(|k| (at(k + 1) - at(k)).norm()).sum(),
        curve,
    })
}

/// Least squares for the control points, with a hair of stiffness where no point lies.
fn solve(points: &[Vec2], places: &[f64], closed: bool, size: usize) -> Option<Guide> {
    let mut normal = DMatrix::zeros(size, size);
    let mut right = DMatrix::zeros(size, 2);
    for (point, place) in points.iter().zip(places) {
        let row = weights(*place, closed, size);
        for (i, a) in row.iter().enumerate().filter(|(_, a)| **a != 0.0) {
            for (j, b) in row.iter().enumerate() {
                normal[(i, j)] += a * b;
            }
            right[(i, 0)] += a * point.x;
            right[(i, 1)] += a * point.y;
        }
    }
    let hair = 1e-5 * points.len() as f64 / size as f64;
    for i in 1..size - 1 {
        for (j, a) in [(i - 1, 1.0), (i, -2.0), (i + 1, 1.0)] {
            for (k, b) in [(i - 1, 1.0), (i, -2.0), (i + 1, 1.0)] {
                normal[(j, k)] += hair * a * b;
            }
        }
    }
    let solution: Matrix2xX<f64> =
        Matrix2xX::from_iterator(size, normal.cholesky()?.solve(&right).transpose().iter().copied());
    let points_m: Vec<Vec2> = solution.column_iter().map(|c| Vec2::new(c[0], c[1])).collect();
    points_m.iter().all(|p| p.x.is_finite() && p.y.is_finite()).then_some(Guide {
        points_m,
        closed,
        stiffness_n_m: 1.0,
        damping_n_s_m: 0.0,
        friction_n: 0.0,
    })
}

/// Weight of each control point at a place, the mirrored ones beyond the ends taken back to their own.
fn weights(at: f64, closed: bool, size: usize) -> Vec<f64> {
    let pieces = if closed { size } else { size - 1 };
    let piece = at.floor().clamp(0.0, pieces as f64 - 1.0);
    let t = at - piece;
    let (t2, t3, back) = (t * t, t * t * t, 1.0 - t);
    let shares =
        [back * back * back, 3.0 * t3 - 6.0 * t2 + 4.0, -3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0, t3].map(|b| b / 6.0);
    let mut row = vec![0.0; size];
    for (k, share) in shares.into_iter().enumerate() {
        // Control point next − 1.
        let next = piece as usize + k;
        if closed {
            row[(next + size - 1) % size] += share;
        } else if next == 0 {
            row[0] += 2.0 * share;
            row[1] -= share;
        } else if next > size {
            row[size - 1] += 2.0 * share;
            row[2 * size - next - 1] -= share;
        } else {
            row[next - 1] += share;
        }
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    fn noisy(n: usize, sigma: f64, seed: u64, at: impl Fn(f64) -> (f64, f64)) -> Vec<Vec2> {
        let mut rng = StdRng::seed_from_u64(seed);
        let mut noise = || sigma * rng.sample::<f64, _>(StandardNormal);
        (0..n).map(|i| at(i as f64 / n as f64)).map(|(x, y)| Vec2::new(x + noise(), y + noise())).collect()
    }

    #[test]
    fn an_s_followed_three_times_takes_few_points_and_no_more_than_its_noise() {
        let zigzag = |u: f64| (1.0 - (2.0 * (1.5 * u).fract() - 1.0).abs()).min(1.0);
        for seed in 0..5 {
            let points = noisy(600, 2e-4, seed, |u| {
                let s = zigzag(u);
                (0.3 * s, 0.05 * (6.0 * s).sin())
            });
            let found = fit(&points, 0.3, 3e-4).expect("a curve");
            assert!(found.rms_m < 3e-4, "{} m", found.rms_m);
            assert!(!found.curve.closed && found.curve.points_m.len() <= 24, "{:?}", found.curve);
            assert!((found.length_m - 0.362).abs() < 0.01, "{}", found.length_m);
        }
    }

    #[test]
    fn an_oval_followed_twice_is_closed() {
        let points = noisy(500, 1e-4, 3, |u| {
            let a = 2.0 * std::f64::consts::TAU * u;
            (0.08 * a.cos(), 0.04 * a.sin())
        });
        let found = fit(&points, 0.16, 1.5e-4).expect("a curve");
        assert!(found.curve.closed && found.rms_m < 2e-4 && found.curve.points_m.len() <= 24, "{found:?}");
    }
}
