use super::normal_equations::{Solved, System};
use super::stepwise::Chosen;
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::segment::SystemState;

/// A compared channel, with everything but the words of its answer.
pub struct Compared {
    /// The comparison.
    pub study: Study,
    /// Name of the channel, in words.
    pub channel: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Noise of its rows.
    pub floor: f64,
    /// True for rows that are held out in turn.
    pub along: Vec<bool>,
    pub stretch: Vec<usize>,
    /// The state of every row.
    pub state: Vec<SystemState>,
}

/// Result of one comparison of causes, from which texts and figures are made.
pub struct Study {
    pub candidates: Vec<Candidate>,
    pub chosen: Vec<Chosen>,
    pub system: System,
    /// Solution of all chosen causes on the training rows.
    pub solved: Option<Solved>,
    /// The target.
    pub y: Vec<f64>,
    pub base: Vec<Vec<f64>>,
    pub weight: Vec<f64>,
    /// Ratio of the dry friction to which the share regressors refer to the one estimated beside them, and its relative
    /// error.
    pub shares_of: [f64; 2],
}

impl Study {
    /// Candidates that were chosen.
    pub fn picks(&self) -> Vec<usize> {
        self.chosen.iter().map(|c| c.candidate).collect()
    }
}

/// Residual of `y`.
pub fn residual(y: &[f64], base: &[Vec<f64>], candidates: &[Candidate], picks: &[usize], solved: &Solved) -> Vec<f64> {
    let columns: Vec<&Vec<f64>> =
        base.iter().chain(picks.iter().flat_map(|p| &candidates[*p].columns).map(|c| &**c)).collect();
    (0..y.len()).map(|i| y[i] - columns.iter().zip(&solved.values).map(|(c, v)| c[i] * v).sum::<f64>()).collect()
}
