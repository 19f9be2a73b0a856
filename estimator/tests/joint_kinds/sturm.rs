//! The peer: Sturm, Stachniss, Burgard, "A probabilistic framework for learning kinematic models of articulated objects", JAIR 41
//! (2011), for positions: rigid, prismatic and rotational models by sample consensus and refinement of a likelihood with
//! outliers, the smallest BIC = −2 ln L + k ln n wins. σ = 5 mm and the outliers' level (1.96 σ) as in the authors' release, and
//! its parameter counts less the three of an orientation, which none of the models needs here (rigid 3, prismatic 5,
//! rotational 6). Their rule has no free motion: where most samples are outliers of the winner it is read as such, in its favour.

use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen, Vector3};
use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};

const SIGMA_M: f64 = 5e-3;
const OUTLIERS: f64 = 0.01;
const OUTLIER_SIGMAS: f64 = 1.96;
const CONSENSUS: usize = 100;

/// What the rule answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    Rigid,
    Prismatic,
    Rotational,
    Free,
}

#[derive(Clone, Copy)]
enum Model {
    Point(Vector3<f64>),
    Line { origin: Vector3<f64>, along: Vector3<f64> },
    Circle { center: Vector3<f64>, axis: Vector3<f64>, radius: f64 },
}

impl Model {
    fn distance(&self, p: &Vector3<f64>) -> f64 {
        match self {
            Model::Point(at) => (p - at).norm(),
            Model::Line { origin, along } => {
                let arm = p - origin;
                (arm - along * along.dot(&arm)).norm()
            }
            Model::Circle { center, axis, radius } => {
                let arm = p - center;
                let out = axis.dot(&arm);
                ((arm - axis * out).norm() - radius).hypot(out)
            }
        }
    }

    fn complexity(&self) -> f64 {
        match self {
            Model::Point(_) => 3.0,
            Model::Line { .. } => 5.0,
            Model::Circle { .. } => 6.0,
        }
    }

    /// Share of the inlier in the density at each point, and the log-likelihood less what all models have in common.
    fn weigh(&self, points: &[Vector3<f64>]) -> (Vec<f64>, f64) {
        let outlier = OUTLIERS * (-0.5 * OUTLIER_SIGMAS * OUTLIER_SIGMAS).exp();
        let mut sum = 0.0;
        let weights = points
            .iter()
            .map(|p| {
                let inlier = (1.0 - OUTLIERS) * (-0.5 * (self.distance(p) / SIGMA_M).powi(2)).exp();
                sum += (inlier + outlier).ln();
                inlier / (inlier + outlier)
            })
            .collect();
        (weights, sum)
    }
}

/// The rule's answer; `rotational_extra`: parameters that a rotation counts beyond the published six.
pub fn decide(points: &[Vector3<f64>], rotational_extra: f64, seed: u64) -> Answer {
    let mut rng = StdRng::seed_from_u64(seed);
    let n = points.len() as f64;
    let mut best = (Answer::Rigid, f64::INFINITY, 0.0);
    for answer in [Answer::Rigid, Answer::Prismatic, Answer::Rotational] {
        let Some(model) = fit(points, answer, &mut rng) else { continue };
        let (weights, log_likelihood) = model.weigh(points);
        let extra = if answer == Answer::Rotational { rotational_extra } else { 0.0 };
        let bic = -2.0 * log_likelihood + (model.complexity() + extra) * n.ln();
        if bic < best.1 {
            best = (answer, bic, weights.iter().filter(|w| **w < 0.5).count() as f64 / n);
        }
    }
    if best.2 > 0.5 { Answer::Free } else { best.0 }
}

/// The best of many guesses from the fewest points, refined by reweighting (expectation and maximisation).
fn fit(points: &[Vector3<f64>], kind: Answer, rng: &mut StdRng) -> Option<Model> {
    let mut best: Option<(Model, f64)> = None;
    let keep = |model: Model, best: &mut Option<(Model, f64)>| {
        let value = model.weigh(points).1;
        if best.is_none_or(|b| value > b.1) {
            *best = Some((model, value));
        }
    };
    for _ in 0..CONSENSUS {
        let pick: [Vector3<f64>; 3] = std::array::from_fn(|_| points[rng.random_range(0..points.len())]);
        if let Some(model) = guess(&pick, kind) {
            keep(model, &mut best);
        }
    }
    // The plain least-squares fit is one more guess: the authors refine by gradient from the best.
    if let Some(model) = refit(points, &vec![1.0; points.len()], kind) {
        keep(model, &mut best);
    }
    for _ in 0..20 {
        let (model, _) = best?;
        let weights = model.weigh(points).0;
        let Some(next) = refit(points, &weights, kind) else { break };
        let before = best?.1;
        keep(next, &mut best);
        if best?.1 - before < 1e-6 {
            break;
        }
    }
    best.map(|b| b.0)
}

