//! Causes found, kept as coefficients of regressors, for use on other recordings of the same object.

use super::on_other_recordings::compared;
use crate::diagnose::contract::Validation;
use crate::diagnose::hypotheses::candidate::{Candidate, Searched};
use crate::diagnose::options;
use crate::diagnose::selection::comparison::{ChannelFit, Compared};
use estimation::regression::linear::least_squares;
use foundation::estimate::EstimateError;
use haptics::law::Kind;

/// Values that belong to one recording (a time, an insertion) and do not carry over to another.
const OF_ONE_RECORDING: [&str; 4] = ["t0", "from insertion", "from recording", "duration"];
/// Relative difference of searched values, on another recording's grid, up to which they count as equal.
const SAME: f64 = 0.35;

/// One cause of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    /// Channel of the cause.
    pub channel: &'static str,
    /// The cause.
    pub id: &'static str,
    /// Plant or instrument.
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
            pairs.map(|(a, b)| ((a.value - b.value) / b.value.abs().max(1e-9)).abs()).fold(0.0, f64::max)
        };
        let same = |c: &&Candidate| {
            let names = |c: &Candidate| c.linear.iter().map(|l| l.0).collect::<Vec<_>>();
            c.id == self.id && names(c) == self.linear && c.searched.len() == self.searched.len()
        };
        let nearest = candidates.iter().filter(same).min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
        if apart(nearest) > SAME {
            return None;
        }
        let mut sum = vec![0.0; nearest.columns.first()?.len()];
        for (column, value) in nearest.columns.iter().zip(&self.values) {
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
        let after = sum.map_or_else(|| study.y.clone(), |s| study.y.iter().zip(&s).map(|(y, s)| y - s).collect());
        // Rows that are held out in turn represent their neighbours. Other rows of the channel (empty fingers) count
        // with them.
        let squares: Vec<f64> = study.layout.weight.iter().map(|w| w * w).collect();
        found = Some(Validation {
            of: is_any.then(|| channel.channel.to_owned()),
            unit: is_any.then(|| channel.unit.to_owned()),
            ..compared(&open(study, &study.y)?, &open(study, &after)?, &squares)
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
    let base: Vec<Vec<f64>> = study.base.iter().filter(|c| c.iter().any(|v| *v != 0.0)).cloned().collect();
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
