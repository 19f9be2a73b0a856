//! Gain of the extended model on other recordings, without any fit to them.
//!
//! Causes found, kept as coefficients of regressors, for use on other recordings of the same object.

use crate::diagnose::contract::Validation;
use crate::diagnose::data::direction::blur;
use crate::diagnose::data::regression_data::{Place, Track};
use crate::diagnose::data::row_means::column;
use crate::diagnose::hypotheses::all::coarse_candidates;
use crate::diagnose::hypotheses::candidate::{Candidate, Searched};
use crate::diagnose::hypotheses::law_forces::needed;
use crate::diagnose::options;
use crate::diagnose::selection::comparison::{ChannelFit, Compared};
use crate::diagnose::selection::held_out_gain::{DRAWS, bootstrap};
use estimation::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use haptics::law::{Effect, Kind};

/// Number of blocks of a recording for the bootstrap, because neighbouring rows share their errors.
/// Choice: no case of the ablation reads it.
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
    let left = |model: &[f64]| -> Vec<f64> { along().map(|(i, r)| r.target - model[i]).collect() };
    Validation { left_out, ..compared(&left(&without), &left(&with), &weight) }
}

/// Values that belong to one recording (a time, an insertion) and do not carry over to another.
const OF_ONE_RECORDING: [&str; 4] = ["t0", "from insertion", "from recording", "duration"];
/// Relative difference of searched values, on another recording's grid, up to which they count as equal.
/// Choice: no case of the ablation reads it.
const SAME: f64 = 0.35;

/// One cause of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    pub channel: &'static str,
    pub id: &'static str,
    pub kind: Kind,
    linear: Vec<&'static str>,
    searched: Vec<Searched>,
    values: Vec<f64>,
}

/// All causes chosen in a comparison.
pub fn of_study(channel: &'static str, study: &ChannelFit) -> Vec<Kept> {
    let of = |(candidate, values): (&Candidate, &[f64])| Kept {
        channel,
        id: candidate.id,
        kind: candidate.kind,
        linear: candidate.linear.iter().map(|l| l.0).collect(),
        searched: candidate.searched.clone(),
        values: values.to_vec(),
    };
    study.found().into_iter().map(of).collect()
}

/// Sum of the effects of these causes on the rows of another recording; `None` without any. `left_out`: takes those
/// that have no candidate there.
pub fn effect<'a>(
    kept: impl Iterator<Item = &'a Kept>,
    candidates: &[Candidate],
    left_out: &mut Vec<String>,
) -> Option<Vec<f64>> {
    let mut sum: Option<Vec<f64>> = None;
    for cause in kept {
        match (cause.column(candidates), &mut sum) {
            (Some(column), Some(sum)) => sum.iter_mut().zip(column).for_each(|(s, c)| *s += c),
            (column @ Some(_), None) => sum = column,
            (None, _) => left_out.push(cause.id.to_owned()),
        }
    }
    sum
}

impl Kept {
    /// Effect of the cause on the rows of another recording, from the candidates there; `None` if it has no candidate
    /// there.
    fn column(&self, candidates: &[Candidate]) -> Option<Vec<f64>> {
        if self.searched.iter().any(|s| OF_ONE_RECORDING.contains(&s.name)) {
            return None;
        }
        let apart = |c: &Candidate| -> f64 {
            let pairs = c.searched.iter().zip(&self.searched);
            pairs.map(|(a, b)| ((a.value - b.value) / b.value.abs().max(f64::MIN_POSITIVE)).abs()).fold(0.0, f64::max)
        };
        let same = |c: &&Candidate| {
            let names = |c: &Candidate| c.linear.iter().map(|l| l.0).collect::<Vec<_>>();
            c.id == self.id && names(c) == self.linear && c.searched.len() == self.searched.len()
        };
        let nearest = candidates.iter().filter(same).min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        if apart(nearest) > SAME {
            return None;
        }
        let mut sum = vec![0.0; nearest.regressors.first()?.len()];
        for (column, value) in nearest.regressors.iter().zip(&self.values) {
            sum.iter_mut().zip(column.iter()).for_each(|(s, c)| *s += value * c);
        }
        Some(sum)
    }
}

/// Gain by the kept causes on the channels of another recording. Weights, positions and zeros of each recording are
/// fitted again, with and without the causes; the causes and their sizes are not. `order`: the causes, strongest first.
/// The figures are of the channel of the first available cause.
pub fn measure(kept: &[Kept], order: &[&str], channels: &[Compared]) -> Result<Validation, EstimateError> {
    let mut left_out: Vec<String> = Vec::new();
    let mut found: Option<Validation> = None;
    let place = |channel: &Compared| {
        let own = kept.iter().filter(|k| k.channel == channel.channel);
        own.filter_map(|k| order.iter().position(|id| *id == k.id)).min().unwrap_or(order.len())
    };
    let mut sorted: Vec<&Compared> = channels.iter().collect();
    sorted.sort_by_key(|c| place(c));
    for channel in sorted {
        let study = &channel.study;
        let own = kept.iter().filter(|k| k.channel == channel.channel);
        let sum = effect(own, &study.candidates, &mut left_out);
        let is_any = sum.is_some();
        // Without causes, the figures are of the first channel.
        if found.as_ref().is_some_and(|v| v.of.is_some()) || (found.is_some() && !is_any) {
            continue;
        }
        let after =
            sum.map_or_else(|| study.target.clone(), |s| study.target.iter().zip(&s).map(|(y, s)| y - s).collect());
        // Rows that are held out in turn represent their neighbours. Other rows of the channel (empty fingers) count
        // with them.
        let squares: Vec<f64> = study.layout.weight.iter().map(|w| w * w).collect();
        found = Some(Validation {
            of: is_any.then(|| channel.channel.to_owned()),
            unit: is_any.then(|| channel.unit.to_owned()),
            ..compared(&open(study, &study.target)?, &open(study, &after)?, &squares)
        });
    }
    let missing = kept.iter().filter(|k| channels.iter().all(|c| c.channel != k.channel));
    left_out.extend(missing.map(|k| k.id.to_owned()));
    let mut found = found.ok_or_else(options::nothing)?;
    found.left_out = left_out;
    Ok(found)
}

/// Residual of a target after a fit of the base model, row by row.
fn open(study: &ChannelFit, y: &[f64]) -> Result<Vec<f64>, EstimateError> {
    let base: Vec<Vec<f64>> = study.baseline.iter().filter(|c| c.iter().any(|v| *v != 0.0)).cloned().collect();
    let squares: Vec<f64> = study.layout.weight.iter().map(|w| w * w).collect();
    let mut left = y.to_vec();
    if !base.is_empty() {
        let fit = least_squares(&base, y, Some(&squares))?;
        for (column, value) in base.iter().zip(&fit.values) {
            left.iter_mut().zip(column).for_each(|(l, c)| *l -= value * c);
        }
    }
    Ok(left)
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
