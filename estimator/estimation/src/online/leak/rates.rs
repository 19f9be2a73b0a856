//! The rates that the readings show, with errors.

use super::weighing::{Measured, Series, Weighing};
use crate::regression::linear::least_squares;
use foundation::estimate::EstimateError;

/// Fewer samples show no rate with an error.
const LEAST_SAMPLES: usize = 12;
/// Free readings count as before and after when they lie on both sides of the middle of the carry, by at least this share of its length.
const AROUND: f64 = 0.25;

/// The rates, N/s.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rates {
    /// Of the reading while carried.
    pub(super) reading: Measured,
    /// Of the bias, from readings without the object on both sides of the carry.
    pub(super) drift: Option<Measured>,
    /// Of the horizontal sum while carried.
    pub(super) across: Option<Measured>,
    /// The left finger's share of the change of the reading.
    pub(super) share: Option<Measured>,
    /// True if there are free readings before the middle of the carry; `after`: the same after it.
    pub(super) before: bool,
    pub(super) after: bool,
    /// Duration of the carry, s.
    pub(super) lasted_s: f64,
}

impl Rates {
    /// Rate of the weight itself, N/s.
    pub(super) fn weight(&self) -> Option<Measured> {
        self.drift.map(|d| Measured {
            value: self.reading.value - d.value,
            std_error: self.reading.std_error.hypot(d.std_error),
        })
    }
}

pub(super) fn rates(weighing: &Weighing<'_>) -> Result<Rates, EstimateError> {
    let Weighing { carried, free, others, across_n, fingers_n, .. } = *weighing;
    for series in std::iter::once(&carried).chain(std::iter::once(&free)).chain(others) {
        check(series)?;
    }
    let aligned = |values: &[f64]| values.len() == carried.time_s.len() && values.iter().all(|v| v.is_finite());
    if across_n.is_some_and(|a| !aligned(a)) || fingers_n.is_some_and(|f| !f.iter().all(|f| aligned(f))) {
        return Err(EstimateError::Other(
            "the forces across and those of the fingers need one finite value for every carried sample".to_owned(),
        ));
    }
    let n = carried.time_s.len();
    if n < LEAST_SAMPLES {
        return Err(EstimateError::TooFewSamples {
            recording: "the carry".to_owned(),
            samples: n,
            what: " to see its weight change".to_owned(),
            needed: LEAST_SAMPLES,
        });
    }
    let (first, last) = (carried.time_s[0], carried.time_s[n - 1]);
    let (middle, lasted_s) = (0.5 * (first + last), last - first);
    let reading = slope(&[carried])?.ok_or_else(|| EstimateError::Other("the carry has no length".to_owned()))?;
    let margin = AROUND * lasted_s;
    let before = free.time_s.iter().any(|t| *t < middle - margin);
    let after = free.time_s.iter().any(|t| *t > middle + margin);
    let around = |series: &Series<'_>| {
        series.time_s.iter().any(|t| *t < middle - margin) && series.time_s.iter().any(|t| *t > middle + margin)
    };
    let mut references: Vec<Series<'_>> = others.iter().copied().filter(around).collect();
    if before && after {
        references.push(free);
    }
    let drift = if references.is_empty() { None } else { slope(&references)? };
    let along = |force_n| slope(&[Series { time_s: carried.time_s, force_n }]);
    let across = across_n.map(along).transpose()?.flatten();
    let share = match fingers_n.filter(|_| reading.is_significant(super::verdict::SIGNIFICANT)) {
        Some([left, _]) => along(left)?.map(|left| share_of(left, reading)),
        None => None,
    };
    Ok(Rates { reading, drift, across, share, before, after, lasted_s })
}

fn share_of(left: Measured, reading: Measured) -> Measured {
    let value = left.value / reading.value;
    let relative = (left.std_error / reading.value).hypot(value * reading.std_error / reading.value);
    Measured { value, std_error: relative }
}

/// One rate that is common to all series, each with a level of its own; errors count the autocorrelation.
fn slope(series: &[Series<'_>]) -> Result<Option<Measured>, EstimateError> {
    let n: usize = series.iter().map(|s| s.time_s.len()).sum();
    if n < LEAST_SAMPLES.min(series.len() + 3) {
        return Ok(None);
    }
    let mean = series.iter().flat_map(|s| s.time_s).sum::<f64>() / n as f64;
    let mut columns = vec![series.iter().flat_map(|s| s.time_s).map(|t| t - mean).collect::<Vec<f64>>()];
    for k in 0..series.len() {
        let level = |(j, s): (usize, &Series<'_>)| vec![f64::from(u8::from(j == k)); s.time_s.len()];
        columns.push(series.iter().enumerate().flat_map(level).collect());
    }
    let rhs: Vec<f64> = series.iter().flat_map(|s| s.force_n).copied().collect();
    let fit = least_squares(&columns, &rhs, None)?;
    Ok(fit.identified[0].then(|| Measured { value: fit.values[0], std_error: fit.std_errors[0] }))
}

fn check(series: &Series<'_>) -> Result<(), EstimateError> {
    let Series { time_s, force_n } = series;
    if time_s.len() != force_n.len() {
        return Err(EstimateError::Other(format!(
            "a reading has {} times and {} forces; give one force for every time",
            time_s.len(),
            force_n.len()
        )));
    }
    if !(time_s.iter().all(|t| t.is_finite()) && force_n.iter().all(|f| f.is_finite())) {
        return Err(EstimateError::Other(
            "a reading holds a number that is not finite; leave that sample out".to_owned(),
        ));
    }
    if time_s.windows(2).any(|w| w[1] < w[0]) {
        return Err(EstimateError::Other("the times of a reading run backwards; give them in order".to_owned()));
    }
    Ok(())
}
