//! Removal of causes that held-out rows or blocks of the recording do not confirm.

use super::comparison::ChannelFit;
use super::held_out_gain::{confirmed, gain, holds_out, is_tested};
use super::profile_likelihood::firsts;

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
    let first = firsts(study, &picks)[k];
    let own = first..first + study.candidates[picks[k]].columns.len();
    study.system.steadiness(solved, &own) > study.rules.steady
}

/// A chosen cause whose estimate no longer fits its name after another one was removed.
fn impossible(study: &ChannelFit) -> Option<usize> {
    study.found().iter().position(|(candidate, values)| !candidate.admits(values))
}
