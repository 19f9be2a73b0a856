//! One measured channel: its residual, and the causes that explain it.

#[cfg(test)]
pub(crate) mod tests;

use super::comparison::{Study, residual};
use super::held_out_gain::{confirmed, gain, holds_out, is_tested};
use super::noise_model::{Noise, whitener};
use super::normal_equations::{Held, Rows, System, solve, uses};
use super::prescreen::Rough;
use super::pruning::{CONFIRMED, PIECES_S, SHOWN, harms, is_steady};
use super::stepwise::Selection;
use crate::diagnose::hypotheses::all::relations;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::relations::Relation;
use crate::estimate::EstimateError;

/// Ridge on the candidates in the fit whose residual determines the whitening, relative to the power of a regressor.
/// For causes it is scaled by their part beyond the model. With a common ridge, the fit would attribute nearly
/// collinear causes to the model and leave the difference in the residual.
const RIDGE: f64 = 1e-2;
/// Part of a cause beyond the model below which it counts as none.
const LEAST_OWN: f64 = 1e-4;

/// Rows of one channel with the base model and all candidates.
#[derive(Clone)]
pub struct Channel {
    /// The target.
    pub y: Vec<f64>,
    /// Columns of the model.
    pub base: Vec<Vec<f64>>,
    /// Causes and generic terms.
    pub candidates: Vec<Candidate>,
    /// Segment of each row.
    pub stretch: Vec<usize>,
    /// Rows that may be held out.
    pub testable: Vec<bool>,
    /// Factor by which the noise of each row is reduced.
    pub weight: Vec<f64>,
    /// Time between rows, s.
    pub period_s: f64,
}

impl Channel {
    /// Compares all candidates. `threshold`: least evidence of a cause.
    pub fn compare(self, threshold: f64) -> Result<Study, EstimateError> {
        // The rows are already in time order.
        let order: Vec<f64> = (0..self.y.len()).map(|i| i as f64).collect();
        self.chosen(&order, threshold, true)
    }

    /// The same without dry friction in the model: causes that bend or lift it are then tried only beside it.
    pub fn compare_without_friction(self, threshold: f64) -> Result<Study, EstimateError> {
        let order: Vec<f64> = (0..self.y.len()).map(|i| i as f64).collect();
        self.chosen(&order, threshold, false)
    }

    /// The same with this order of the rows for held-out blocks.
    pub fn compare_in(self, order: &[f64], threshold: f64) -> Result<Study, EstimateError> {
        self.chosen(order, threshold, true)
    }

    fn chosen(mut self, order: &[f64], threshold: f64, dry: bool) -> Result<Study, EstimateError> {
        let seen = |c: &Candidate| {
            c.columns.iter().all(|v| v.iter().all(|x| x.is_finite()) && v.iter().any(|x| x.abs() > 1e-12))
        };
        self.candidates.retain(seen);
        if self.base.is_empty() {
            // A model that predicts nothing.
            self.base.push(vec![0.0; self.y.len()]);
        }
        let Self { y, base, candidates, stretch, testable, weight, period_s } = self;
        let testable: Vec<Held> = testable.iter().map(|t| if *t { Held::Fully } else { Held::Never }).collect();
        let rows = Rows {
            y: &y,
            stretch: &stretch,
            testable: &testable,
            time_s: order,
            weight: &weight,
            period_s,
            noise: Noise::Any,
            may_stand: false,
        };
        let coefficients = whitening(&base, &candidates, &rows, threshold)?;
        let mut system = System::new(&base, &candidates, &rows, coefficients);
        system.pieces = PIECES_S.iter().filter_map(|piece_s| pieces(&stretch, piece_s / period_s)).collect();
        let chosen = Selection::new(&system, &candidates, threshold).of(dry, false).run(&[]);
        let picks: Vec<usize> = chosen.iter().map(|c| c.candidate).collect();
        let solved = system.solve(&picks);
        let mut made = Study { candidates, chosen, system, solved, y, base, weight, shares_of: [1.0, 0.0] };
        leave_out_what_is_unsure(&mut made, &stretch, threshold);
        leave_out_what_cannot_be(&mut made);
        if !dry && lifts_nothing(&made) {
            // The dry friction beside which the change was found was removed: a change of friction without friction is
            // not possible.
            let Study { y, base, mut candidates, weight, .. } = made;
            candidates.retain(|c| !relations(c.id).contains(&Relation::OfDryFriction));
            let testable = testable.iter().map(|held| *held != Held::Never).collect();
            return Self { y, base, candidates, stretch, testable, weight, period_s }.chosen(order, threshold, dry);
        }
        Ok(made)
    }
}

