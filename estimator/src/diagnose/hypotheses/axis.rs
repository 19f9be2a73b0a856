//! One axis of a search grid: coarse values of a searched parameter, and closer ones around a value that was found.

/// Closer values, in spacings of the coarse grid. Derived: they divide each spacing into thirds.
/// Choice: halved, 17 of 20 answers change (1 to right); doubled, 17 of 20 answers change.
const THIRDS: [f64; 5] = [-2.0 / 3.0, -1.0 / 3.0, 0.0, 1.0 / 3.0, 2.0 / 3.0];

/// Coarse values from `low` to `high`, usually shares of a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axis {
    low: f64,
    high: f64,
    count: usize,
    /// Neighbouring values have equal ratios, else equal differences.
    is_geometric: bool,
}

impl Axis {
    /// Values with equal differences.
    pub(crate) const fn even(low: f64, high: f64, count: usize) -> Self {
        Self { low, high, count, is_geometric: false }
    }

    /// Centres of `count` equal cells of a range.
    pub(crate) const fn cells(count: usize) -> Self {
        let half = 0.5 / count as f64;
        Self::even(half, 1.0 - half, count)
    }

    /// Values with equal ratios: for speeds, lengths and times whose order of magnitude is open.
    pub(crate) const fn geometric(low: f64, high: f64, count: usize) -> Self {
        Self { low, high, count, is_geometric: true }
    }

    /// The same range with half the spacing.
    pub(crate) fn halved(self) -> Self {
        Self { count: 2 * self.count - 1, ..self }
    }

    /// The lowest value.
    pub(crate) const fn low(self) -> f64 {
        self.low
    }

    /// The highest value.
    pub(crate) const fn high(self) -> f64 {
        self.high
    }

    /// The coarse values.
    pub(crate) fn values(self) -> impl Iterator<Item = f64> + Clone {
        let spacing = self.spacing();
        (0..self.count).map(move |k| {
            if self.is_geometric { self.low * spacing.powf(k as f64) } else { self.low + spacing * k as f64 }
        })
    }

    /// Closer values around `value`. `scale` is the length of the range whose shares the axis counts; `step` is 1 in
    /// the first round and smaller in later ones.
    pub(crate) fn around(self, value: f64, scale: f64, step: f64) -> [f64; 5] {
        let spacing = self.spacing();
        THIRDS.map(|third| {
            if self.is_geometric { value * spacing.powf(third * step) } else { value + third * step * spacing * scale }
        })
    }

    /// Difference or ratio of two neighbouring coarse values.
    pub(crate) fn spacing(self) -> f64 {
        let intervals = self.count.saturating_sub(1).max(1) as f64;
        if self.is_geometric {
            (self.high / self.low).powf(1.0 / intervals)
        } else {
            (self.high - self.low) / intervals
        }
    }
}

/// A varied axis has as many times the values over the same range, but at least two.
#[cfg(feature = "ablation")]
impl foundation::ablation::Scale for Axis {
    fn scaled(self, factor: f64) -> Self {
        Self { count: foundation::ablation::Scale::scaled(self.count, factor).max(2), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: impl Iterator<Item = f64>, expected: &[f64]) {
        let found: Vec<f64> = found.collect();
        assert_eq!(found.len(), expected.len(), "{found:?}");
        assert!(found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-12), "{found:?}");
    }

    #[test]
    fn values_are_evenly_spaced_or_in_equal_ratios() {
        near(Axis::even(-0.25, 1.25, 3).values(), &[-0.25, 0.5, 1.25]);
        near(Axis::cells(2).values(), &[0.25, 0.75]);
        near(Axis::geometric(0.1, 10.0, 3).values(), &[0.1, 1.0, 10.0]);
        near(Axis::even(0.0, 1.0, 2).halved().values(), &[0.0, 0.5, 1.0]);
    }

    #[test]
    fn closer_values_divide_the_spacing_into_thirds_and_later_rounds_are_closer() {
        near(Axis::even(0.0, 3.0, 2).around(10.0, 2.0, 1.0).into_iter(), &[6.0, 8.0, 10.0, 12.0, 14.0]);
        near(Axis::even(0.0, 3.0, 2).around(10.0, 2.0, 0.5).into_iter(), &[8.0, 9.0, 10.0, 11.0, 12.0]);
        near(Axis::geometric(1.0, 8.0, 2).around(1.0, 9.0, 1.0).into_iter(), &[0.25, 0.5, 1.0, 2.0, 4.0]);
    }
}
