//! Robust least squares for contacts that ring: a few far outliers do not decide.
//!
//! Residuals with heavier tails than Gaussian noise are treated with Tukey's bisquare by iteratively reweighted least
//! squares (Beaton & Tukey 1974; Holland & Welsch 1977). Otherwise the result is the plain fit, to the bit.

use super::linear::{LinearFit, least_squares};
use foundation::estimate::EstimateError;
use statrs::statistics::{Data, OrderStatistics};

/// Size of a residual from which it does not count at all, in standard deviations.
/// Source: Holland & Welsch 1977: 95 % efficiency under Gaussian noise.
const BISQUARE: f64 = 4.685;
/// Size of a residual in the tail, standard deviations: one in two million under Gaussian noise.
const TAIL: f64 = 5.0;
/// Share of the samples in the tail from which it is heavy; at least two of them.
const HEAVY: f64 = 0.004;
/// Largest number of rounds of reweighting; it settles in a handful.
const REWEIGHTING_ROUNDS: usize = 20;

/// A fit, and how it was made.
#[derive(Clone, Debug)]
pub struct RobustFit {
    /// As from [`least_squares`], its errors those of the reweighted fit.
    pub fit: LinearFit,
    /// The weights that it ended with (the given ones times the bisquare's); `None` when the plain fit was good.
    pub weights: Option<Vec<f64>>,
    /// Share of the samples that do not count at all.
    pub left_out: f64,
}

/// [`least_squares`], robust where the residuals ask for it.
pub fn robust(columns: &[Vec<f64>], rhs: &[f64], weights: Option<&[f64]>) -> Result<RobustFit, EstimateError> {
    let plain = least_squares(columns, rhs, weights)?;
    let given = |i: usize| weights.map_or(1.0, |w| w[i].max(0.0));
    let sized =
        |fit: &LinearFit| -> Vec<f64> { fit.residuals.iter().enumerate().map(|(i, r)| r * given(i).sqrt()).collect() };
    let used = (0..rhs.len()).filter(|i| given(*i) > 0.0).count();
    let mut residuals = sized(&plain);
    let mut sigma = spread(&residuals, &given);
    let far = residuals.iter().filter(|r| r.abs() > TAIL * sigma).count();
    if sigma <= 0.0 || far < 2 || (far as f64) < HEAVY * used as f64 {
        return Ok(RobustFit { fit: plain, weights: None, left_out: 0.0 });
    }
    let mut fit = plain;
    let mut total = Vec::new();
    for _ in 0..REWEIGHTING_ROUNDS {
        total = residuals.iter().enumerate().map(|(i, r)| given(i) * bisquare(r / sigma)).collect();
        let next = least_squares(columns, rhs, Some(&total))?;
        let moved =
            next.values.iter().zip(&fit.values).zip(&next.std_errors).any(|((a, b), e)| (a - b).abs() > 1e-3 * e);
        fit = next;
        residuals = sized(&fit);
        sigma = spread(&residuals, &given);
        if !moved {
            break;
        }
    }
    // The errors of an M-estimate are larger than those of a fit with these weights. The factor is the mean weight over
    // the mean slope of the influence function (Huber 1981, §7.6).
    let (weight, slope) = residuals
        .iter()
        .enumerate()
        .filter(|(i, _)| given(*i) > 0.0)
        .fold((0.0, 0.0), |(w, s), (_, r)| (w + bisquare(r / sigma), s + bisquare_slope(r / sigma)));
    let wider = (weight / slope.max(0.1 * weight)).max(1.0);
    fit.covariance *= wider * wider;
    fit.std_errors.iter_mut().for_each(|e| *e *= wider);
    let left_out = total.iter().enumerate().filter(|(i, t)| given(*i) > 0.0 && **t == 0.0).count();
    Ok(RobustFit { fit, weights: Some(total), left_out: left_out as f64 / used.max(1) as f64 })
}

fn bisquare(u: f64) -> f64 {
    let share = 1.0 - (u / BISQUARE).powi(2);
    if share > 0.0 { share * share } else { 0.0 }
}

/// Derivative of u · bisquare(u).
fn bisquare_slope(u: f64) -> f64 {
    let square = (u / BISQUARE).powi(2);
    if square < 1.0 { (1.0 - square) * (1.0 - 5.0 * square) } else { 0.0 }
}

/// Standard deviation by the median of the sizes, which a tail does not change.
fn spread(residuals: &[f64], given: &dyn Fn(usize) -> f64) -> f64 {
    let sizes: Vec<f64> = residuals.iter().enumerate().filter(|(i, _)| given(*i) > 0.0).map(|(_, r)| r.abs()).collect();
    if sizes.is_empty() { 0.0 } else { 1.4826 * Data::new(sizes).median() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _, rngs::StdRng};
    use rand_distr::StandardNormal;

    /// A constant of 2 in noise of 0.1, with a burst of one-sided ringing in a share of the samples.
    fn ringing(rng: &mut StdRng, n: usize, share: f64) -> Vec<f64> {
        let first = rng.random_range(0..n / 2);
        let burst = (share * n as f64) as usize;
        (0..n)
            .map(|i| {
                let noise: f64 = rng.sample(StandardNormal);
                let since = i as f64 - first as f64;
                let rings = i >= first && i < first + burst;
                2.0 + 0.1 * noise + if rings { 3.0 * (0.7 * since).sin().abs() + 0.8 } else { 0.0 }
            })
            .collect()
    }

    #[test]
    fn a_contact_that_rings_does_not_move_the_answer() {
        let mut rng = StdRng::seed_from_u64(50);
        let columns = [vec![1.0; 400]];
        let mut held = 0;
        for _ in 0..300 {
            let rhs = ringing(&mut rng, 400, 0.06);
            let found = robust(&columns, &rhs, None).expect("solves");
            assert!(found.weights.is_some() && found.left_out > 0.03);
            held += usize::from((found.fit.values[0] - 2.0).abs() < 1.96 * found.fit.std_errors[0]);
            let plain = least_squares(&columns, &rhs, None).expect("solves").values[0];
            assert!(plain > 2.08 && (found.fit.values[0] - 2.0).abs() < 0.04, "{plain} {}", found.fit.values[0]);
        }
        println!("held {held} of 300");
        assert!((270..=297).contains(&held), "{held} of 300");
    }

    #[test]
    fn without_a_tail_it_is_the_plain_fit() {
        let mut rng = StdRng::seed_from_u64(51);
        let columns = [vec![1.0; 500]];
        let mut plain = 0;
        for _ in 0..200 {
            let rhs: Vec<f64> = (0..500).map(|_| 2.0 + 0.1 * rng.sample::<f64, _>(StandardNormal)).collect();
            let found = robust(&columns, &rhs, None).expect("solves");
            plain += usize::from(found.weights.is_none());
            let expected = least_squares(&columns, &rhs, None).expect("solves").values;
            assert!(found.weights.is_some() || found.fit.values == expected);
        }
        assert_eq!(plain, 200);
    }

    #[test]
    fn exact_data_stay_exact() {
        let found = robust(&[vec![1.0; 30]], &[3.0; 30], None).expect("solves");
        assert!((found.fit.values[0] - 3.0).abs() < 1e-12 && found.weights.is_none());
    }
}
