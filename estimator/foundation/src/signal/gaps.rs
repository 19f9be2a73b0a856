//! Gaps of a clock: steps far above the usual one.

use super::thinned::thinned;

/// A step of more than this many periods is a gap, below it a few samples were dropped.
const GAP_PERIODS: f64 = 10.0;
/// Fewer steps do not show the usual one.
const MIN_STEPS: usize = 8;

/// The usual step of a clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UsualStep {
    /// Median, s.
    pub median_s: f64,
    /// Step that only few exceed, s.
    pub high_s: f64,
}

impl UsualStep {
    /// `None` where there are too few steps.
    pub fn of(time_s: &[f64]) -> Option<Self> {
        if time_s.len() <= MIN_STEPS {
            return None;
        }
        let step = |i: usize| time_s[i + 1] - time_s[i];
        let mut ordered: Vec<f64> = thinned(time_s.len() - 1).map(step).collect();
        ordered.sort_unstable_by(f64::total_cmp);
        Some(Self { median_s: ordered[ordered.len() / 2], high_s: ordered[ordered.len() * 95 / 100] })
    }

    /// Step above which there is a gap in the time, or a jump of the clock, s.
    pub fn gap_above_s(&self) -> f64 {
        (GAP_PERIODS * self.median_s).max(5.0 * self.high_s)
    }
}

/// Step above which there is a gap in the time, or a jump of the clock, s; `None` if too few steps show the usual one.
pub fn gap_above_s(time_s: &[f64]) -> Option<f64> {
    UsualStep::of(time_s).map(|usual| usual.gap_above_s())
}

/// Samples after which such a step follows.
pub fn gaps(time_s: &[f64]) -> Vec<usize> {
    let above_s = gap_above_s(time_s).unwrap_or(f64::INFINITY);
    let steps = time_s.windows(2).enumerate();
    steps.filter(|(_, pair)| pair[1] - pair[0] > above_s).map(|(i, _)| i).collect()
}
