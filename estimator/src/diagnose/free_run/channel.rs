//! Channels whose rows are dealt out: every second row trains, or rows from everywhere are held out together, so that
//! no window is left that took part in nothing. Each window is left out of the fit in turn; its rows took part in the
//! choice.

use super::windows::{Compared, Errors, ROLLOUT_WINDOW_S, told};
use crate::diagnose::contract::{Rollout, RolloutOf};
use crate::diagnose::selection::comparison::ChannelFit;

/// Most windows, taken evenly from the whole recording; more add no information.
const MOST_WINDOWS: usize = 60;
/// Least share of a window's rows in which a cause acts.
const ACTS: f64 = 0.5;
/// Least number of rows in a window. Holds and pushes are short, so a window lasts as long as nothing interrupts it.
const LEAST_WINDOW_ROWS: usize = 5;
/// Largest time step, in row periods, within one window.
const CONSECUTIVE_PERIODS: f64 = 1.6;

/// A channel with a free-run simulation.
pub trait Forward {
    /// Compared quantity and its unit.
    fn of(&self) -> (RolloutOf, &str);
    /// Rows of every window, in the order of time.
    fn windows(&self) -> Vec<Vec<usize>>;
    /// Longest window, s.
    fn window_s(&self) -> f64 {
        ROLLOUT_WINDOW_S
    }
    /// Sum of squared errors over a window and their number, with these candidates. `values`: of the model's
    /// regressors, then of the candidates' ones. The error is the reason why their laws cannot be simulated.
    fn errors(&self, study: &ChannelFit, window: &[usize], picks: &[usize], values: &[f64]) -> Result<Errors, String>;
}

/// Columns of the model and of the candidates with their values.
pub fn columns<'a>(
    study: &'a ChannelFit,
    picks: &'a [usize],
    values: &'a [f64],
) -> impl Iterator<Item = (&'a [f64], f64)> {
    let of_causes = picks.iter().flat_map(|p| &study.candidates[*p].columns).map(|column| column.as_slice());
    study.base.iter().map(Vec::as_slice).chain(of_causes).zip(values.iter().copied())
}

/// Windows of consecutive rows: `order` has them by time, `same` is true if two belong together.
pub fn consecutive(
    order: &[usize],
    time_s: &dyn Fn(usize) -> f64,
    period_s: f64,
    same: &dyn Fn(usize, usize) -> bool,
) -> Vec<Vec<usize>> {
    let goes_on = |a: usize, b: usize| {
        same(a, b) && (0.0..CONSECUTIVE_PERIODS * period_s).contains(&(time_s(b) - time_s(a))) && a != b
    };
    let most = ((ROLLOUT_WINDOW_S / period_s).round() as usize).max(LEAST_WINDOW_ROWS) + 1;
    order
        .chunk_by(|a, b| goes_on(*a, *b))
        .flat_map(|run| run.chunks(most))
        .filter(|w| w.len() >= LEAST_WINDOW_ROWS)
        .map(<[usize]>::to_vec)
        .collect()
}

/// The rollout without and with the k-th of the chosen causes, all others in, over the windows in which it acts.
pub fn in_turn(study: &ChannelFit, channel: &dyn Forward, k: usize) -> Result<Rollout, String> {
    let picks = study.picks();
    let rest: Vec<usize> = picks.iter().enumerate().filter(|(i, _)| *i != k).map(|(_, p)| *p).collect();
    let own = &study.candidates[picks[k]].columns;
    let acts = |row: &&usize| own.iter().any(|column| column[**row] != 0.0);
    let mut windows = channel.windows();
    windows.retain(|w| w.iter().filter(acts).count() as f64 >= ACTS * w.len() as f64);
    let every = windows.len().div_ceil(MOST_WINDOWS).max(1);
    let mut compared: Vec<[Errors; 2]> = Vec::new();
    for window in windows.iter().step_by(every) {
        let solved = (study.system.without(window, &rest), study.system.without(window, &picks));
        // A value that only this window determines is unknown without it.
        let (Some(without), Some(with)) = solved else { continue };
        let errors = |picks: &[usize], values: &[f64]| channel.errors(study, window, picks, values);
        compared.push([errors(&rest, &without)?, errors(&picks, &with)?]);
    }
    let (of, unit) = channel.of();
    told(&Compared { of, unit, window_s: channel.window_s(), in_turn: true }, &compared)
}
