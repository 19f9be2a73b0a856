//! Gain of a cause on the locked blocks, which took part in neither the choice nor the fit.

use super::comparison::ChannelFit;
use super::layout::Use;
use super::normal_equations::solve;
use crate::diagnose::contract::Gain;
use crate::diagnose::hypotheses::candidate::Column;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Draws of the bootstrap over locked blocks.
/// Choice: halved or doubled, none of 75 answers changes.
pub(crate) const DRAWS: usize = 400;
/// Number of parts into which each locked block is cut for the bootstrap.
/// Choice: halved or doubled, none of 72 answers changes.
const PARTS_OF_A_BLOCK: usize = 4;
/// Lags of the test for whiteness.
/// Choice: halved or doubled, none of 90 answers changes.
const LAGS: usize = 10;
/// Least change by a cause on held-out rows, 2 ln(likelihood), for them to count for or against it. A true cause gains
/// about as much there, ± twice its root.
/// Choice: halved or doubled, none of 72 answers changes.
const TESTED: f64 = 3.0;
/// Relative change that is none: of the power of a residual, of the error of a rollout, of a known length.
/// Choice: halved or doubled, none of 75 answers changes.
pub(crate) const LEAST_CHANGE_SHARE: f64 = 1e-3;

/// Sums of squares over parts of the locked blocks, and rows.
#[derive(Default)]
struct Parts {
    before: Vec<f64>,
    after: Vec<f64>,
    /// Squares of the difference of the two residuals.
    changed: Vec<f64>,
    rows: Vec<f64>,
}

/// Weighted residuals of a subset of the chosen causes, all rows.
fn residual(study: &ChannelFit, picks: &[usize]) -> Vec<f64> {
    weighted(study, &study.residual(picks))
}

/// The same beside the structured error of the channel.
fn residual_beside(study: &ChannelFit, picks: &[usize]) -> Vec<f64> {
    weighted(study, &without_error(study, study.residual(picks)))
}

/// A residual without the structured error of the channel.
fn without_error(study: &ChannelFit, mut residual: Vec<f64>) -> Vec<f64> {
    let error = study.competition.iter().flat_map(|c| &c.error);
    residual.iter_mut().zip(error).for_each(|(r, e)| *r -= e);
    residual
}

fn weighted(study: &ChannelFit, residual: &[f64]) -> Vec<f64> {
    residual.iter().zip(&study.layout.weight).map(|(r, w)| r * w).collect()
}

/// Root mean square over the locked rows, and over those that train.
pub fn rms(study: &ChannelFit, picks: &[usize], along: &[bool]) -> (f64, f64) {
    let residual = residual(study, picks);
    let over = |wanted: &dyn Fn(Use) -> bool| {
        let (sum, n) = (0..residual.len())
            .filter(|i| along[*i] && wanted(study.system.uses[*i]))
            .fold((0.0, 0_u32), |(s, n), i| (s + residual[i].powi(2), n + 1));
        (sum / f64::from(n.max(1))).sqrt()
    };
    let train = over(&|u| matches!(u, Use::Fold(_)));
    let locked = over(&|u| matches!(u, Use::Locked(_)));
    (if locked > 0.0 { locked } else { train }, train)
}

/// The gain by the k-th of the chosen causes, all others in.
pub fn gain(study: &ChannelFit, k: usize, floor: f64) -> Gain {
    let picks = study.picks();
    let rest = study.picks_without(k);
    gain_between(study, &rest, &picks, floor)
}

/// Gain by additional causes. Effects on standing rows are tested there, too.
pub fn gain_between(study: &ChannelFit, rest: &[usize], picks: &[usize], floor: f64) -> Gain {
    let more: Vec<usize> = picks.iter().filter(|p| !rest.contains(p)).copied().collect();
    let in_turn = !holds_out(study);
    let parts = if in_turn {
        parts_in_turn(study, rest, picks)
    } else {
        parts(study, &residual_beside(study, rest), &residual_beside(study, picks), shows_beside(study, &more))
    };
    if parts.rows.is_empty() {
        return Gain { no_share: Some("there were too few rows to hold any out".to_owned()), ..Gain::default() };
    }
    let all: Vec<usize> = (0..parts.rows.len()).collect();
    let [b, a] = means(&parts, &all);
    // The noise is at most the final residual, whatever other estimate exists.
    let noise = (floor * floor * mean_square_weight(study)).min(a);
    let least = b - noise;
    let measured = Gain { heldout_rms_before: b.sqrt(), heldout_rms_after: a.sqrt(), in_turn, ..Gain::default() };
    if parts.changed.iter().sum::<f64>() < TESTED * a.min(b) {
        return Gain { no_share: Some("nothing that was held out could show it".to_owned()), ..measured };
    }
    if least < LEAST_CHANGE_SHARE * b {
        return Gain { no_share: Some("what was held out is left with no more than its noise".to_owned()), ..measured };
    }
    let share = |b: f64, a: f64| ((b - a) / (b - noise).max(LEAST_CHANGE_SHARE * b)).min(1.0);
    let shares = |drawn: &[usize]| {
        let [b, a] = means(&parts, drawn);
        share(b, a)
    };
    let interval = bootstrap(all.len(), DRAWS, &shares);
    Gain { share_of_explainable: share(b, a), interval, ..measured }
}

