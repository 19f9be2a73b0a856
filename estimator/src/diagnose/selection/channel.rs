//! One measured channel: its residual, and the causes that explain it.
//!
//! Removal of causes that held-out rows or blocks of the recording do not confirm.

#[cfg(test)]
pub(crate) mod tests;

use super::comparison::ChannelFit;
use super::gram::gram;
use super::held_out_gain::{LEAST_CHANGE_SHARE, confirmed, gain, holds_out, is_tested};
use super::layout::{Layout, Use};
use super::noise_model::whitener;
use super::normal_equations::{System, columns_of, solve, uses};
use super::open_values;
use super::prescreen::Rough;
use super::rules::Rules;
use super::stepwise::Stepwise;
use crate::diagnose::hypotheses::all::relations;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::relations::Relation;
use crate::diagnose::model_error::of_coordinate::TERMS;
use crate::diagnose::model_error::smooth::Discrepancy;
use foundation::estimate::EstimateError;

/// One measured quantity and all that may explain it.
#[derive(Clone)]
pub struct Channel {
    pub target: Vec<f64>,
    /// Regressors of the model.
    pub baseline: Vec<Vec<f64>>,
    /// Indices of those among them that can only resist: a negative coefficient is no explanation.
    pub resisting: Vec<usize>,
    pub candidates: Vec<Candidate>,
    /// Structured errors that may stand beside the causes.
    pub errors: Vec<Discrepancy>,
    pub layout: Layout,
    pub rules: Rules,
}

impl Channel {
    pub fn new(y: Vec<f64>, base: Vec<Vec<f64>>, candidates: Vec<Candidate>, layout: Layout, rules: Rules) -> Self {
        Self { target: y, baseline: base, resisting: Vec::new(), candidates, errors: Vec::new(), layout, rules }
    }

    /// Selects among the candidates that differ from zero, and removes what the held-out rows do not confirm.
    pub fn fit(mut self) -> Result<ChannelFit, EstimateError> {
        let seen =
            |c: &Candidate| c.regressors.iter().all(|v| v.iter().all(|x| x.is_finite()) && v.iter().any(|x| *x != 0.0));
        self.candidates.retain(seen);
        if self.baseline.is_empty() {
            // A model that predicts nothing.
            self.baseline.push(vec![0.0; self.target.len()]);
        }
        let mut made = self.select(None)?;
        leave_out_what_is_unsure(&mut made);
        if !made.rules.has_dry_friction && lifts_nothing(&made) {
            // The dry friction beside which the change was found was removed: a change of friction without friction is
            // not possible.
            let ChannelFit { target: y, baseline: base, mut candidates, errors, layout, rules, .. } = made;
            candidates.retain(|c| !relations(c.id).contains(&Relation::OfDryFriction));
            return Self { errors, ..Self::new(y, base, candidates, layout, rules) }.fit();
        }
        Ok(made)
    }

    /// Selects among the candidates, without a final check. `before`: an earlier round, whose whitening stays as long
    /// as the weights do (the same terms together have the same residual), and from whose choice the search starts, too.
    pub fn select(self, before: Option<ChannelFit>) -> Result<ChannelFit, EstimateError> {
        let Self { target: y, baseline: base, resisting, candidates, errors, layout, rules } = self;
        let place = |found: &Candidate| candidates.iter().position(|c| c.id == found.id && c.is_near(&found.searched));
        let found = before.iter().flat_map(|b| b.chosen.iter().map(|c| &b.candidates[c.candidate]));
        let start: Vec<usize> = found.filter_map(place).collect();
        let mut system = match before {
            // Rows with other weights have another residual noise.
            Some(before) if before.layout.weight == layout.weight => {
                let ChannelFit { system, candidates: had, baseline: had_base, target: had_y, .. } = before;
                System::after(system, &columns_of(&had_base, &had, &had_y), &base, &candidates, &y, &layout)
            }
            _ => {
                let coefficients = whitening((&base, &candidates, &errors), &y, &layout, &rules)?;
                System::new(&base, &candidates, &y, &layout, coefficients)
            }
        };
        system.resisting = resisting;
        system.pieces = layout.pieces();
        let chosen = Stepwise::new(&system, &candidates, &rules).run(&start);
        let mut made = ChannelFit { errors, ..ChannelFit::of(candidates, chosen, system, (y, base, layout), rules) };
        open_values::close(&mut made);
        Ok(made)
    }
}

/// True if a change of dry friction was chosen without any dry friction.
fn lifts_nothing(study: &ChannelFit) -> bool {
    let is = |relation: Relation| study.picks().iter().any(|c| relations(study.candidates[*c].id).contains(&relation));
    is(Relation::OfDryFriction) && !is(Relation::DryFriction)
}

/// Columns of a structured error, smoothest first, beside which the first autoregression is learnt.
/// Derived: the functions of one variable.
const SMOOTHEST: usize = TERMS;
/// Least number of rows for each of those columns.
/// Choice: halved, none of 348 answers of the blind battery changes; without it, 1 of 174 changes (to wrong).
const ROWS_OF_A_COLUMN: usize = 8;

