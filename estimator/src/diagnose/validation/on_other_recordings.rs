//! Gain of the extended model on other recordings, without any fit to them.

use super::fitted_terms::{Kept, effect};
use crate::diagnose::contract::Validation;
use crate::diagnose::data::direction::blur;
use crate::diagnose::data::regression_data::{Place, Track};
use crate::diagnose::data::row_means::column;
use crate::diagnose::hypotheses::all::coarse_candidates;
use crate::diagnose::hypotheses::law_forces::needed;
use crate::diagnose::selection::held_out_gain::{DRAWS, bootstrap};
use haptics::law::{Effect, Kind};

/// Number of blocks of a recording for the bootstrap, because neighbouring rows share their errors.
const BOOTSTRAP_BLOCKS: usize = 32;

/// Residual RMS before and after, and the share of the power that is explained. All in row order, with the rows'
/// weights.
pub fn compared(before: &[f64], after: &[f64], weight: &[f64]) -> Validation {
    let long = before.len().div_ceil(BOOTSTRAP_BLOCKS).max(1);
    let sum = |left: &[f64], weight: &[f64]| left.iter().zip(weight).map(|(l, w)| w * l * l).sum::<f64>();
    let pieces: Vec<[f64; 2]> = before
        .chunks(long)
        .zip(after.chunks(long))
        .zip(weight.chunks(long))
        .map(|((b, a), w)| [sum(b, w), sum(a, w)])
        .collect();
    let share = |drawn: &[usize]| {
        let [b, a] = drawn.iter().fold([0.0; 2], |[b, a], k| [b + pieces[*k][0], a + pieces[*k][1]]);
        1.0 - a / f64::max(b, 1e-300)
    };
    let all: Vec<usize> = (0..pieces.len()).collect();
    let rows = weight.iter().sum::<f64>().max(1e-12);
    Validation {
        rms_before: (sum(before, weight) / rows).sqrt(),
        rms_after: (sum(after, weight) / rows).sqrt(),
        share: share(&all),
        interval: bootstrap(all.len(), DRAWS, &share),
        ..Validation::default()
    }
}

/// Contribution of the found sensor faults to the rows; `None` without any. `known`: forces that are completely known.
fn faults(
    track: &Track,
    predicted: &[f64],
    known: &[Effect],
    kept: &[Kept],
    left_out: &mut Vec<String>,
) -> Option<Vec<f64>> {
    let mut of_sensors = kept.iter().filter(|k| k.kind == Kind::Instrument).peekable();
    of_sensors.peek()?;
    let fixed: Vec<Vec<f64>> = known.iter().map(|e| column(track, e)).collect();
    effect(of_sensors, &coarse_candidates(track, predicted, &fixed, &[]), left_out)
}

/// Unexplained force before and after on another recording. Rows around reversals, whose direction is a guess, count
/// little.
pub fn validate(track: &mut Track, before: &[Effect], after: &[Effect], known: &[Effect], kept: &[Kept]) -> Validation {
    blur(track);
    let (without, mut with) = (needed(track, before), needed(track, after));
    let mut left_out = Vec::new();
    let sensed = faults(track, &with, known, kept, &mut left_out);
    with.iter_mut().zip(sensed.into_iter().flatten()).for_each(|(w, s)| *w += s);
    let along = || track.rows.iter().enumerate().filter(|(_, r)| r.place == Place::Along);
    let weight: Vec<f64> = along().map(|(_, r)| r.motion.direction.powi(4)).collect();
    let left = |model: &[f64]| -> Vec<f64> { along().map(|(i, r)| r.y - model[i]).collect() };
    Validation { left_out, ..compared(&left(&without), &left(&with), &weight) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_holds_what_goes_and_is_wider_where_pieces_differ() {
        let before = vec![2.0; 640];
        let even: Vec<f64> = (0..640).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        let found = compared(&before, &even, &vec![1.0; 640]);
        assert!((found.share - 0.75).abs() < 1e-12 && (found.rms_before - 2.0).abs() < 1e-12);
        assert!(found.interval.iter().all(|v| (v - 0.75).abs() < 1e-12), "{:?}", found.interval);
        // All of the gain is in the first half, none in the second: it is uncertain.
        let half: Vec<f64> = (0..640).map(|i| if i < 320 { 0.0 } else { 2.0 }).collect();
        let [low, high] = compared(&before, &half, &vec![1.0; 640]).interval;
        assert!(low < 0.4 && high > 0.6 && low > 0.1 && high < 0.9, "{low} {high}");
        let worse = compared(&even, &before, &vec![1.0; 640]);
        assert!(worse.interval[1] < 0.0, "{:?}", worse.interval);
    }
}
