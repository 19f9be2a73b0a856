//! The offset of two clocks from a signal that both recordings have.

use super::correlation::{self, Peak};
use super::edges;
use super::grid::{self, Signal};
use super::refine::{Minimum, Overlap};
use crate::mcap::resample;

/// Fewest samples of the slower signal in an overlap: a correlation of 0.28 (two standard errors) is chance with so many.
const LEAST_SAMPLES: f64 = 50.0;
/// Least residual variance at another offset, over that at the best one: the best one explains half of it. Twice as much
/// refuses signals that share three quarters of their variance.
const RIVAL_RESIDUAL: f64 = 2.0;
/// Residual share below which two offsets are not compared: filters, quanta, and rates of two devices differ so much.
const MODEL_ERROR: f64 = 0.01;
/// Probability up to which unrelated signals may agree as well at one of the offsets that were compared.
const BY_CHANCE: f64 = 0.05;
/// Standard errors from which the clocks run at different rates.
const SIGNIFICANT: f64 = 3.0;
/// Two-sided 95 % quantile of the normal distribution.
const QUANTILE_95: f64 = 1.96;
/// Most that the rates of two clocks differ. Source: oscillators without a quartz are given with up to 0.05 %.
const LARGEST_SKEW: f64 = 5e-4;
/// Fewest edges that show the ratio of the clocks: a line through fewer fits by chance.
const LEAST_EDGES: usize = 6;

/// The offset of two clocks: the log's time of an event is `t + offset_s + skew (t − middle_s)`, for the other's time t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockOffset {
    /// Seconds that are added to the other's times, at the middle of the overlap.
    pub offset_s: f64,
    /// Its standard error, s.
    pub standard_error_s: f64,
    /// Half of its 95 % interval, s; for edges it holds the half sample intervals.
    pub half_width_s: f64,
    /// Middle of the overlap, in the other's times, s.
    pub middle_s: f64,
    /// Seconds of the log's clock for a second of the other's, less one, with its standard error; none if it is not significant.
    pub skew: Option<(f64, f64)>,
    /// Correlation of the signals at the offset.
    pub correlation: f64,
}

/// Reason why no offset can be told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// A signal does not vary, or the signals are too short.
    Flat,
    /// No offset makes the signals alike: the best one, s, and its correlation.
    Unlike { offset_s: f64, correlation: f64 },
    /// Two offsets, s, fit about as well.
    Ambiguous { offset_s: f64, rival_s: f64 },
}