/// Autoregression of the residual after all likely causes and structured errors together. Learnt from the model's
/// residual, it would absorb the causes. `columns`: regressors of the model, causes, and structured errors.
fn whitening(
    (base, candidates, errors): (&[Vec<f64>], &[Candidate], &[Discrepancy]),
    y: &[f64],
    layout: &Layout,
    rules: &Rules,
) -> Result<Vec<f64>, EstimateError> {
    let mut rough = Rough::new(base, candidates, y, layout);
    let causes = rough.greedy();
    let rough = rough.system();
    let own = |k: &usize| {
        let others: Vec<usize> = causes.iter().filter(|c| *c != k).copied().collect();
        rough.distinct(*k, &others).max(LEAST_CHANGE_SHARE)
    };
    let kept_out = causes.iter().flat_map(|k| vec![rules.ridge * own(k); candidates[*k].regressors.len()]);
    let of_causes = causes.iter().flat_map(|k| candidates[*k].regressors.iter().map(|c| c.as_slice()));
    let uses = uses(layout);
    let training: Vec<usize> = (0..y.len()).filter(|i| matches!(uses[*i], Use::Always | Use::Fold(_))).collect();
    // Few rows determine few functions.
    let smoothest = SMOOTHEST.min(training.len() / (ROWS_OF_A_COLUMN * errors.len().max(1)));
    let of_errors = errors.iter().flat_map(|e| e.columns.iter().take(smoothest).map(Vec::as_slice));
    let columns: Vec<&[f64]> = base.iter().map(Vec::as_slice).chain(of_causes).chain(of_errors).collect();
    let mut shares: Vec<f64> = vec![0.0; base.len()].into_iter().chain(kept_out).collect();
    shares.resize(columns.len(), rules.ridge);
    let weighted = |column: &[f64]| column.iter().zip(&layout.weight).map(|(v, w)| v * w).collect::<Vec<f64>>();
    let whole: Vec<Vec<f64>> = columns.iter().copied().chain([y]).map(weighted).collect();
    let mut ridged = gram(&whole, &training);
    shares.iter().enumerate().for_each(|(k, share)| ridged[(k, k)] *= 1.0 + share);
    let solved = solve(&ridged, &(0..columns.len()).collect::<Vec<_>>(), columns.len())
        .ok_or_else(|| EstimateError::Other("the model could not be fitted to the recording".to_owned()))?;
    let mut residual = whole[columns.len()].clone();
    for (column, value) in whole.iter().zip(&solved.values) {
        residual.iter_mut().zip(column).for_each(|(r, c)| *r -= value * c);
    }
    Ok(whitener(&residual, layout, &uses))
}

/// Removes unsound causes: those that certainly increase the held-out error, those that are unsteady over blocks of the
/// recording, weak ones without a gain on the held-out rows, and those whose estimate no longer fits their name.
pub fn leave_out_what_is_unsure(study: &mut ChannelFit) {
    while let Some(k) = (0..study.chosen.len()).rev().find(|k| is_unsure(study, *k)) {
        leave_out(study, k);
    }
    while let Some(k) = impossible(study).filter(|_| study.rules.is_sparse) {
        leave_out(study, k);
    }
}

fn leave_out(study: &mut ChannelFit, k: usize) {
    study.chosen.remove(k);
    study.solved = study.system.solve(&study.picks());
}

/// True if the rows do not confirm the k-th chosen cause. If too few rows exist for a separate hold-out, each fold is
/// predicted from the others. The cause then needs far more evidence, because all rows took part in its choice.
fn is_unsure(study: &ChannelFit, k: usize) -> bool {
    let rules = &study.rules;
    let is_weak = study.chosen[k].score < rules.confirmed * rules.threshold;
    let gain = gain(study, k, 0.0);
    let gains_nothing = gain.no_share.is_none() && gain.heldout_rms_after >= gain.heldout_rms_before;
    if rules.is_sparse && !holds_out(study) {
        return gains_nothing || is_weak;
    }
    let tested = !rules.is_sparse || is_tested(study, k);
    let shows_nothing = || if tested { confirmed(study, k) < rules.shown } else { gains_nothing };
    let harms = gain.heldout_rms_after > rules.harms * gain.heldout_rms_before && gain.interval[1] < 0.0;
    let must_be_steady = is_weak || !tested || !rules.is_sparse;
    harms || must_be_steady && !is_steady(study, k) || is_weak && shows_nothing()
}

/// True if a jackknife over blocks of the recording confirms the effect of the k-th chosen cause. The test is only
/// made at the end: before that, the residual of a missing cause disturbs the blocks.
fn is_steady(study: &ChannelFit, k: usize) -> bool {
    let Some(solved) = &study.solved else { return true };
    let picks = study.picks();
    study.system.steadiness(solved, &study.system.own(&picks, k)) > study.rules.steady
}

/// A chosen cause whose estimate no longer fits its name after another one was removed.
fn impossible(study: &ChannelFit) -> Option<usize> {
    study.found().iter().position(|(candidate, values)| !candidate.admits(values))
}
