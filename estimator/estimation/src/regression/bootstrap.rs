//! Errors of a regression by resampling: the second opinion beside the covariance.
//!
//! Neighbouring rows of a mechanical log are alike, so whole blocks of them are drawn, with replacement, from the
//! recording bent to a circle (Künsch 1989; Politis & Romano 1992). A block's share of the normal equations is a
//! difference of running sums: the cost of a draw depends on the number of its blocks, not of its rows.

use super::linear::{LinearFit, least_squares};
use foundation::cancellation;
use nalgebra::{DMatrix, DVector};
use std::ops::{Index, Range};

/// Number of draws.
/// Derived: about 1/(2 · 0.04²), for an error of 4 % of a standard error.
const DRAWS: usize = 300;
/// Length of a block in correlation times.
/// Derived: the correlation cut off at its ends is then an eighth of the variance, 1/(2 · 4).
const TIMES: f64 = 4.0;
/// Least number of blocks in the recording.
const LEAST_BLOCKS: usize = 12;
/// Largest number of values of which a median is drawn.
const MOST_OF_A_MEDIAN: usize = 2000;
/// Least number of values that have a scatter.
const LEAST_OF_FEW: usize = 3;
/// Seed of every draw: equal recordings have equal errors.
/// Derived: 2⁶⁴ over the golden ratio, to an odd number.
const START: u64 = 0x9E37_79B9_7F4A_7C15;

/// Result of a resampling of p values: their covariance, and each one's standard error.
#[derive(Clone, Debug)]
pub struct Resampled {
    covariance: DMatrix<f64>,
    errors: Vec<f64>,
}

impl Resampled {
    fn new(covariance: DMatrix<f64>) -> Self {
        let errors = covariance.diagonal().iter().map(|v| v.max(0.0).sqrt()).collect();
        Self { covariance, errors }
    }

    /// Standard errors, one a value.
    pub fn errors(&self) -> &[f64] {
        &self.errors
    }

    /// p × p, in the units of the values.
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Adds an error of each value that is not in the draws, independent of them.
    #[must_use]
    pub fn widened(mut self, errors: &[f64]) -> Self {
        for (j, error) in errors.iter().enumerate().take(self.errors.len()) {
            self.covariance[(j, j)] += error * error;
        }
        Self::new(self.covariance)
    }

    /// Multiplies every value (and its error) by a factor.
    #[must_use]
    pub fn scaled(self, by: &[f64]) -> Self {
        let p = self.errors.len();
        Self::new(DMatrix::from_fn(p, p, |i, j| by[i] * by[j] * self.covariance[(i, j)]))
    }
}

impl Index<usize> for Resampled {
    type Output = f64;

    /// Standard error of a value.
    fn index(&self, value: usize) -> &f64 {
        &self.errors[value]
    }
}

/// Standard error of each value of `fit` by a circular block bootstrap of its rows; `None` if they hold too few
/// independent blocks, or if a value is not identified.
///
/// `columns`: p regressors of n samples, `rhs`: n, `weights`: n (absent: all 1), as in the fit. The draws are the same
/// every time.
pub fn block_bootstrap(
    columns: &[Vec<f64>],
    rhs: &[f64],
    weights: Option<&[f64]>,
    fit: &LinearFit,
) -> Option<Resampled> {
    // One segment, all of it.
    let whole = 0..rhs.len();
    block_bootstrap_within(columns, rhs, weights, fit, std::slice::from_ref(&whole))
}

