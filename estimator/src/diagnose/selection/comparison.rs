use super::layout::Layout;
use super::normal_equations::{Solved, System};
use super::rules::Rules;
use super::stepwise::{SelectedTerm, Stepwise, without};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::hypotheses::variable::Variable;
use crate::diagnose::model_error::smooth::Discrepancy;
use crate::diagnose::model_error::standing::Competition;
use foundation::tasks::SystemState;

/// A compared channel, with everything but the words of its answer.
pub struct Compared {
    pub study: ChannelFit,
    /// Name of the channel, in words.
    pub channel: &'static str,
    pub unit: &'static str,
    /// Noise of its rows.
    pub floor: f64,
    /// True for rows that are held out in turn.
    pub along: Vec<bool>,
    pub state: Vec<SystemState>,
    pub view: View,
}

impl Compared {
    /// Structured errors of a size that matters, beyond doubt.
    pub fn structured(&self) -> Option<&Competition> {
        self.study.competition.as_ref().filter(|c| c.matters(self.floor))
    }
}

/// Rows of a channel, with the variables of their plots.
pub struct View {
    /// Recording of each row. Empty if all are shown together.
    pub recording: Vec<usize>,
    /// Sensor, or sum of sensors, of each row. A candidate cause is shown over all sensors that it may affect.
    pub sensor: Vec<usize>,
    /// Variables of the plots, with a value for each row.
    pub over: Vec<(Variable, Vec<f64>)>,
    /// Direction of motion in each row, as a sign. Empty if it does not matter.
    pub way: Vec<f64>,
    /// True if positions are angles.
    pub is_angular: bool,
    /// Variable that best shows a cause.
    pub best: fn(&str) -> Variable,
}

impl View {
    /// Rows of one sensor, without a direction.
    pub fn of(recording: Vec<usize>, over: Vec<(Variable, Vec<f64>)>, best: fn(&str) -> Variable) -> Self {
        let sensor = vec![0; over.first().map_or(0, |(_, values)| values.len())];
        Self { recording, sensor, over, way: Vec::new(), is_angular: false, best }
    }
}

/// Result of one comparison of causes, from which texts and figures are made.
pub struct ChannelFit {
    pub candidates: Vec<Candidate>,
    pub chosen: Vec<SelectedTerm>,
    pub system: System,
    /// Solution of all chosen causes on the training rows.
    pub solved: Option<Solved>,
    pub target: Vec<f64>,
    pub baseline: Vec<Vec<f64>>,
    pub layout: Layout,
    pub rules: Rules,
    /// Ratio of the dry friction to which the share regressors refer to the one estimated beside them, and its relative
    /// error.
    pub shares_of: [f64; 2],
    /// Structured errors that may stand beside the causes.
    pub errors: Vec<Discrepancy>,
    /// The chosen causes beside them.
    pub competition: Option<Competition>,
}

impl ChannelFit {
    /// A comparison with this choice. `rows`: target, regressors of the model, and layout.
    pub fn of(
        candidates: Vec<Candidate>,
        chosen: Vec<SelectedTerm>,
        system: System,
        (target, baseline, layout): (Vec<f64>, Vec<Vec<f64>>, Layout),
        rules: Rules,
    ) -> Self {
        let solved = system.solve(&chosen.iter().map(|c| c.candidate).collect::<Vec<usize>>());
        let (shares_of, errors) = ([1.0, 0.0], Vec::new());
        Self {
            candidates,
            chosen,
            system,
            solved,
            target,
            baseline,
            layout,
            rules,
            shares_of,
            errors,
            competition: None,
        }
    }

    /// Candidates that were chosen.
    pub fn picks(&self) -> Vec<usize> {
        self.chosen.iter().map(|c| c.candidate).collect()
    }

    /// The same without the k-th.
    pub fn picks_without(&self, k: usize) -> Vec<usize> {
        without(&self.picks(), k)
    }

    /// True if this cause was found.
    pub fn has(&self, id: &str) -> bool {
        self.chosen.iter().any(|c| self.candidates[c.candidate].id == id)
    }

    /// Reduces the share of a cause that rests on another channel by the share of that channel's structured errors.
    pub fn discount(&mut self, id: &str, other: &Competition) {
        let own = self.chosen.iter().map(|c| self.candidates[c.candidate].id == id);
        let standings = self.competition.iter_mut().flat_map(|c| &mut c.causes);
        standings.zip(own).filter(|(_, is)| *is).for_each(|(standing, _)| standing.share *= 1.0 - other.share);
    }

    /// Evidence of single candidates.
    pub fn of_each(&self) -> Stepwise<'_> {
        Stepwise::of_each(&self.system, &self.candidates)
    }

    /// Residual of a fit with these candidates, row by row; without a solution, the target.
    pub fn residual(&self, picks: &[usize]) -> Vec<f64> {
        self.system.solve(picks).map_or_else(|| self.target.clone(), |solved| self.residual_of(picks, &solved))
    }

    /// Residual of a solution with these candidates, row by row.
    pub fn residual_of(&self, picks: &[usize], solved: &Solved) -> Vec<f64> {
        residual(&self.target, &self.baseline, &self.candidates, picks, solved)
    }

    /// Each of these candidates with its coefficients. `values`: of the model's regressors, then of the candidates' ones.
    pub fn with_values<'a>(
        &'a self,
        picks: &[usize],
        values: &'a [f64],
    ) -> impl Iterator<Item = (&'a Candidate, &'a [f64])> {
        let mut at = self.baseline.len();
        picks.iter().map(move |p| {
            let candidate = &self.candidates[*p];
            let own = at..at + candidate.regressors.len();
            at = own.end;
            (candidate, &values[own])
        })
    }

    /// Each found cause with its coefficients; none without a solution.
    pub fn found(&self) -> Vec<(&Candidate, &[f64])> {
        self.solved.as_ref().map_or_else(Vec::new, |s| self.with_values(&self.picks(), &s.values).collect())
    }
}

pub fn residual(y: &[f64], base: &[Vec<f64>], candidates: &[Candidate], picks: &[usize], solved: &Solved) -> Vec<f64> {
    let columns: Vec<&Vec<f64>> =
        base.iter().chain(picks.iter().flat_map(|p| &candidates[*p].regressors).map(|c| &**c)).collect();
    (0..y.len()).map(|i| y[i] - columns.iter().zip(&solved.values).map(|(c, v)| c[i] * v).sum::<f64>()).collect()
}
