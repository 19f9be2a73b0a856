//! Force on a carried object that its weight and inertia do not explain: something else holds it, a cable for instance.
//!
//! A hand that carries something exerts its weight and its inertial force. The horizontal part of the residual is
//! watched by the same likelihood-ratio sums as the weight ([`super::super::change`]), from zero on and with a stated
//! rate of false alarms. A slow carry sways the object, and the sums learn by how much. Rows in which something pulls
//! tell nothing about the weight.
//!
//! A pull from a point (a cable) follows lines that meet there: the anchor is their common point by weighted least
//! squares. Its errors are those of the directions and the common errors of all lines by biases and the pads' give.

use super::super::change::ChangeDetector;
use super::super::decimating_store::DecimatingStore;
use haptics::Vec2;
use nalgebra::{Matrix2, SymmetricEigen};
use serde::Serialize;

/// A pull that matters, N.
const MATTERS_N: f64 = 0.03;
/// Residual by pads, swinging and geometry, as a share of the weight.
const MODEL_SHARE: f64 = 0.01;
/// Size of a row in standard deviations of the sensors above which it teaches nothing about the weight.
const SUSPECT: f64 = 6.0;
/// Number of suspect rows on one side in a row that are a pull before the sums have learned the usual residual.
const IN_A_ROW: u32 = 10;
/// Number of rows without a pull that end it.
const CALM_ROWS: u32 = 8;
/// A line counts once its pull is known to this share.
const LINE_SHARE: f64 = 0.2;
/// Largest distance of the grasp from the point of attack of the pull, m: the pads compress and shear.
const GRASP_M: f64 = 1e-3;
/// An anchor is told when no direction is less certain than this, m.
const TELL_M: f64 = 0.012;
/// Number of neighbouring rows of one pull that count as one: their errors are alike.
const ALIKE: f64 = 5.0;
/// Lines that are kept.
const LINES: usize = 160;

/// Common point of lines of force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Anchor {
    /// m in the world.
    pub at_m: Vec2,
    /// Half axes of one standard error, m each, the longer one first.
    pub axes_m: [Vec2; 2],
}

/// Something that holds a carried object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pull {
    /// Index of the object, from 0.
    pub object: usize,
    /// Time at which it set in, s.
    pub began_s: f64,
    /// True while it pulls.
    pub pulls: bool,
    /// Its newest force on the object, N.
    pub force_n: Vec2,
    /// Standard error of its size, N.
    pub std_error_n: f64,
    /// Position of the object then, m in the world.
    pub at_m: Vec2,
    /// Point to which it is tied, once the directions of the pull tell.
    pub anchor: Option<Anchor>,
}

/// One carried row, weight and bias taken out.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Left {
    pub(crate) time_s: f64,
    pub(crate) at_m: Vec2,
    /// Force of the hand that weight and inertia do not explain, N.
    pub(crate) force_n: Vec2,
    /// Noise of a row, N.
    pub(crate) noise_n: f64,
    /// Common error of all rows, N: only vertical forces contain the weight's error.
    pub(crate) common_n: Vec2,
}

impl Left {
    /// Model error of the force, N, for a weight.
    pub(crate) fn model_n(weight_n: f64) -> f64 {
        MODEL_SHARE * weight_n.abs()
    }

    fn suspect(&self) -> bool {
        self.force_n.x.abs() > MATTERS_N + SUSPECT * self.noise_n + 2.0 * self.common_n.x
    }

    /// Standard error of the force's size, N.
    fn size_error_n(&self) -> f64 {
        let along = self.force_n.try_normalize(1e-12).unwrap_or_else(Vec2::x);
        self.noise_n.hypot(along.component_mul(&self.common_n).norm())
    }
}

/// The watch over one object.
#[derive(Clone, Debug)]
pub(crate) struct Hold {
    detector: ChangeDetector<1>,
    suspects: (f64, u32),
    calm: u32,
    began_s: Option<f64>,
    pulls: bool,
    newest: Option<Left>,
    /// Time, place and force of the hand, row by row.
    lines: DecimatingStore<5>,
}

impl Hold {
    pub(crate) fn new(false_alarms_per_hour: f64, row_s: f64) -> Self {
        Self {
            detector: ChangeDetector::new(false_alarms_per_hour, row_s, [MATTERS_N]),
            suspects: (0.0, 0),
            calm: 0,
            began_s: None,
            pulls: false,
            newest: None,
            lines: DecimatingStore::new(LINES),
        }
    }

