//! Median with a distribution-free confidence interval.

use schemars::JsonSchema;
use serde::Serialize;

/// A median, and where it lies with 95 % at the least.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub(super) struct Median {
    /// The median.
    pub middle: f64,
    /// Both ends of the interval; absent with fewer than six values, which give none.
    pub interval: Option<[f64; 2]>,
}

impl Median {
    /// Median of some values; `None` without any.
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let count = values.len();
        let middle = 0.5 * (values.get(count.checked_sub(1)? / 2)? + values.get(count / 2)?);
        let interval = outside(count).map(|skipped| [values[skipped], values[count - 1 - skipped]]);
        Some(Self { middle, interval })
    }

    /// Text for a table, with this number of decimals.
    pub fn text(&self, decimals: usize) -> String {
        match self.interval {
            Some([low, high]) => format!("{:.decimals$} ({low:.decimals$} to {high:.decimals$})", self.middle),
            None => format!("{:.decimals$}", self.middle),
        }
    }
}

/// Number of sorted values to drop at each end. The median is outside of the k-th of `count` values with the
/// probability that a fair coin shows so few heads.
fn outside(count: usize) -> Option<usize> {
    let mut term = 0.5_f64.powi(i32::try_from(count).ok()?);
    let (mut tail, mut skipped) = (0.0, None);
    for k in 0..count / 2 {
        tail += term;
        if tail > 0.025 {
            break;
        }
        skipped = Some(k);
        term *= (count - k) as f64 / (k + 1) as f64;
    }
    skipped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians_and_their_intervals_are_those_of_the_tables() {
        let ten = Median::of((1..=10).rev().map(f64::from).collect()).expect("values");
        // Ten values: the second and the ninth (97.9 %); twenty: the sixth and the fifteenth (95.9 %).
        assert_eq!(ten, Median { middle: 5.5, interval: Some([2.0, 9.0]) });
        let twenty = Median::of((1..=20).map(f64::from).collect()).expect("values");
        assert_eq!(twenty.interval, Some([6.0, 15.0]));
        assert_eq!(Median::of(vec![3.0, 1.0, 2.0]), Some(Median { middle: 2.0, interval: None }));
        assert_eq!(Median::of(Vec::new()), None);
        assert_eq!(ten.text(1), "5.5 (2.0 to 9.0)");
    }
}
