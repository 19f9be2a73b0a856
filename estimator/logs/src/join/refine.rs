//! Offset and ratio of two clocks by least squares, with standard errors that hold for correlated residuals.

use super::grid::Grid;

/// Samples at the ends of an overlap that take no part: shifts of the search stay within them.
const MARGIN: f64 = 8.0;
/// Change of a parameter for differences, steps of the grid.
const DELTA: f64 = 1.0;
/// Longest move of one iteration, steps of the grid.
const LONGEST_MOVE: f64 = 4.0;
/// Most iterations.
const ITERATIONS: usize = 50;
/// Move at which the search ends, steps of the grid: a thousandth of the standard errors of the tests.
const CONVERGED: f64 = 1e-5;

/// Samples of the log's grid that overlap with the other's.
pub struct Overlap<'a> {
    own: &'a Grid,
    other: &'a Grid,
    /// Places on the log's grid.
    places: Vec<usize>,
    /// Middle of the overlap, and half its length, as places on the log's grid.
    middle: f64,
    half: f64,
}

/// Shift of the other's grid in steps: at the middle of the overlap, and what is added at its end.
type Shift = [f64; 2];

/// Minimum of the squares.
#[derive(Clone, Copy, Debug)]
pub struct Minimum {
    /// Shift at the middle of the overlap, and what is added at its end, steps of the grid.
    pub shift: Shift,
    /// Standard errors of both.
    pub errors: Shift,
    /// Sum of the squares of the residuals.
    pub squares: f64,
}

impl<'a> Overlap<'a> {
    /// Samples that overlap after the other grid was moved by `shift` steps to later places.
    pub fn new(own: &'a Grid, other: &'a Grid, shift: f64) -> Option<Self> {
        let last = other.values.len() as f64 - 1.0;
        let is_inside = |place: f64| (MARGIN..=last - MARGIN).contains(&place) && other.is_measured(place);
        let places: Vec<usize> =
            (0..own.values.len()).filter(|&i| own.weight[i] > 0.0 && is_inside(i as f64 - shift)).collect();
        let (first, end) = (*places.first()? as f64, *places.last()? as f64);
        let (middle, half) = (0.5 * (first + end), 0.5 * (end - first));
        (half > 0.0).then_some(Self { own, other, places, middle, half })
    }

    /// Middle of the overlap, and half its length, as places on the log's grid.
    pub fn extent(&self) -> (f64, f64) {
        (self.middle, self.half)
    }

    /// Both signals over the overlap, each with zero mean: the log's, and the other's at `shift`.
    pub fn series(&self, shift: Shift) -> [Vec<f64>; 2] {
        let place = |i: usize| i as f64 - shift[0] - shift[1] * (i as f64 - self.middle) / self.half;
        let own = self.places.iter().map(|&i| self.own.values[i]).collect();
        let other = self.places.iter().map(|&i| self.other.at(place(i))).collect();
        [own, other].map(|mut series: Vec<f64>| {
            let mean = series.iter().sum::<f64>() / series.len() as f64;
            for value in &mut series {
                *value -= mean;
            }
            series
        })
    }

    /// Residuals of the log's signal against the other's, with gain and bias by least squares.
    fn residuals(&self, shift: Shift) -> Vec<f64> {
        let [own, other] = self.series(shift);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let gain = dot(&own, &other) / dot(&other, &other).max(f64::MIN_POSITIVE);
        own.iter().zip(&other).map(|(a, b)| a - gain * b).collect()
    }

    fn squares(&self, shift: Shift) -> f64 {
        self.residuals(shift).iter().map(|r| r * r).sum()
    }

    /// Minimum near `from` by Newton's method. The second derivatives are those of the squares themselves: noise of the other
    /// signal makes the usual product of slopes too large. `count`: 1 for the offset alone, 2 with the ratio of the clocks.
    pub fn minimum(&self, from: Shift, count: usize) -> Option<Minimum> {
        let mut shift = from;
        for _ in 0..ITERATIONS {
            let (slope, bend) = self.derivatives(shift, count);
            let inverse = inverse(bend)?;
            let step = [0, 1].map(|k| -(inverse[k][0] * slope[0] + inverse[k][1] * slope[1]));
            for k in 0..count {
                shift[k] += step[k].clamp(-LONGEST_MOVE, LONGEST_MOVE);
            }
            if step.iter().all(|move_| move_.abs() < CONVERGED) {
                break;
            }
        }
        let (_, bend) = self.derivatives(shift, count);
        let inverse = inverse(bend)?;
        let residuals = self.residuals(shift);
        let slopes = [0, 1].map(|k| {
            let (up, down) = (self.residuals(moved(shift, k, DELTA)), self.residuals(moved(shift, k, -DELTA)));
            let score = |((r, up), down): ((&f64, &f64), &f64)| r * (up - down) / DELTA;
            residuals.iter().zip(&up).zip(&down).map(score).collect::<Vec<f64>>()
        });
        let influence = |k: usize| -> Vec<f64> {
            slopes[0].iter().zip(&slopes[1]).map(|(a, b)| inverse[k][0] * a + inverse[k][1] * b).collect()
        };
        let errors = [0, 1].map(|k| if k < count { variance_of_the_sum(&influence(k)).sqrt() } else { 0.0 });
        Some(Minimum { shift, errors, squares: residuals.iter().map(|r| r * r).sum() })
    }

    /// Slopes and second derivatives of the squares; of a parameter that is held, 0 and 1.
    fn derivatives(&self, shift: Shift, count: usize) -> (Shift, [Shift; 2]) {
        let at = |a: f64, b: f64| self.squares([shift[0] + a * DELTA, shift[1] + b * DELTA]);
        let here = at(0.0, 0.0);
        let (up, down) = (at(1.0, 0.0), at(-1.0, 0.0));
        let bend = (up - 2.0 * here + down) / (DELTA * DELTA);
        let slope = 0.5 * (up - down) / DELTA;
        if count == 1 {
            return ([slope, 0.0], [[bend, 0.0], [0.0, 1.0]]);
        }
        let (up, down) = (at(0.0, 1.0), at(0.0, -1.0));
        let second = (up - 2.0 * here + down) / (DELTA * DELTA);
        let mixed = 0.25 * (at(1.0, 1.0) - at(1.0, -1.0) - at(-1.0, 1.0) + at(-1.0, -1.0)) / (DELTA * DELTA);
        ([slope, 0.5 * (up - down) / DELTA], [[bend, mixed], [mixed, second]])
    }
}

fn moved(mut shift: Shift, k: usize, by: f64) -> Shift {
    shift[k] += by;
    shift
}

/// Inverse of a symmetric matrix; none unless it is positive definite.
fn inverse([[a, b], [_, d]]: [Shift; 2]) -> Option<[Shift; 2]> {
    let determinant = a * d - b * b;
    (a > 0.0 && determinant > 0.0).then(|| [[d / determinant, -b / determinant], [-b / determinant, a / determinant]])
}

/// Variance of the sum of a correlated series with zero mean: autocovariances are added in pairs as long as those are
/// positive (initial positive sequence, Geyer 1992).
fn variance_of_the_sum(series: &[f64]) -> f64 {
    let covariance = |lag: usize| -> f64 { series.iter().zip(&series[lag..]).map(|(a, b)| a * b).sum() };
    let mut sum = -covariance(0);
    for pair in 0..series.len() / 4 {
        let both = covariance(2 * pair) + covariance(2 * pair + 1);
        if both <= 0.0 {
            break;
        }
        sum += 2.0 * both;
    }
    sum.max(0.0)
}
