//! Standing of the causes of a channel beside structured errors.

use crate::diagnose::contract::{Gain, Standing};
use crate::diagnose::data::limits::{HALF, SURE};
use crate::diagnose::selection::rules::Rules;

impl Standing {
    /// Calibrated probability that the cause, or one that could stand in its place, is there: its weakest test decides.
    pub(crate) fn probability(self, gain: &Gain, rules: &Rules) -> f64 {
        // Of few rows, few are held out.
        let needed = if rules.is_sparse { HALF * rules.threshold } else { rules.threshold };
        let held_out = match &gain.no_share {
            Some(_) => f64::INFINITY,
            None if gain.heldout_rms_after > gain.heldout_rms_before => HALF,
            None => self.held_out_evidence / needed,
        };
        let weakest = (self.ln_bayes_factor / rules.certain).min(self.share / rules.certain_share).min(held_out);
        let log_odds = 3.0 + 6.0 * (weakest.clamp(0.0, 1.2) - 1.0);
        1.0 / (1.0 + (-log_odds).exp())
    }
}

/// Result of a competition.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Competition {
    /// Standing of every chosen cause, in the order of the choice.
    pub causes: Vec<Standing>,
    /// Sum of all discrepancies of the best model, row by row, and the RMS of its part beside the model.
    pub error: Vec<f64>,
    pub rms: f64,
    /// Variables of these discrepancies, with the RMS of each.
    pub over: Vec<(&'static str, f64)>,
    /// Evidence of all discrepancies together beside the causes, ln(likelihood) less their penalties.
    pub evidence: f64,
    /// Evidence of the whole model, ln(likelihood) less its penalties, and the effective number of its rows.
    pub whole: [f64; 2],
    /// Power of the discrepancies as a share of theirs and that of the causes.
    pub share: f64,
    /// Discrepancies of the best model with the variances of their coefficients beside that of the noise.
    pub used: Vec<(usize, f64)>,
    /// Autoregression of the noise that the best model leaves.
    pub coefficients: Vec<f64>,
}

impl Competition {
    /// True if the discrepancies are of a size that matters beside this noise, beyond doubt.
    pub fn matters(&self, floor: f64) -> bool {
        self.rms > HALF * floor && 2.0 * self.evidence > SURE
    }
}
