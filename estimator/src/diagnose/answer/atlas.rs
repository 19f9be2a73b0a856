//! Residual atlas: the residual of the force, and the part of it that every candidate cause alone explains.

use crate::diagnose::data::regression_data::{Place, Track};
use crate::diagnose::hypotheses::all::best_seen_against;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::selection::comparison::ChannelFit;
use haptics::law::cause;

/// One candidate cause of the atlas.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// Out of `docs/causes/README.md`.
    pub id: String,
    /// Evidence of the cause alone: 2 ln(likelihood ratio) less the penalty of its parameters.
    pub score: f64,
    /// Variable that shows it best.
    pub variable: Variable,
    /// Part of the base model's residual that it explains when the model is refitted with it, at each instant of the
    /// course, N or N m.
    pub taken: Vec<f64>,
}

/// Candidate causes of the residual, most evidence first, and the variables of their plots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Atlas {
    /// Candidate causes that the recording excites.
    pub suspects: Vec<Seen>,
    /// Acceleration of the coordinate at each instant, m/s² or rad/s².
    pub acceleration: Vec<f64>,
    /// Rate of change of the measured force, N/s or N m/s.
    pub force_rate: Vec<f64>,
    /// Channels of tasks without one coordinate, instead of the fields above.
    pub channels: Vec<Channel>,
}

/// One channel of a task without one coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name of the channel, in words.
    pub name: &'static str,
    /// SI unit.
    pub unit: &'static str,
    /// True if positions are angles, and rates angular rates.
    pub is_angular: bool,
    /// Noise of a row.
    pub noise: f64,
    /// Recording of each row. Empty if single recordings have too few rows to be shown apart.
    pub recording: Vec<usize>,
    /// Direction of motion in each row, as a sign. Empty if it does not matter.
    pub way: Vec<f64>,
    /// Residual of the base model in each row.
    pub left: Vec<f64>,
    /// Candidate causes that the recordings excite, most evidence first.
    pub suspects: Vec<Against>,
}

/// One candidate cause of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Against {
    /// Out of `docs/causes/README.md`.
    pub id: String,
    /// As [`Seen::score`].
    pub score: f64,
    /// Variable that shows it best.
    pub variable: Variable,
    /// Rows in which it may have an effect.
    pub rows: Vec<usize>,
    /// Values of that variable in these rows, SI units.
    pub over: Vec<f64>,
    /// Part of the base model's residual that it explains in these rows.
    pub taken: Vec<f64>,
}

/// Strongest candidate of every cause that the rows can show, with its evidence and the part of the base model's
/// residual `left` that it explains; the strongest cause first.
pub(super) fn strongest<'a>(study: &'a ChannelFit, left: &[f64]) -> Vec<(&'a Candidate, f64, Vec<f64>)> {
    let ChannelFit { system, candidates, .. } = study;
    let selection = study.of_each();
    let mut best: Vec<(&str, usize, f64)> = Vec::new();
    for (c, candidate) in candidates.iter().enumerate() {
        if cause(candidate.id).is_none() || !system.supported(c) {
            continue;
        }
        let Some(score) = selection.score_beside(&[], c) else { continue };
        match best.iter_mut().find(|(id, ..)| *id == candidate.id) {
            Some(held) if held.2 >= score => {}
            Some(held) => (held.1, held.2) = (c, score),
            None => best.push((candidate.id, c, score)),
        }
    }
    best.sort_by(|a, b| b.2.total_cmp(&a.2));
    let taken = |(_, c, score): (&str, usize, f64)| {
        let after = study.residual_of(&[c], &system.solve(&[c])?);
        Some((&candidates[c], score, left.iter().zip(&after).map(|(before, after)| before - after).collect()))
    };
    best.into_iter().filter_map(taken).collect()
}

/// The atlas of a comparison.
pub(crate) fn atlas(track: &Track, study: &ChannelFit) -> Atlas {
    let along: Vec<usize> = (0..track.rows.len()).filter(|i| track.rows[*i].place == Place::Along).collect();
    let seen = |(candidate, score, taken): (&Candidate, f64, Vec<f64>)| {
        let taken = along.iter().map(|i| taken[*i]).collect();
        Seen { id: candidate.id.to_owned(), score, variable: best_seen_against(candidate.id, track.planar), taken }
    };
    Atlas {
        suspects: strongest(study, &study.residual(&[])).into_iter().map(seen).collect(),
        acceleration: along.iter().map(|i| track.rows[*i].motion.acceleration).collect(),
        force_rate: along.iter().map(|i| track.rows[*i].force_rate.dot(&track.rows[*i].along)).collect(),
        channels: Vec::new(),
    }
}
