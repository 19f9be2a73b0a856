//! Errors of a regression by resampling: the second opinion beside the covariance.
//!
//! Neighbouring rows of a mechanical log are alike, so whole blocks of them are drawn, with replacement, from the recording bent to a
//! circle (Künsch 1989; Politis & Romano 1992). A block's share of the normal equations is a difference of running sums, so that a
//! draw costs as much as its blocks, not as its rows.

use super::linear::LinearFit;
use crate::wanted;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Draws; the error of a standard error is then 4 %.
const DRAWS: usize = 300;
/// A block is this many correlation times long: what it cuts off at its ends is then an eighth of the variance …
const TIMES: f64 = 4.0;
/// … but there are no fewer than this many in the recording.
const LEAST_BLOCKS: usize = 12;

/// Standard error of each value of `fit` by a circular block bootstrap of its rows; `None` when they hold too few independent
/// stretches, or when a value is not identified.
///
/// `columns`: p columns of n samples, `rhs`: n, `weights`: n (absent: all 1), as the fit was made from. The draws are the same every
/// time: equal recordings give equal errors.
pub fn block_bootstrap(
    columns: &[Vec<f64>],
    rhs: &[f64],
    weights: Option<&[f64]>,
    fit: &LinearFit,
) -> Option<Vec<f64>> {
    // One stretch, all of it.
    let whole = 0..rhs.len();
    block_bootstrap_within(columns, rhs, weights, fit, std::slice::from_ref(&whole))
}

/// The same for rows of several events (rests, lifts): blocks are drawn within each event, bent to a circle of its own, so that every
/// event stays in every draw and what only one of them shows stays shown. A stretch of one row is kept as it is.
///
/// `stretches`: ranges of rows that follow each other and together hold all of them.
pub fn block_bootstrap_within(
    columns: &[Vec<f64>],
    rhs: &[f64],
    weights: Option<&[f64]>,
    fit: &LinearFit,
    stretches: &[Range<usize>],
) -> Option<Vec<f64>> {
    let (n, p) = (rhs.len(), columns.len());
    if n < 2 * LEAST_BLOCKS || p == 0 || !fit.identified.iter().all(|i| *i) {
        return None;
    }
    let apart = (n as f64 / fit.effective_samples.max(1.0)).max(1.0);
    let length = ((TIMES * apart).ceil() as usize).min(n / LEAST_BLOCKS).max(1);
    let length_in = |s: &Range<usize>| length.min(s.len().div_ceil(2)).max(1);
    let sums = RunningSums::new(columns, rhs, weights);
    let mut draw = Draws(0x9E37_79B9_7F4A_7C15);
    let mut values: Vec<DVector<f64>> = Vec::with_capacity(DRAWS);
    let mut total = vec![0.0; sums.width];
    for _ in 0..DRAWS {
        if !wanted::still() {
            return None;
        }
        total.fill(0.0);
        for stretch in stretches.iter().filter(|s| !s.is_empty()) {
            for _ in 0..stretch.len().div_ceil(length_in(stretch)) {
                sums.add(stretch.start + draw.below(stretch.len()), length_in(stretch), stretch, &mut total);
            }
        }
        values.extend(sums.solve(&total));
    }
    if values.len() < DRAWS / 2 {
        return None;
    }
    let count = values.len() as f64;
    // As the variance of a mean of few blocks, which is too small by one in their number in each stretch.
    let drawn = stretches.iter().filter(|s| s.len() > 1);
    let (blocks, parts) = drawn.fold((0.0, 0.0), |(b, k), s| (b + s.len().div_ceil(length_in(s)) as f64, k + 1.0));
    let few = (blocks / (blocks - parts).max(1.0)).sqrt();
    let error = |j: usize| {
        let mean = values.iter().map(|v| v[j]).sum::<f64>() / count;
        let variance = values.iter().map(|v| (v[j] - mean).powi(2)).sum::<f64>() / (count - 1.0);
        variance.sqrt() * few / sums.scales[j]
    };
    Some((0..p).map(error).collect())
}

/// Normal equations summed up to each row: the upper triangle of `XᵀWX` and `XᵀWy`, columns scaled to unit norm.
struct RunningSums {
    columns: usize,
    width: usize,
    scales: Vec<f64>,
    sums: Vec<f64>,
}

impl RunningSums {
    fn new(columns: &[Vec<f64>], rhs: &[f64], weights: Option<&[f64]>) -> Self {
        let p = columns.len();
        let width = p * (p + 1) / 2 + p;
        let weight = |i: usize| weights.map_or(1.0, |w| w[i].max(0.0));
        let norm = |c: &Vec<f64>| c.iter().enumerate().map(|(i, v)| weight(i) * v * v).sum::<f64>().sqrt();
        let scales: Vec<f64> = columns.iter().map(norm).map(|s| if s > 0.0 { s } else { 1.0 }).collect();
        let mut sums = vec![0.0; (rhs.len() + 1) * width];
        for i in 0..rhs.len() {
            let (before, after) = sums.split_at_mut((i + 1) * width);
            let (before, after) = (&before[i * width..], &mut after[..width]);
            let mut at = 0;
            for j in 0..p {
                let x = weight(i) * columns[j][i] / scales[j];
                for k in j..p {
                    after[at] = before[at] + x * columns[k][i] / scales[k];
                    at += 1;
                }
                let place = width - p + j;
                after[place] = before[place] + x * rhs[i];
            }
        }
        Self { columns: p, width, scales, sums }
    }