    pub(crate) fn clear(&mut self) {
        self.detector.restart(0.0);
        self.lines.clear();
        (self.suspects, self.calm, self.began_s, self.pulls, self.newest) = ((0.0, 0), 0, None, false, None);
    }

    /// Takes a row; true when it tells nothing about the weight.
    pub(crate) fn take(&mut self, left: &Left) -> bool {
        let suspect = left.suspect();
        self.count(left, suspect);
        if !self.pulls {
            // A suspect row is tested, but does not teach the usual residual before that is known.
            let change = self.detector.push(left.time_s, &[1.0], left.force_n.x, 0.0);
            let began_s = change.map(|c| c.began_s).or((self.suspects.1 >= IN_A_ROW).then_some(left.time_s));
            if let Some(began_s) = began_s {
                (self.pulls, self.calm) = (true, 0);
                self.began_s.get_or_insert(began_s);
            }
        }
        if self.pulls {
            self.keep(left, suspect);
        }
        suspect || self.pulls
    }

    fn count(&mut self, left: &Left, suspect: bool) {
        let side = left.force_n.x.signum();
        self.suspects = match (suspect, side == self.suspects.0) {
            (true, true) => (side, self.suspects.1 + 1),
            (true, false) => (side, 1),
            (false, _) => (0.0, 0),
        };
    }

    fn keep(&mut self, left: &Left, suspect: bool) {
        if suspect {
            self.calm = 0;
            self.newest = Some(*left);
            if left.noise_n.hypot(left.common_n.norm()) < LINE_SHARE * left.force_n.norm() {
                self.lines.push([left.time_s, left.at_m.x, left.at_m.y, left.force_n.x, left.force_n.y]);
            }
        } else {
            self.calm += 1;
            if self.calm >= CALM_ROWS {
                self.pulls = false;
                self.detector.restart(left.time_s);
            }
        }
    }

    /// Held for an interruption: it is not known any more whether it still pulls.
    pub(crate) fn let_go(&mut self) {
        (self.pulls, self.suspects) = (false, (0.0, 0));
    }

    /// Pull on the object. Allocates.
    pub(crate) fn pull(&self, object: usize) -> Option<Pull> {
        let (began_s, newest) = (self.began_s?, self.newest?);
        Some(Pull {
            object,
            began_s,
            pulls: self.pulls,
            force_n: -newest.force_n,
            std_error_n: newest.size_error_n(),
            at_m: newest.at_m,
            anchor: self.anchor(&newest),
        })
    }

    fn anchor(&self, newest: &Left) -> Option<Anchor> {
        let lines: Vec<Line> = self.lines.rows().iter().map(|r| Line::new(r, Vec2::zeros(), Vec2::zeros())).collect();
        let (at_m, random) = meet(&lines, newest.noise_n)?;
        // It is on the side that the object is pulled to.
        let behind = lines.iter().filter(|line| (at_m - line.at_m).dot(&line.along) < 0.0).count();
        if 10 * behind > lines.len() {
            return None;
        }
        let moved = |place: Vec2, force: Vec2| {
            let lines: Vec<Line> = self.lines.rows().iter().map(|r| Line::new(r, place, force)).collect();
            meet(&lines, newest.noise_n).map(|(there, _)| there - at_m)
        };
        let mut covariance = random * ALIKE;
        for axis in [Vec2::x(), Vec2::y()] {
            let common_n = newest.common_n.component_mul(&axis);
            let by = [moved(GRASP_M * axis, Vec2::zeros())?, moved(Vec2::zeros(), common_n)?];
            covariance += by.iter().map(|d| d * d.transpose()).sum::<Matrix2<f64>>();
        }
        let eigen = SymmetricEigen::new(covariance);
        let order = if eigen.eigenvalues[0] >= eigen.eigenvalues[1] { [0, 1] } else { [1, 0] };
        let axes_m = order.map(|k| eigen.eigenvectors.column(k) * eigen.eigenvalues[k].max(0.0).sqrt());
        (axes_m[0].norm() < TELL_M).then_some(Anchor { at_m, axes_m })
    }
}

/// A line of force.
struct Line {
    at_m: Vec2,
    /// Unit vector that the object is pulled along.
    along: Vec2,
    size_n: f64,
}

impl Line {
    fn new(row: &[f64; 5], place: Vec2, force: Vec2) -> Self {
        let force_n = Vec2::new(row[3], row[4]) + force;
        let size_n = force_n.norm().max(1e-9);
        Self { at_m: Vec2::new(row[1], row[2]) + place, along: -force_n / size_n, size_n }
    }
}