fn guess(p: &[Vector3<f64>; 3], kind: Answer) -> Option<Model> {
    match kind {
        Answer::Prismatic => Some(Model::Line { origin: p[0], along: (p[1] - p[0]).try_normalize(1e-9)? }),
        Answer::Rotational => {
            let (u, v) = (p[1] - p[0], p[2] - p[0]);
            let axis = u.cross(&v);
            let square = axis.norm_squared();
            if square < 1e-20 {
                return None;
            }
            let arm = (v.norm_squared() * u.cross(&v).cross(&u) + u.norm_squared() * v.cross(&axis)) / (2.0 * square);
            Some(Model::Circle { center: p[0] + arm, axis: axis.normalize(), radius: arm.norm() })
        }
        _ => Some(Model::Point(p[0])),
    }
}

/// Weighted least squares.
fn refit(points: &[Vector3<f64>], weights: &[f64], kind: Answer) -> Option<Model> {
    let sum: f64 = weights.iter().sum();
    let mean = points.iter().zip(weights).map(|(p, w)| p * *w).sum::<Vector3<f64>>() / sum;
    if !mean.iter().all(|v| v.is_finite()) {
        return None;
    }
    let spread: Matrix3<f64> = points.iter().zip(weights).map(|(p, w)| (p - mean) * (p - mean).transpose() * *w).sum();
    let eigen = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let axis = |k: usize| eigen.eigenvectors.column(order[k]).into_owned();
    match kind {
        Answer::Rigid | Answer::Free => Some(Model::Point(mean)),
        Answer::Prismatic => Some(Model::Line { origin: mean, along: axis(0) }),
        Answer::Rotational => circle(points, weights, mean, [axis(0), axis(1), axis(2)]),
    }
}

/// Algebraic circle in the plane of the largest spread, polished by Gauss–Newton on the radius.
fn circle(points: &[Vector3<f64>], weights: &[f64], mean: Vector3<f64>, axes: [Vector3<f64>; 3]) -> Option<Model> {
    let flat: Vec<[f64; 2]> = points.iter().map(|p| [axes[0].dot(&(p - mean)), axes[1].dot(&(p - mean))]).collect();
    let n = flat.len();
    let root = |i: usize| weights[i].sqrt();
    let solve = |rows: DMatrix<f64>, right: DVector<f64>| rows.svd(true, true).solve(&right, 1e-12).ok();
    let rows = DMatrix::from_fn(n, 3, |i, j| root(i) * [2.0 * flat[i][0], 2.0 * flat[i][1], 1.0][j]);
    let right = DVector::from_fn(n, |i, _| root(i) * (flat[i][0].powi(2) + flat[i][1].powi(2)));
    let start = solve(rows, right)?;
    let (mut x, mut y) = (start[0], start[1]);
    let mut radius = (start[2] + x * x + y * y).max(0.0).sqrt();
    for _ in 0..15 {
        let arm = |i: usize| (flat[i][0] - x).hypot(flat[i][1] - y).max(1e-9);
        let rows =
            DMatrix::from_fn(n, 3, |i, j| root(i) * [(flat[i][0] - x) / arm(i), (flat[i][1] - y) / arm(i), 1.0][j]);
        let right = DVector::from_fn(n, |i, _| root(i) * (arm(i) - radius));
        let Some(step) = solve(rows, right) else { break };
        (x, y, radius) = (x + step[0], y + step[1], radius + step[2]);
        if step.norm() < 1e-9 * radius.abs().max(1e-9) {
            break;
        }
    }
    let fine = x.is_finite() && y.is_finite() && radius.is_finite() && radius > 0.0;
    fine.then(|| Model::Circle { center: mean + axes[0] * x + axes[1] * y, axis: axes[2], radius })
}

#[test]
fn the_peer_knows_clean_joints() {
    let door: Vec<Vector3<f64>> =
        (0..200).map(|i| f64::from(i) * 0.01).map(|a| Vector3::new(0.4 * a.cos(), 0.4 * a.sin(), 0.3)).collect();
    assert_eq!(decide(&door, 0.0, 1), Answer::Rotational);
    let drawer: Vec<Vector3<f64>> = (0..200).map(|i| Vector3::new(f64::from(i) * 0.002, 0.1, 0.2)).collect();
    assert_eq!(decide(&drawer, 0.0, 1), Answer::Prismatic);
    assert_eq!(decide(&vec![Vector3::new(0.1, 0.2, 0.3); 50], 0.0, 1), Answer::Rigid);
}