    /// Adds the block of `length` rows from `first` on, round the end of `stretch`.
    fn add(&self, first: usize, length: usize, stretch: &Range<usize>, total: &mut [f64]) {
        let at = |row: usize| &self.sums[row * self.width..(row + 1) * self.width];
        let mut part = |from: usize, to: usize| {
            for ((t, a), b) in total.iter_mut().zip(at(from)).zip(at(to)) {
                *t += b - a;
            }
        };
        let end = stretch.end;
        part(first, (first + length).min(end));
        if first + length > end {
            part(stretch.start, stretch.start + (first + length - end));
        }
    }

    fn solve(&self, total: &[f64]) -> Option<DVector<f64>> {
        let p = self.columns;
        let mut normal = DMatrix::zeros(p, p);
        let mut at = 0;
        for j in 0..p {
            for k in j..p {
                (normal[(j, k)], normal[(k, j)]) = (total[at], total[at]);
                at += 1;
            }
        }
        let right = DVector::from_column_slice(&total[self.width - p..]);
        normal.cholesky().map(|c| c.solve(&right))
    }
}

/// A small generator with a fixed start (xorshift64*): resampling needs no more.
struct Draws(u64);

impl Draws {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let word = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D);
        ((u128::from(word) * n as u128) >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::super::linear::least_squares;
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    #[test]
    fn its_intervals_hold_the_truth_under_white_and_correlated_noise() {
        let mut rng = StdRng::seed_from_u64(40);
        for (n, rho) in [(300, 0.0), (1000, 0.6), (3000, 0.9)] {
            let sine: Vec<f64> = (0..n).map(|i| (20.0 * f64::from(i) / f64::from(n)).sin()).collect();
            let columns = [vec![1.0; n as usize], sine];
            let trials = 300;
            let mut held = [0; 2];
            for _ in 0..trials {
                let mut state: f64 = rng.sample(StandardNormal);
                let rhs: Vec<f64> = (0..n as usize)
                    .map(|i| {
                        let shock: f64 = rng.sample(StandardNormal);
                        state = rho * state + (1.0_f64 - rho * rho).sqrt() * shock;
                        1.5 + 2.0 * columns[1][i] + state
                    })
                    .collect();
                let fit = least_squares(&columns, &rhs, None).expect("solves");
                let errors = block_bootstrap(&columns, &rhs, None, &fit).expect("enough rows");
                for (k, truth) in [1.5, 2.0].into_iter().enumerate() {
                    held[k] += usize::from((fit.values[k] - truth).abs() < 1.96 * errors[k]);
                }
            }
            println!("n {n} rho {rho}: {held:?} of {trials}");
            // A block bootstrap is known to be a little short: 0.90 to 0.975 with a standard error of 0.013.
            assert!(held.iter().all(|h| (262..=296).contains(h)), "n {n} rho {rho}: {held:?}");
        }
    }

    #[test]
    fn blocks_go_round_the_end_and_add_up() {
        let column: Vec<f64> = (0..30).map(f64::from).collect();
        let sums = RunningSums::new(&[vec![1.0; 30]], &column, None);
        let scale = 30.0_f64.sqrt();
        let mut total = vec![0.0; 2];
        sums.add(28, 4, &(0..30), &mut total);
        assert!((total[0] - 4.0 / 30.0).abs() < 1e-12);
        assert!((total[1] - (28.0 + 29.0 + 0.0 + 1.0) / scale).abs() < 1e-9);
    }

    #[test]
    fn events_that_alone_show_a_value_stay_in_every_draw() {
        // Four rests of 40 rows, each with a level of its own, and a slope that all share.
        let mut rng = StdRng::seed_from_u64(41);
        let stretches: Vec<Range<usize>> = (0..4).map(|k| 40 * k..40 * (k + 1)).collect();
        let mut columns: Vec<Vec<f64>> =
            stretches.iter().map(|s| (0..160).map(|i| f64::from(u8::from(s.contains(&i)))).collect()).collect();
        columns.push((0..160).map(|i| (0.37 * f64::from(i)).sin()).collect());
        let truth = [1.0, -2.0, 0.5, 3.0, 0.7];
        let (trials, mut held) = (200, [0; 5]);
        for _ in 0..trials {
            let rhs: Vec<f64> = (0..160)
                .map(|i| {
                    let noise: f64 = rng.sample(StandardNormal);
                    columns.iter().zip(truth).map(|(c, v)| c[i] * v).sum::<f64>() + noise
                })
                .collect();
            let fit = least_squares(&columns, &rhs, None).expect("solves");
            let errors = block_bootstrap_within(&columns, &rhs, None, &fit, &stretches).expect("enough rows");
            (0..5).for_each(|k| held[k] += usize::from((fit.values[k] - truth[k]).abs() < 1.96 * errors[k]));
        }
        println!("{held:?} of {trials}");
        assert!(held.iter().all(|h| (174..=198).contains(h)), "{held:?}");
    }

    #[test]
    fn too_little_gives_no_error() {
        let few = [vec![1.0; 10]];
        let fit = least_squares(&few, &[2.0; 10], None).expect("solves");
        assert!(block_bootstrap(&few, &[2.0; 10], None, &fit).is_none());
    }
}
