//! Separability of two causes on a motion.

use crate::diagnose::data::regression_data::{Model, Track};
use crate::diagnose::data::row_means::column;
use crate::diagnose::hypotheses::all::coarse_candidates;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::comparison::ChannelFit;
use crate::diagnose::selection::noise_model::Whitening;
use nalgebra::{DMatrix, DVector};

/// Predicted rows of a motion that has not been made yet.
pub struct Imagined {
    /// Regressors of the base model, and all candidates.
    pub baseline: Vec<Vec<f64>>,
    pub candidates: Vec<Candidate>,
    pub segment: Vec<usize>,
    /// Weight of each row: inverse of its relative noise.
    pub weight: Vec<f64>,
}

impl Imagined {
    /// Rows of equal noise.
    pub fn of(baseline: Vec<Vec<f64>>, candidates: Vec<Candidate>, segment: Vec<usize>) -> Self {
        let weight = vec![1.0; segment.len()];
        Self { baseline, candidates, segment, weight }
    }

    /// Predicted effects of the causes along one coordinate.
    pub fn along(track: &Track, model: &Model, study: &ChannelFit) -> Self {
        let base: Vec<Vec<f64>> = model.iter().map(|e| column(track, e)).collect();
        let predicted: Vec<f64> = track.rows.iter().map(|r| r.target).collect();
        let taken: Vec<&str> = model.iter().map(|e| e.law().id()).collect();
        let candidates = coarse_candidates(track, &predicted, &[], &taken);
        let variance = variance(study).unwrap_or(1.0);
        Self {
            baseline: base,
            candidates,
            segment: track.rows.iter().map(|r| r.segment).collect(),
            // An uncertain direction makes all of the friction uncertain.
            weight: track.rows.iter().map(|r| (1.0 + r.target * r.target * r.open / variance).powf(-0.5)).collect(),
        }
    }
}

/// Mean residual power of a row in a study.
fn variance(study: &ChannelFit) -> Option<f64> {
    let solved = study.solved.as_ref()?;
    Some(solved.variance(study.system.rows).max(f64::MIN_POSITIVE))
}

/// Expected evidence λ in the worse of two cases: the found cause is true, or its rival is. In each, the model and the
/// other cause explain as much of the effect as they can on this motion. The noise keeps its autocorrelation.
pub fn separation(imagined: &Imagined, study: &ChannelFit, pair: (&str, &str)) -> Option<f64> {
    let found = study.chosen.iter().position(|c| study.candidates[c.candidate].id == pair.0)?;
    let mut picks = study.picks();
    let eye = Eye::new(imagined, study)?;
    let forward = eye.lambda(study, &picks, found, pair.1)?;
    let rival = study.chosen[found].rivals.iter().find(|(c, _)| study.candidates[*c].id == pair.1);
    let Some((rival, _)) = rival else { return Some(forward) };
    picks[found] = *rival;
    let backward = eye.lambda(study, &picks, found, pair.0);
    Some(backward.map_or(forward, |backward| forward.min(backward)))
}

/// Predicted effects of causes on a motion, whitened.
struct Eye<'a> {
    on: &'a Imagined,
    /// Regressors of the base model, whitened.
    base: Vec<Vec<f64>>,
    white: Whitening<'a>,
    variance: f64,
}

impl<'a> Eye<'a> {
    fn new(on: &'a Imagined, study: &'a ChannelFit) -> Option<Self> {
        let white = Whitening::new(&on.segment, &on.weight, &study.system.coefficients);
        Some(Self {
            on,
            base: on.baseline.iter().map(|column| white.of(column)).collect(),
            white,
            variance: variance(study)?,
        })
    }

    /// Part of the k-th of `picks`, with its estimated size, that the model and `other` cannot explain.
    fn lambda(&self, study: &ChannelFit, picks: &[usize], k: usize, other: &str) -> Option<f64> {
        let solved = study.system.solve(picks)?;
        let own = &study.candidates[picks[k]];
        let like = nearest(&self.on.candidates, own)?;
        let parts = like.regressors.iter().zip(&solved.values[study.system.own(picks, k)]);
        let effect = parts.fold(vec![0.0; self.on.weight.len()], |mut sum, (c, v)| {
            sum.iter_mut().zip(c.iter()).for_each(|(s, x)| *s += v * x);
            sum
        });
        let effect = self.white.of(&effect);
        let rivals = self.on.candidates.iter().filter(|c| c.id == other);
        let left = rivals.map(|rival| {
            let rival: Vec<Vec<f64>> = rival.regressors.iter().map(|c| self.white.of(c)).collect();
            unexplained(&effect, self.base.iter().chain(&rival)) / self.variance
        });
        left.min_by(f64::total_cmp)
    }
}

/// The candidate of the same cause with the nearest searched values.
fn nearest<'a>(candidates: &'a [Candidate], own: &Candidate) -> Option<&'a Candidate> {
    let apart = |c: &Candidate| -> f64 {
        c.searched
            .iter()
            .zip(&own.searched)
            .map(|(a, b)| ((a.value - b.value) / b.value.abs().max(f64::MIN_POSITIVE)).powi(2))
            .sum()
    };
    let same = |c: &&Candidate| c.id == own.id && c.linear == own.linear && c.searched.len() == own.searched.len();
    candidates.iter().filter(same).min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

/// Residual sum of squares of a series after a fit of the columns.
fn unexplained<'a>(series: &[f64], columns: impl Iterator<Item = &'a Vec<f64>>) -> f64 {
    let columns: Vec<&Vec<f64>> = columns.filter(|c| c.iter().any(|v| *v != 0.0)).collect();
    let matrix = DMatrix::from_fn(series.len(), columns.len(), |i, j| columns[j][i]);
    let target = DVector::from_column_slice(series);
    let gram = matrix.tr_mul(&matrix);
    let scale: Vec<f64> = (0..gram.ncols()).map(|j| gram[(j, j)].sqrt().max(1e-300)).collect();
    let scaled = DMatrix::from_fn(gram.nrows(), gram.ncols(), |i, j| {
        gram[(i, j)] / (scale[i] * scale[j]) + if i == j { 1e-10 } else { 0.0 }
    });
    let right = matrix.tr_mul(&target).component_div(&DVector::from_column_slice(&scale));
    let Some(cholesky) = scaled.cholesky() else { return 0.0 };
    let solved = cholesky.solve(&right).component_div(&DVector::from_column_slice(&scale));
    (target - matrix * solved).norm_squared()
}