/// Estimates the offset of the clock of `other`. Gain, sign, and bias of the signals are free.
pub fn estimate(own: Signal<'_>, other: Signal<'_>) -> Result<ClockOffset, Refusal> {
    let is_usable = |s: Signal<'_>| s.time_s.len() as f64 >= LEAST_SAMPLES && s.values.iter().all(|v| v.is_finite());
    if !is_usable(own) || !is_usable(other) {
        return Err(Refusal::Flat);
    }
    let (own_grid, other_grid) = grid::grids(own, other).ok_or(Refusal::Flat)?;
    let step = own_grid.step_s;
    let slower = resample::period(own.time_s).max(resample::period(other.time_s));
    let peaks = correlation::peaks(&own_grid, &other_grid, LEAST_SAMPLES * slower / step).ok_or(Refusal::Flat)?;
    let seconds = |shift: f64| own_grid.start_s - other_grid.start_s + shift * step;
    let best = peaks.best;
    let unlike = Refusal::Unlike { offset_s: seconds(best.shift), correlation: best.r };
    // No offset explains enough for a comparison.
    if best.residual_share() * RIVAL_RESIDUAL > 1.0 {
        return Err(unlike);
    }
    let is_rival = |rival: &Peak| rival.residual_share() < RIVAL_RESIDUAL * best.residual_share().max(MODEL_ERROR);
    if let Some(rival) = peaks.rival.filter(is_rival) {
        return Err(Refusal::Ambiguous { offset_s: seconds(best.shift), rival_s: seconds(rival.shift) });
    }
    let overlap = Overlap::new(&own_grid, &other_grid, best.shift).ok_or(Refusal::Flat)?;
    let edges = (edges::edges(own), edges::edges(other));
    if !edges.0.is_empty() && !edges.1.is_empty() {
        let within_s = 4.0 * slower + LARGEST_SKEW * overlap.extent().1 * step;
        let pairs = edges::pairs(&edges.0, &edges.1, seconds(best.shift), within_s, best.r < 0.0);
        let half_sample_s = 0.5 * (resample::period(own.time_s) + resample::period(other.time_s));
        return from_edges(&pairs, half_sample_s, best.r).ok_or(unlike);
    }
    let [a, b] = overlap.series([best.shift, 0.0]);
    let independent = correlation::independent_samples(&a, &b);
    // Unrelated normal series agree so well with this probability (Fisher 1915), at one of the independent shifts.
    let chance = best.residual_share().powf(0.5 * (independent - 2.0).max(0.0));
    let tries = (peaks.shifts as f64 * independent / a.len() as f64).max(1.0);
    if tries * chance > BY_CHANCE {
        return Err(unlike);
    }
    let alone = overlap.minimum([best.shift, 0.0], 1).ok_or(unlike)?;
    let found = with_ratio(&overlap, alone).unwrap_or(alone);
    let (middle, half) = overlap.extent();
    // The other's time is (1 − k)(t − middle) apart from its middle.
    let (k, k_error) = (found.shift[1] / half, found.errors[1] / half);
    let middle_s = own_grid.start_s + middle * step - seconds(found.shift[0]);
    Ok(ClockOffset {
        offset_s: seconds(found.shift[0]),
        standard_error_s: found.errors[0] * step,
        half_width_s: QUANTILE_95 * found.errors[0] * step,
        middle_s,
        skew: (found.shift[1] != 0.0).then(|| (k / (1.0 - k), k_error)),
        correlation: best.r,
    })
}

/// The minimum with the ratio of the clocks, if the ratio is significant and lowers the residual.
fn with_ratio(overlap: &Overlap<'_>, alone: Minimum) -> Option<Minimum> {
    let both = overlap.minimum(alone.shift, 2)?;
    let is_significant = both.shift[1].abs() > SIGNIFICANT * both.errors[1];
    (is_significant && both.squares < alone.squares).then_some(both)
}

/// The offset from edges, each known to a sample. `pairs`: times of each edge in the log and in the other file, s.
/// `half_sample_s`: half the sum of both sample intervals.
fn from_edges(pairs: &[(f64, f64)], half_sample_s: f64, correlation: f64) -> Option<ClockOffset> {
    let count = pairs.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (middle_s, offset_s) = (mean(&|p| p.1), mean(&|p| p.0 - p.1));
    let long = pairs.iter().map(|p| (p.1 - middle_s).powi(2)).sum::<f64>();
    let slope = pairs.iter().map(|p| (p.1 - middle_s) * (p.0 - p.1 - offset_s)).sum::<f64>() / long;
    let spread = |slope: f64, free: f64| {
        let squares = pairs.iter().map(|p| (p.0 - p.1 - offset_s - slope * (p.1 - middle_s)).powi(2)).sum::<f64>();
        (squares / (count - free).max(1.0)).sqrt()
    };
    let slope_error = spread(slope, 2.0) / long.sqrt();
    let is_tilted = pairs.len() >= LEAST_EDGES && slope.abs() > SIGNIFICANT * slope_error;
    let scatter = spread(if is_tilted { slope } else { 0.0 }, if is_tilted { 2.0 } else { 1.0 }) / count.sqrt();
    // An edge lies anywhere between two samples: the variance of the even distribution over both intervals.
    let standard_error_s = scatter.hypot(half_sample_s / 3f64.sqrt());
    (!pairs.is_empty()).then_some(ClockOffset {
        offset_s,
        standard_error_s,
        half_width_s: (QUANTILE_95 * scatter).hypot(half_sample_s),
        middle_s,
        skew: is_tilted.then_some((slope, slope_error)),
        correlation,
    })
}

#[cfg(test)]
mod tests;