/// True if rows were kept out of both choice and fit. A short recording has too few.
pub fn holds_out(study: &ChannelFit) -> bool {
    study.system.uses.iter().any(|u| matches!(u, Use::Locked(_)))
}

/// Each fold predicted by a fit to all other rows, for recordings too short to lock any rows.
fn parts_in_turn(study: &ChannelFit, rest: &[usize], picks: &[usize]) -> Parts {
    let mut parts = Parts::default();
    for (fold, (products, rows)) in study.system.folds.iter().enumerate().filter(|(_, (_, rows))| *rows > 0.0) {
        let others = &study.system.train - products;
        let residual = |picks: &[usize]| {
            let solved = solve(&others, &study.system.columns(picks), others.ncols() - 1)?;
            Some(weighted(study, &without_error(study, study.residual_of(picks, &solved))))
        };
        let (Some(before), Some(after)) = (residual(rest), residual(picks)) else { continue };
        let own: Vec<usize> = (0..before.len()).filter(|i| study.system.uses[*i] == Use::Fold(fold)).collect();
        let pieces = PARTS_OF_A_BLOCK.min(*rows as usize).max(1);
        own.chunks(own.len().div_ceil(pieces).max(1)).for_each(|part| parts.add(part, &before, &after));
    }
    parts
}

/// Evidence for the k-th chosen cause, beside all others, on the rows that neither chose nor fitted it: 2
/// ln(likelihood) of the whitened rows. Negative if it increases the error.
pub fn confirmed(study: &ChannelFit, k: usize) -> f64 {
    held_out(study, k, &|before, after| before * before - after * after)
}

/// True if those rows could speak for or against it.
pub fn is_tested(study: &ChannelFit, k: usize) -> bool {
    held_out(study, k, &|before, after| (before - after).powi(2)) > TESTED
}

/// Sum over the held-out, whitened rows of a function of the residuals without and with the k-th chosen cause, beside
/// all others. The noise has unit variance.
fn held_out(study: &ChannelFit, k: usize, of: &dyn Fn(f64, f64) -> f64) -> f64 {
    let picks = study.picks();
    let rest = study.picks_without(k);
    let white = |picks: &[usize]| whitened(study, &residual_beside(study, picks));
    let (before, after) = (white(&rest), white(&picks));
    let over = |wanted: &dyn Fn(Use) -> bool, of: &dyn Fn(f64, f64) -> f64| {
        let rows = study.system.uses.iter().zip(before.iter().zip(&after)).filter(|(used, _)| wanted(**used));
        rows.filter_map(|(_, (b, a))| Some(of((*b)?, (*a)?))).fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0))
    };
    let (power, rows) = over(&|u| matches!(u, Use::Fold(_)), &|_, a| a * a);
    let (sum, _) = over(&|u| matches!(u, Use::Locked(_) | Use::Beside(_)), of);
    // Normalised to the noise of the training rows.
    if power > 0.0 { sum * rows / power } else { 0.0 }
}

/// Rows whitened by the noise's autoregression; `None` at the start of a segment, before enough rows precede.
fn whitened(study: &ChannelFit, values: &[f64]) -> Vec<Option<f64>> {
    let (segment, coefficients) = (&study.layout.segment, &study.system.coefficients);
    let mut since = 0;
    (0..values.len())
        .map(|i| {
            since = if i > 0 && segment[i] == segment[i - 1] { since + 1 } else { 0 };
            let past = || coefficients.iter().enumerate().map(|(k, c)| c * values[i - k - 1]).sum::<f64>();
            (since >= coefficients.len()).then(|| values[i] - past())
        })
        .collect()
}