/// Removes causes without a proven gain on held-out rows, if those rows could show it. If too few rows exist for a
/// separate hold-out, each fold is predicted from the others. The cause then needs far more evidence, because all rows
/// took part in its choice.
fn leave_out_what_is_unsure(study: &mut Study, stretch: &[usize], threshold: f64) {
    loop {
        let is_unsure = |k: &usize| {
            let gain = gain(study, *k, 0.0);
            let gains_nothing = gain.no_share.is_none() && gain.heldout_rms_after >= gain.heldout_rms_before;
            let is_weak = study.chosen[*k].score < CONFIRMED * threshold;
            if !holds_out(study) {
                return gains_nothing || is_weak;
            }
            // A cause with strong evidence is removed only if it clearly increases the held-out error.
            let tested = is_tested(study, *k, stretch);
            let shows_nothing = if tested { confirmed(study, *k, stretch) < SHOWN } else { gains_nothing };
            // A cause that the held-out rows could not test must be steady over the fitted ones.
            harms(study, *k) || is_weak && shows_nothing || (is_weak || !tested) && !is_steady(study, *k)
        };
        let Some(k) = (0..study.chosen.len()).rev().find(is_unsure) else { return };
        study.chosen.remove(k);
        study.solved = study.system.solve(&study.picks());
    }
}

/// Least number of jackknife blocks from which their scatter can be estimated.
const LEAST_PIECES: usize = 8;

/// Jackknife block of at most this many rows for each row. None if there are too few blocks.
fn pieces(stretch: &[usize], rows: f64) -> Option<Vec<usize>> {
    let most = (rows as usize).max(1);
    let (mut piece, mut own) = (0, 0);
    let mut pieces = Vec::with_capacity(stretch.len());
    for i in 0..stretch.len() {
        let goes_on = i == 0 || stretch[i] == stretch[i - 1] && own < most;
        (piece, own) = if goes_on { (piece, own + 1) } else { (piece + 1, 1) };
        pieces.push(piece);
    }
    (piece + 1 >= LEAST_PIECES).then_some(pieces)
}

/// True if a change of dry friction was chosen without any dry friction.
fn lifts_nothing(study: &Study) -> bool {
    let is = |relation: Relation| study.picks().iter().any(|c| relations(study.candidates[*c].id).contains(&relation));
    is(Relation::OfDryFriction) && !is(Relation::DryFriction)
}

/// Removes causes whose estimate no longer fits their name after another cause was removed.
fn leave_out_what_cannot_be(study: &mut Study) {
    let impossible = |study: &Study| {
        let values = &study.solved.as_ref()?.values;
        let mut at = study.system.base;
        study.chosen.iter().position(|chosen| {
            let candidate = &study.candidates[chosen.candidate];
            let own = at..at + candidate.columns.len();
            at = own.end;
            !candidate.admits(&values[own])
        })
    };
    while let Some(k) = impossible(study) {
        study.chosen.remove(k);
        study.solved = study.system.solve(&study.picks());
    }
}

/// The autoregression of what everything together leaves: learnt from the model's residual it would swallow the causes.
pub fn whitening(
    base: &[Vec<f64>],
    candidates: &[Candidate],
    rows: &Rows<'_>,
    threshold: f64,
) -> Result<Vec<f64>, EstimateError> {
    let mut rough = Rough::new(base, candidates, rows);
    let causes = rough.greedy(threshold);
    let generic = (0..candidates.len()).filter(|c| candidates[*c].expression.is_some());
    let used: Vec<usize> = causes.iter().copied().chain(generic).collect();
    rough.know(&used);
    let rough = rough.system();
    let own = |k: &usize| {
        let others: Vec<usize> = causes.iter().filter(|c| *c != k).copied().collect();
        rough.distinct(*k, &others).max(LEAST_OWN)
    };
    let mut kept_out: Vec<f64> =
        causes.iter().flat_map(|k| vec![RIDGE * own(k); candidates[*k].columns.len()]).collect();
    let columns = rough.columns(&used);
    let target = rough.train.ncols() - 1;
    let mut ridged = rough.train.clone();
    kept_out.resize(columns.len() - rough.base, RIDGE);
    for (column, share) in columns[rough.base..].iter().zip(&kept_out) {
        ridged[(*column, *column)] *= 1.0 + share;
    }
    let solved = solve(&ridged, &columns, target)
        .ok_or_else(|| EstimateError::Other("the model could not be fitted to the recording".to_owned()))?;
    let left = residual(rows.y, base, candidates, &used, &solved);
    let weighted: Vec<f64> = left.iter().zip(rows.weight).map(|(r, w)| r * w).collect();
    Ok(whitener(&weighted, rows, &uses(rows)))
}

/// Numbers the segments: rows without a gap in time. `new` begins a segment in any case.
pub fn stretches(time_s: &[f64], period_s: f64, new: impl Fn(usize) -> bool) -> Vec<usize> {
    /// Time step, in periods, from which rows are missing.
    const GAP: f64 = 1.6;
    let mut number = 0;
    (0..time_s.len())
        .map(|i| {
            if i > 0 && (new(i) || !(0.0..GAP * period_s).contains(&(time_s[i] - time_s[i - 1]))) {
                number += 1;
            }
            number
        })
        .collect()
}
