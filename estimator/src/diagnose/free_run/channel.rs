//! Channels whose rows are dealt out: every second row trains, or rows from everywhere are held out together, so that
//! no window is left that took part in nothing. Each window is left out of the fit in turn; its rows took part in the
//! choice.

use super::windows::{Compared, Errors, ROLLOUT_WINDOW_S, told, windows};
use crate::diagnose::contract::{Rollout, RolloutOf};
use crate::diagnose::data::limits::{GAP_IN_PERIODS, HALF};
use crate::diagnose::hypotheses::candidate::Candidate;
use crate::diagnose::selection::comparison::ChannelFit;

/// Least number of rows in a window. Holds and pushes are short, so a window lasts as long as nothing interrupts it.
/// Choice: halved or doubled, none of 26 answers changes.
const LEAST_WINDOW_ROWS: usize = 5;

/// A channel with a free-run simulation.
pub trait Forward {
    /// Compared quantity and its unit.
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Force, "N")
    }
    /// Rows of every window, in the order of time.
    fn windows(&self) -> Vec<Vec<usize>>;
    fn window_s(&self) -> f64 {
        ROLLOUT_WINDOW_S
    }
    /// Sum of squared errors over a window, and their number. The error is the reason why the laws of the candidates
    /// cannot be simulated.
    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String>;
}

/// Candidates of a channel with the values of a fit. `values`: of the model's regressors, then of the candidates' ones.
pub struct Fit<'a> {
    pub study: &'a ChannelFit,
    pub picks: &'a [usize],
    pub values: &'a [f64],
}

impl<'a> Fit<'a> {
    /// Each candidate with its own values.
    pub fn causes(&self) -> impl Iterator<Item = (&'a Candidate, &'a [f64])> {
        self.study.with_values(self.picks, self.values)
    }

    /// Regressors of the model and of the candidates, with their values.
    pub fn columns(&self) -> impl Iterator<Item = (&'a [f64], f64)> {
        let Self { study, picks, values } = *self;
        let of_causes = picks.iter().flat_map(|p| &study.candidates[*p].regressors).map(|column| column.as_slice());
        study.baseline.iter().map(Vec::as_slice).chain(of_causes).zip(values.iter().copied())
    }

    /// Measured quantity less the contribution of these regressors in a row.
    pub fn less(&self, row: usize, columns: &[(&[f64], f64)]) -> f64 {
        self.study.target[row] - columns.iter().map(|(column, value)| value * column[row]).sum::<f64>()
    }
}

/// Windows of consecutive rows: `order` has them by time, `same` is true if two belong together.
pub fn consecutive(
    order: &[usize],
    time_s: &dyn Fn(usize) -> f64,
    period_s: f64,
    same: &dyn Fn(usize, usize) -> bool,
) -> Vec<Vec<usize>> {
    let goes_on = |a: usize, b: usize| {
        same(a, b) && (0.0..GAP_IN_PERIODS * period_s).contains(&(time_s(b) - time_s(a))) && a != b
    };
    let most = ((ROLLOUT_WINDOW_S / period_s).round() as usize).max(LEAST_WINDOW_ROWS) + 1;
    windows(order, [LEAST_WINDOW_ROWS, most], goes_on)
}

/// The rollout without and with the k-th of the chosen causes, all others in, over the windows in which it acts.
pub fn in_turn(study: &ChannelFit, channel: &dyn Forward, k: usize) -> Result<Rollout, String> {
    let picks = study.picks();
    let rest = study.picks_without(k);
    let own = &study.candidates[picks[k]].regressors;
    let acts = |row: &&usize| own.iter().any(|column| column[**row] != 0.0);
    let mut windows = channel.windows();
    windows.retain(|w| w.iter().filter(acts).count() as f64 >= HALF * w.len() as f64);
    let mut compared: Vec<[Errors; 2]> = Vec::new();
    for window in &windows {
        let solved = (study.system.without(window, &rest), study.system.without(window, &picks));
        // A value that only this window determines is unknown without it.
        let (Some(without), Some(with)) = solved else { continue };
        let errors = |picks: &[usize], values: &[f64]| channel.errors(&Fit { study, picks, values }, window);
        compared.push([errors(&rest, &without)?, errors(&picks, &with)?]);
    }
    let (of, unit) = channel.of();
    told(&Compared { of, unit, window_s: channel.window_s(), in_turn: true }, &compared)
}

/// Compliant pads under a measured force, whose damping delays the displacement after the force: a channel of positions,
/// with the rate of the position among the regressors of its model.
pub struct Pads {
    pub time_s: Vec<f64>,
    pub stretch: Vec<usize>,
    pub period_s: f64,
    /// Index of the rate among the model's regressors.
    pub rate: usize,
}

impl Forward for Pads {
    fn of(&self) -> (RolloutOf, &str) {
        (RolloutOf::Position, "m")
    }

    fn windows(&self) -> Vec<Vec<usize>> {
        let all: Vec<usize> = (0..self.time_s.len()).collect();
        consecutive(&all, &|i| self.time_s[i], self.period_s, &|a, b| self.stretch[a] == self.stretch[b])
    }

    /// place = give of the force + lag · rate, stepped where each step ends: a lag that runs ahead of the force is
    /// noise, and none.
    fn errors(&self, fit: &Fit<'_>, window: &[usize]) -> Result<Errors, String> {
        let lag_s = (-fit.values[self.rate]).max(0.0);
        let beside = fit.columns().enumerate().filter(|(k, _)| *k != self.rate);
        let given: Vec<(&[f64], f64)> = beside.map(|(_, column)| column).collect();
        let measured = &fit.study.target;
        let mut place = measured[window[0]];
        let (mut sum, mut count) = (0.0, 0.0);
        for pair in window.windows(2) {
            let step_s = (self.time_s[pair[1]] - self.time_s[pair[0]]).max(1e-9);
            let given = given.iter().map(|(column, value)| value * column[pair[1]]).sum::<f64>();
            place = (given + lag_s / step_s * place) / (1.0 + lag_s / step_s);
            sum += (place - measured[pair[1]]).powi(2);
            count += 1.0;
        }
        Ok((sum, count))
    }
}
