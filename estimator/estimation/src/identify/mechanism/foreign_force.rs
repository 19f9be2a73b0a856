//! A stretch of time in which the recorded force does not belong to the motion: a hand or a stop acted beside it, or the
//! sensor failed.

use super::parameters::{Known, Term};
use super::regress::System;
use super::signals::Piece;
use super::zero_step::OF_POWER;
use crate::identify::limits::{CERTAIN, LEAST_FIT_ROWS, ROUNDING};
use crate::segment::threshold::percentile;
use std::ops::Range;

/// One stretch of time, with the weighted root mean square of the residual in it and elsewhere, N or N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Times of its first and last row, s.
    pub time_s: [f64; 2],
    /// Residual in the stretch.
    pub inside: f64,
    /// Residual elsewhere, of a fit without the stretch.
    pub outside: f64,
}

/// The stretch in the residual of one recording's fit of these terms. `None` unless the residual there is certainly above the one
/// elsewhere, and the stretch takes half of the residual's power. It is shorter than the rest: the fit is that of the rest.
pub fn stretch(pieces: &[Piece], terms: &[Term], known: &Known) -> Option<Stretch> {
    let terms: Vec<Term> = terms.iter().copied().chain([Term::Spring]).collect();
    let system = System::stack(pieces, &terms, known, Piece::applied_force);
    let times = System::stack(pieces, &[], &Known::default(), |piece| piece.times_s().collect());
    // A mechanism that stands, or hardly moves, holds any force up to its friction.
    let moves: Vec<bool> = system.uncertainty.iter().map(|uncertainty| *uncertainty < 0.5).collect();
    let (system, time_s) = (system.filtered(&moves), times.filtered(&moves).target);
    let rows = time_s.len();
    // Weight and weighted power of the residual of every row, after a fit of the rows that are kept.
    let powers = |kept: &[bool]| -> Option<(Vec<f64>, Vec<f64>)> {
        let fit = system.filtered(kept).solve().ok()?;
        let weights = system.weights(&fit).unwrap_or_else(|| vec![1.0; rows]);
        let model = |i: usize| fit.values.iter().zip(&system.columns).map(|(value, c)| value * c[i]).sum::<f64>();
        let power = (0..rows).map(|i| weights[i] * (system.target[i] - model(i)).powi(2)).collect();
        Some((weights, power))
    };
    let (mut found, mut left) = (0..0, powers(&vec![true; rows])?);
    let whole: f64 = left.1.iter().sum();
    // The first fit is spoiled by the stretch and shows a part of it; ten rounds settle its ends.
    for _ in 0..10 {
        let limit = CERTAIN.powi(2) * percentile(&mut left.1.clone(), 0.5);
        let last = std::mem::replace(&mut found, largest_sum(left.1.iter().map(|power| power - limit)));
        if found == last {
            break;
        }
        left = powers(&(0..rows).map(|i| !found.contains(&i)).collect::<Vec<bool>>())?;
    }
    let count = found.len();
    if count < LEAST_FIT_ROWS || 2 * count > rows {
        return None;
    }
    let sums = |values: &[f64]| {
        let inside: f64 = values[found.clone()].iter().sum();
        (inside, values.iter().sum::<f64>() - inside)
    };
    let (weight, power) = (sums(&left.0), sums(&left.1));
    let [inside, outside] = [power.0 / weight.0, power.1 / weight.1].map(f64::sqrt);
    let level = (system.target.iter().map(|force| force * force).sum::<f64>() / rows as f64).sqrt();
    let is_one = inside > CERTAIN * outside && power.1 < (1.0 - OF_POWER) * whole && inside > ROUNDING * level;
    is_one.then(|| Stretch { time_s: [time_s[found.start], time_s[found.end - 1]], inside, outside })
}

/// First index and end of the consecutive values with the largest sum; an empty range if no value is above zero.
fn largest_sum(values: impl Iterator<Item = f64>) -> Range<usize> {
    let (mut best, mut range, mut sum, mut start) = (0.0, 0..0, 0.0, 0);
    for (i, value) in values.enumerate() {
        if sum <= 0.0 {
            (sum, start) = (0.0, i);
        }
        sum += value;
        if sum > best {
            (best, range) = (sum, start..i + 1);
        }
    }
    range
}

/// Takes the rows of a stretch, and those that the filter mixes with it, out of the segments.
pub fn leave_out(pieces: &mut [Piece], stretch: &Stretch) {
    let [from_s, to_s] = stretch.time_s;
    for piece in pieces {
        let reach_s = piece.cutoff_hz.recip();
        let times_s: Vec<f64> = piece.times_s().collect();
        for (usable, t) in piece.usable.iter_mut().zip(times_s) {
            *usable &= !(from_s - reach_s..=to_s + reach_s).contains(&t);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::largest_sum;

    #[test]
    fn the_largest_sum_is_one_range() {
        assert_eq!(largest_sum([-1.0, 3.0, -1.0, 2.0, -5.0, 3.0].into_iter()), 1..4);
        assert_eq!(largest_sum([-1.0, 0.0].into_iter()), 0..0);
    }
}