/// True if some of these causes affect held-out rows that are not about the force.
pub fn shows_beside(study: &ChannelFit, picks: &[usize]) -> bool {
    let beside = |i: usize| matches!(study.system.uses[i], Use::Beside(_));
    let shows = |column: &Column| column.iter().enumerate().any(|(i, v)| beside(i) && *v != 0.0);
    picks.iter().any(|p| study.candidates[*p].regressors.iter().any(shows))
}

/// 95 % confidence interval of a figure by a bootstrap over blocks, with the same random draws every time.
pub fn bootstrap(pieces: usize, draws: usize, figure: &dyn Fn(&[usize]) -> f64) -> [f64; 2] {
    let mut state = 0x2545_F491_4F6C_DD1D_u64;
    let mut figures: Vec<f64> = (0..draws)
        .map(|_| {
            let drawn: Vec<usize> = (0..pieces)
                .map(|_| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    ((state >> 33) as usize) % pieces.max(1)
                })
                .collect();
            figure(&drawn)
        })
        .collect();
    figures.sort_by(f64::total_cmp);
    [0.025, 0.975].map(|q| figures.get(((figures.len().saturating_sub(1)) as f64 * q) as usize).copied().unwrap_or(0.0))
}

fn mean_square_weight(study: &ChannelFit) -> f64 {
    let is_held_out = |u: Use| if holds_out(study) { matches!(u, Use::Locked(_)) } else { matches!(u, Use::Fold(_)) };
    let locked = (0..study.layout.rows()).filter(|i| is_held_out(study.system.uses[*i]));
    let (sum, n) = locked.fold((0.0, 0_u32), |(s, n), i| (s + study.layout.weight[i].powi(2), n + 1));
    if n > 0 { sum / f64::from(n) } else { 1.0 }
}

fn parts(study: &ChannelFit, before: &[f64], after: &[f64], with_beside: bool) -> Parts {
    let locked: Vec<(usize, usize)> = study
        .system
        .uses
        .iter()
        .enumerate()
        .filter_map(|(i, u)| match u {
            Use::Locked(block) => Some((*block, i)),
            Use::Beside(block) if with_beside => Some((*block, i)),
            _ => None,
        })
        .collect();
    let mut parts = Parts::default();
    for block in locked.chunk_by(|a, b| a.0 == b.0) {
        let rows: Vec<usize> = block.iter().map(|(_, i)| *i).collect();
        rows.chunks(rows.len().div_ceil(PARTS_OF_A_BLOCK).max(1)).for_each(|part| parts.add(part, before, after));
    }
    parts
}

impl Parts {
    /// Adds a part: these rows, with their residuals without and with the cause.
    fn add(&mut self, rows: &[usize], before: &[f64], after: &[f64]) {
        let sum = |of: &dyn Fn(usize) -> f64| rows.iter().map(|i| of(*i).powi(2)).sum::<f64>();
        self.before.push(sum(&|i| before[i]));
        self.after.push(sum(&|i| after[i]));
        self.changed.push(sum(&|i| before[i] - after[i]));
        self.rows.push(rows.len() as f64);
    }
}

fn means(parts: &Parts, picked: &[usize]) -> [f64; 2] {
    let rows: f64 = picked.iter().map(|p| parts.rows[*p]).sum::<f64>().max(1.0);
    let mean = |values: &[f64]| picked.iter().map(|p| values[*p]).sum::<f64>() / rows;
    [mean(&parts.before), mean(&parts.after)]
}

/// Probability that white residuals would be at least as correlated (Ljung & Box 1978), after the noise's own
/// autoregression.
pub fn whiteness_p(study: &ChannelFit, picks: &[usize]) -> f64 {
    let white: Vec<f64> = whitened(study, &residual(study, picks)).into_iter().flatten().collect();
    let n = white.len() as f64;
    let power: f64 = white.iter().map(|v| v * v).sum();
    if white.len() < 3 * LAGS || power <= 0.0 {
        return 1.0;
    }
    let correlation = |lag: usize| white.iter().zip(&white[lag..]).map(|(a, b)| a * b).sum::<f64>() / power;
    let q: f64 = (1..=LAGS).map(|lag| correlation(lag).powi(2) / (n - lag as f64)).sum::<f64>() * n * (n + 2.0);
    chi_square_tail(q, LAGS as f64)
}

/// Probability of at least `value` by chance.
pub fn chi_square_tail(value: f64, freedom: f64) -> f64 {
    ChiSquared::new(freedom).map_or(1.0, |d| d.sf(value.max(0.0)))
}
