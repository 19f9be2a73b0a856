//! Two signals on grids of one step, with marks where nothing was measured.

use crate::mcap::resample;
use crate::raw::Cells;
use foundation::signal::filter;

/// Samples of the grid in a period of the slower signal. With one of them, noise between samples is smaller than noise at
/// samples, which draws the offset to a half sample.
const FINENESS: f64 = 4.0;
/// Cut-off of the low-pass of both signals (−6 dB), as a share of the slower rate: [`filter::MAX_CUTOFF_SHARE`].
const CUTOFF_SHARE: f64 = filter::MAX_CUTOFF_SHARE;
/// Most samples of a grid: four minutes at 100 Hz. A longer recording has a coarser grid.
const MOST_SAMPLES: f64 = 131_072.0;

/// A signal: its times, s, strictly increasing, and as many values.
#[derive(Clone, Copy, Debug)]
pub struct Signal<'a> {
    /// Times, s.
    pub time_s: &'a [f64],
    /// Values, in any unit.
    pub values: &'a [f64],
}

/// A signal on an even grid.
#[derive(Clone, Debug)]
pub struct Grid {
    /// Time of the first sample, s.
    pub start_s: f64,
    /// Step, s.
    pub step_s: f64,
    /// Values, with zero mean and unit variance over the marked samples.
    pub values: Vec<f64>,
    /// 1 for a sample that was measured, 0 within a gap.
    pub weight: Vec<f64>,
}

/// Both signals on grids of one step; none if one does not vary, or has too few samples for a grid.
pub fn grids(own: Signal<'_>, other: Signal<'_>) -> Option<(Grid, Grid)> {
    let span = |s: Signal<'_>| Some(s.time_s.last()? - s.time_s.first()?);
    let slower = resample::period(own.time_s).max(resample::period(other.time_s));
    let step = (slower / FINENESS).max(span(own)?.max(span(other)?) / MOST_SAMPLES);
    (step > 0.0).then(|| Some((Grid::of(own, step, slower)?, Grid::of(other, step, slower)?)))?
}

impl Grid {
    /// `slower_s`: period of the slower signal.
    fn of(signal: Signal<'_>, step_s: f64, slower_s: f64) -> Option<Self> {
        let (start_s, end_s) = (*signal.time_s.first()?, *signal.time_s.last()?);
        let count = ((end_s - start_s) / step_s).floor() as usize + 1;
        let time: Vec<f64> = (0..count).map(|i| (start_s + i as f64 * step_s).min(end_s)).collect();
        let Cells::Numbers(even) = resample::onto(&time, signal.time_s, &Cells::Numbers(signal.values.to_vec())) else {
            return None;
        };
        let mut values = filter::low_pass(&even, 1.0 / step_s, CUTOFF_SHARE / slower_s);
        let covered = resample::covered(signal.time_s, &time);
        let weight: Vec<f64> = covered.into_iter().map(f64::from).collect();
        let count: f64 = weight.iter().sum();
        let mean = |of: &dyn Fn(f64) -> f64| values.iter().zip(&weight).map(|(v, w)| w * of(*v)).sum::<f64>() / count;
        let middle = mean(&|v| v);
        let spread = mean(&|v| (v - middle) * (v - middle)).sqrt();
        if !(spread.is_finite() && spread > 0.0) {
            return None;
        }
        for value in &mut values {
            *value = (*value - middle) / spread;
        }
        Some(Self { start_s, step_s, values, weight })
    }

    /// Value at a place in steps from the start, by a cubic through four neighbours (Catmull & Rom 1974); the ends are
    /// held.
    pub fn at(&self, place: f64) -> f64 {
        let last = self.values.len() - 1;
        let place = place.clamp(0.0, last as f64);
        let i = (place as usize).min(last.saturating_sub(1));
        let u = place - i as f64;
        let value = |k: usize| self.values[k.min(last)];
        let [a, b, c, d] = [value(i.saturating_sub(1)), value(i), value(i + 1), value(i + 2)];
        b + 0.5 * u * (c - a + u * (2.0 * a - 5.0 * b + 4.0 * c - d + u * (3.0 * (b - c) + d - a)))
    }

    /// True if the sample at a place in steps from the start was measured.
    pub fn is_measured(&self, place: f64) -> bool {
        let last = self.values.len() - 1;
        (0.0..=last as f64).contains(&place) && self.weight[place as usize] > 0.0
    }
}
