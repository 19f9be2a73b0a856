//! One measured channel: its residual, and the causes that explain it.
//!
//! Removal of causes that held-out rows or blocks of the recording do not confirm.

#[cfg(test)]
pub(crate) mod tests;

use super::comparison::{ChannelFit, residual};
use super::held_out_gain::{LEAST_CHANGE_SHARE, confirmed, gain, holds_out, is_tested};
use super::layout::Layout;
use super::noise_model::whitener;
use super::normal_equations::{System, columns_of, solve, uses};
use super::prescreen::Rough;
use super::rules::Rules;
use super::stepwise::Stepwise;
use crate::diagnose::hypotheses::all::relations;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::relations::Relation;
use foundation::estimate::EstimateError;

/// One measured quantity and all that may explain it.
#[derive(Clone)]
pub struct Channel {
    pub target: Vec<f64>,
    /// Regressors of the model.
    pub baseline: Vec<Vec<f64>>,
    /// Indices of those among them that can only resist: a negative coefficient is no explanation.
    pub resisting: Vec<usize>,
    /// Causes and generic terms.
    pub candidates: Vec<Candidate>,
    pub layout: Layout,
    pub rules: Rules,
}

impl Channel {
    pub fn new(y: Vec<f64>, base: Vec<Vec<f64>>, candidates: Vec<Candidate>, layout: Layout, rules: Rules) -> Self {
        Self { target: y, baseline: base, resisting: Vec::new(), candidates, layout, rules }
    }

    /// Selects among the candidates that differ from zero, and removes what the held-out rows do not confirm.
    pub fn fit(mut self) -> Result<ChannelFit, EstimateError> {
        let seen = |c: &Candidate| {
            c.regressors.iter().all(|v| v.iter().all(|x| x.is_finite()) && v.iter().any(|x| x.abs() > 1e-12))
        };
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
            let ChannelFit { target: y, baseline: base, mut candidates, layout, rules, .. } = made;
            candidates.retain(|c| !relations(c.id).contains(&Relation::OfDryFriction));
            return Self::new(y, base, candidates, layout, rules).fit();
        }
        Ok(made)
    }

    /// Selects among the candidates, without a final check. `before`: an earlier round, whose whitening stays as long
    /// as the weights do (the same terms together have the same residual), and from whose choice the search starts, too.
    pub fn select(self, before: Option<ChannelFit>) -> Result<ChannelFit, EstimateError> {
        let Self { target: y, baseline: base, resisting, candidates, layout, rules } = self;
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
                let coefficients = whitening(&base, &candidates, &y, &layout, &rules)?;
                System::new(&base, &candidates, &y, &layout, coefficients)
            }
        };
        system.resisting = resisting;
        system.pieces = layout.pieces();
        let chosen = Stepwise::new(&system, &candidates, &rules).run(&start);
        Ok(ChannelFit::of(candidates, chosen, system, (y, base, layout), rules))
    }
}

/// True if a change of dry friction was chosen without any dry friction.
fn lifts_nothing(study: &ChannelFit) -> bool {
    let is = |relation: Relation| study.picks().iter().any(|c| relations(study.candidates[*c].id).contains(&relation));
    is(Relation::OfDryFriction) && !is(Relation::DryFriction)
}

/// Autoregression of the residual after all likely causes together. Learnt from the model's residual, it would absorb
/// the causes.
fn whitening(
    base: &[Vec<f64>],
    candidates: &[Candidate],
    y: &[f64],
    layout: &Layout,
    rules: &Rules,
) -> Result<Vec<f64>, EstimateError> {
    let mut rough = Rough::new(base, candidates, y, layout);
    let causes = rough.greedy();
    let generic = (0..candidates.len()).filter(|c| candidates[*c].expression.is_some());
    let used: Vec<usize> = causes.iter().copied().chain(generic).collect();
    rough.know(&used);
    let rough = rough.system();
    let own = |k: &usize| {
        let others: Vec<usize> = causes.iter().filter(|c| *c != k).copied().collect();
        rough.distinct(*k, &others).max(LEAST_CHANGE_SHARE)
    };
    let mut kept_out: Vec<f64> =
        causes.iter().flat_map(|k| vec![rules.ridge * own(k); candidates[*k].regressors.len()]).collect();
    let columns = rough.columns(&used);
    let target = rough.train.ncols() - 1;
    let mut ridged = rough.train.clone();
    kept_out.resize(columns.len() - rough.base, rules.ridge);
    for (column, share) in columns[rough.base..].iter().zip(&kept_out) {
        ridged[(*column, *column)] *= 1.0 + share;
    }
    let solved = solve(&ridged, &columns, target)
        .ok_or_else(|| EstimateError::Other("the model could not be fitted to the recording".to_owned()))?;
    let residual = residual(y, base, candidates, &used, &solved);
    let weighted: Vec<f64> = residual.iter().zip(&layout.weight).map(|(r, w)| r * w).collect();
    Ok(whitener(&weighted, layout, &uses(layout)))
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