/// The point nearest to all lines, and its covariance if their errors were independent, m²; `None` when they are as good as parallel.
///
/// Noise turns the lines, and lines that are turned at random seem to meet: the mean effect of noise is taken out of
/// the normal equations, as for any regression with errors in the variables.
fn meet(lines: &[Line], noise_n: f64) -> Option<(Vec2, Matrix2<f64>)> {
    const LEAST: usize = 6;
    /// A first guess of the distance; two more rounds take the result. Nothing is tied nearer than the least.
    const FAR_M: f64 = 0.05;
    const LEAST_FAR_M: f64 = 0.01;
    /// Least information in the weakest direction, in multiples of the part by noise alone.
    const BEYOND_NOISE: f64 = 1.0;
    if lines.len() < LEAST {
        return None;
    }
    let mut found: Option<(Vec2, Matrix2<f64>)> = None;
    for _ in 0..3 {
        let (mut information, mut by_noise, mut sum) = (Matrix2::zeros(), Matrix2::zeros(), Vec2::zeros());
        for line in lines {
            let far_m = found.map_or(FAR_M, |(at, _)| (at - line.at_m).norm().max(LEAST_FAR_M));
            let turn = noise_n / line.size_n;
            let error_m = (far_m * turn).hypot(2e-4);
            let normal = Vec2::new(-line.along.y, line.along.x) / error_m;
            let turned = line.along * turn / error_m;
            let extra = turned * turned.transpose();
            let part = normal * normal.transpose() - extra;
            information += part;
            by_noise += extra;
            sum += part * line.at_m;
        }
        let eigen = SymmetricEigen::new(information);
        let weakest = eigen.eigenvalues.imin();
        let direction = eigen.eigenvectors.column(weakest).into_owned();
        let of_noise = (direction.transpose() * by_noise * direction).x;
        if eigen.eigenvalues[weakest] < BEYOND_NOISE * of_noise {
            return None;
        }
        let covariance = information.try_inverse()?;
        found = Some((covariance * sum, covariance));
    }
    found.filter(|(at, covariance)| at.iter().chain(covariance.iter()).all(|v| v.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW_S: f64 = 0.03;
    const NOISE_N: f64 = 0.004;

    fn noise(index: usize) -> f64 {
        // Even over the unit interval, by the golden ratio.
        NOISE_N * 12.0_f64.sqrt() * ((index as f64 * 0.618_033_988_75).fract() - 0.5)
    }

    fn left(index: usize, at_m: Vec2, pull_n: Vec2) -> Left {
        let force_n = Vec2::new(noise(2 * index), noise(2 * index + 1)) - pull_n;
        Left { time_s: index as f64 * ROW_S, at_m, force_n, noise_n: NOISE_N, common_n: Vec2::new(0.002, 0.002) }
    }

    #[test]
    fn an_anchor_is_where_the_lines_of_a_cable_meet() {
        let anchor_m = Vec2::new(-0.03, -0.1);
        let mut hold = Hold::new(0.2, ROW_S);
        for i in 0..60 {
            assert!(!hold.take(&left(i, Vec2::new(0.0, -0.05), Vec2::zeros())), "row {i}");
        }
        assert_eq!(hold.pull(0), None);
        for i in 60..120 {
            let at_m = Vec2::new(0.001 * (i - 60) as f64 - 0.03, -0.06);
            let toward = (anchor_m - at_m).normalize();
            hold.take(&left(i, at_m, 0.4 * toward));
        }
        let pull = hold.pull(0).expect("found");
        assert!(pull.pulls && (pull.began_s - 60.0 * ROW_S).abs() < 0.3, "{pull:?}");
        let anchor = pull.anchor.expect("lines from many sides");
        assert!((anchor.at_m - anchor_m).norm() < 3.0 * anchor.axes_m[0].norm(), "{anchor:?}");
        assert!(anchor.axes_m[0].norm() < 0.006, "{anchor:?}");
    }

    #[test]
    fn one_direction_tells_a_line_and_no_anchor() {
        let mut hold = Hold::new(0.2, ROW_S);
        for i in 0..60 {
            hold.take(&left(i, Vec2::zeros(), Vec2::zeros()));
        }
        for i in 60..100 {
            hold.take(&left(i, Vec2::zeros(), Vec2::new(-0.3, -0.1)));
        }
        let pull = hold.pull(0).expect("found");
        assert_eq!(pull.anchor, None);
        assert!((pull.force_n - Vec2::new(-0.3, -0.1)).norm() < 5.0 * NOISE_N);
        for i in 100..130 {
            hold.take(&left(i, Vec2::zeros(), Vec2::zeros()));
        }
        assert!(!hold.pull(0).expect("known").pulls);
    }
}