/// The same for rows of several events (rests, lifts). Blocks are drawn within each event, bent to a circle of its own,
/// so that every event stays in every draw and values that only one of them shows stay identified. A segment of one row
/// is kept as it is.
///
/// `stretches`: ranges of rows that follow each other and together hold all of them.
pub fn block_bootstrap_within(
    columns: &[Vec<f64>],
    rhs: &[f64],
    weights: Option<&[f64]>,
    fit: &LinearFit,
    stretches: &[Range<usize>],
) -> Option<Resampled> {
    let (n, p) = (rhs.len(), columns.len());
    if n < 2 * LEAST_BLOCKS || p == 0 || !fit.identified.iter().all(|i| *i) {
        return None;
    }
    let length = block_length(n, fit.effective_samples);
    let length_in = |s: &Range<usize>| length.min(s.len().div_ceil(2)).max(1);
    let sums = RunningSums::new(columns, rhs, weights);
    let mut draw = Draws(START);
    let mut values: Vec<DVector<f64>> = Vec::with_capacity(DRAWS);
    let mut total = vec![0.0; sums.width];
    for _ in 0..DRAWS {
        if !cancellation::is_wanted() {
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
    // Correction as for the variance of a mean of few blocks, which is too small by one in their number in each
    // segment.
    let drawn = stretches.iter().filter(|s| s.len() > 1);
    let (blocks, parts) = drawn.fold((0.0, 0.0), |(b, k), s| (b + s.len().div_ceil(length_in(s)) as f64, k + 1.0));
    let few = (blocks / (blocks - parts).max(1.0)).sqrt();
    let mean = values.iter().sum::<DVector<f64>>() / count;
    let mut covariance = DMatrix::zeros(p, p);
    for value in &values {
        let off = value - &mean;
        covariance += &off * off.transpose() / (count - 1.0);
    }
    let scale: Vec<f64> = sums.scales.iter().map(|s| few / s).collect();
    Some(Resampled::new(covariance).scaled(&scale))
}

/// Standard error of the median of `values` by a circular block bootstrap; `None` if they hold too few independent
/// blocks.
///
/// `values`: n in order of time; of many, evenly spaced ones are taken.
pub fn median_error(values: &[f64]) -> Option<f64> {
    let values: Vec<f64> = values.iter().copied().step_by(values.len().div_ceil(MOST_OF_A_MEDIAN).max(1)).collect();
    let n = values.len();
    if n < 2 * LEAST_BLOCKS {
        return None;
    }
    let length = block_length(n, least_squares(&[vec![1.0; n]], &values, None).ok()?.effective_samples);
    let mut draw = Draws(START);
    let (mut drawn, mut medians) = (Vec::with_capacity(n + length), Vec::with_capacity(DRAWS));
    for _ in 0..DRAWS {
        drawn.clear();
        while drawn.len() < n {
            let first = draw.below(n);
            drawn.extend((first..first + length).map(|i| values[i % n]));
        }
        drawn.truncate(n);
        medians.push(*drawn.select_nth_unstable_by(n / 2, f64::total_cmp).1);
    }
    let blocks = n.div_ceil(length) as f64;
    Some(spread(&medians) * (blocks / (blocks - 1.0)).sqrt())
}

/// Standard error of the median of `values` that do not depend on each other, by drawing them; `None` for fewer than three.
pub fn median_error_of_few(values: &[f64]) -> Option<f64> {
    let n = values.len();
    if n < LEAST_OF_FEW {
        return None;
    }
    let mut draw = Draws(START);
    let median = |_| {
        let mut drawn: Vec<f64> = (0..n).map(|_| values[draw.below(n)]).collect();
        *drawn.select_nth_unstable_by(n / 2, f64::total_cmp).1
    };
    let medians: Vec<f64> = (0..DRAWS).map(median).collect();
    Some(spread(&medians) * (n as f64 / (n as f64 - 1.0)).sqrt())
}

fn spread(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt()
}

/// Length of a block among `n` rows with this number of effective samples.
fn block_length(n: usize, effective_samples: f64) -> usize {
    let apart = (n as f64 / effective_samples.max(1.0)).max(1.0);
    ((TIMES * apart).ceil() as usize).min(n / LEAST_BLOCKS).max(1)
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

    /// Adds the block of `length` rows from `first` on, round the end of the segment `stretch`.
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
    fn what_goes_together_is_drawn_together() {
        let mut rng = StdRng::seed_from_u64(43);
        // Level and slope of a line that is seen far from its zero.
        let place: Vec<f64> = (0..800).map(|i| 2.0 + 0.001 * f64::from(i)).collect();
        let columns = [vec![1.0; 800], place.clone()];
        let rhs: Vec<f64> = place.iter().map(|x| 1.0 + 3.0 * x + 0.1 * rng.sample::<f64, _>(StandardNormal)).collect();
        let fit = least_squares(&columns, &rhs, None).expect("solves");
        let drawn = block_bootstrap(&columns, &rhs, None, &fit).expect("enough rows");
        let together = |c: &DMatrix<f64>| c[(0, 1)] / (c[(0, 0)] * c[(1, 1)]).sqrt();
        println!("{} by covariance, {} drawn", together(&fit.covariance), together(drawn.covariance()));
        assert!(
            together(drawn.covariance()) < -0.98
                && (together(drawn.covariance()) - together(&fit.covariance)).abs() < 0.01
        );
        let wider = drawn.clone().widened(&[0.3, 0.0]);
        assert!((wider[0] - drawn[0].hypot(0.3)).abs() < 1e-12 && (wider[1] - drawn[1]).abs() < 1e-12);
    }

    #[test]
    fn the_error_of_a_median_is_that_of_its_scatter() {
        let mut rng = StdRng::seed_from_u64(44);
        for rho in [0.0, 0.8_f64] {
            let (trials, mut held, mut medians, mut errors) = (300, 0, Vec::new(), 0.0);
            for _ in 0..trials {
                let mut state: f64 = rng.sample(StandardNormal);
                let mut values: Vec<f64> = (0..600)
                    .map(|_| {
                        state = rho * state + (1.0 - rho * rho).sqrt() * rng.sample::<f64, _>(StandardNormal);
                        state
                    })
                    .collect();
                let error = median_error(&values).expect("enough");
                let median = *values.select_nth_unstable_by(300, f64::total_cmp).1;
                medians.push(median);
                errors += error / f64::from(trials);
                held += usize::from(median.abs() < 1.96 * error);
            }
            println!("rho {rho}: {held} of {trials} hold; {errors} stated, {} true", spread(&medians));
            assert!((0.8..1.25).contains(&(errors / spread(&medians))) && (264..=298).contains(&held), "rho {rho}");
        }
        assert!(median_error(&[0.0; 10]).is_none() && median_error_of_few(&[1.0, 2.0]).is_none());
        // The middle one of seven that scatter by one: 0.46 of it.
        let mean = (0..400).map(|_| median_error_of_few(&[0; 7].map(|_| rng.sample(StandardNormal))).expect("seven"));
        let mean = mean.sum::<f64>() / 400.0;
        println!("of seven: {mean}");
        assert!((0.38..0.62).contains(&mean), "{mean}");
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
