//! What several checks need to know about a channel, taken once.

use haptics::recording::Span;

/// At most so many samples are sorted: quantiles of a million samples are not needed to the last digit.
const SORTED: usize = 8192;

/// Extremes, quantiles, and how often the channel does not change.
#[derive(Clone, Debug, Default)]
pub struct Profile {
    /// Smallest value.
    pub low: f64,
    /// Largest value.
    pub high: f64,
    /// Samples equal to the one before.
    pub unchanged: usize,
    /// Some or all of the values, in order.
    pub sorted: Vec<f64>,
}

impl Profile {
    /// Looks at every sample once.
    pub fn of(values: &[f64]) -> Self {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &v in values {
            low = if v < low { v } else { low };
            high = if v > high { v } else { high };
        }
        let unchanged = values.windows(2).map(|w| usize::from(w[0] == w[1])).sum();
        let mut sorted: Vec<f64> = thinned(values.len()).map(|i| values[i]).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        Self { low, high, unchanged, sorted }
    }

    /// The value that this share of the samples does not exceed; 0 without samples.
    pub fn quantile(&self, share: f64) -> f64 {
        let last = self.sorted.len().saturating_sub(1);
        self.sorted.get((share * last as f64).round() as usize).copied().unwrap_or(0.0)
    }

    /// Width of the middle nine tenths.
    pub fn spread(&self) -> f64 {
        self.quantile(0.95) - self.quantile(0.05)
    }

    /// Largest distance from zero.
    pub fn reach(&self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// True when every sample has the same value.
    pub fn is_constant(&self) -> bool {
        self.low >= self.high
    }
}

/// Indices of samples that stand for all `n`, increasing: one out of each equal piece, not always at the same place in it,
/// so that a periodic signal is not always met in the same phase.
pub fn thinned(n: usize) -> impl Iterator<Item = usize> {
    let count = n.min(SORTED);
    (0..count).map(move |k| {
        let (first, end) = (k * n / count, (k + 1) * n / count);
        first + (k * 7919) % (end - first).max(1)
    })
}

/// Maximal runs of at least `length` equal values (`length` of 2 or more).
pub fn holds(values: &[f64], length: usize) -> Vec<Span> {
    let mut found: Vec<Span> = Vec::new();
    let stride = (length / 2).max(1);
    let mut probe = 0;
    // A run of `length` holds two probes: only where these agree is it worth looking closer.
    while probe + stride < values.len() {
        let value = values[probe];
        if values[probe + stride] != value {
            probe += stride;
            continue;
        }
        let first = values[..probe].iter().rposition(|&v| v != value).map_or(0, |i| i + 1);
        let end = values[probe..].iter().position(|&v| v != value).map_or(values.len(), |i| probe + i);
        if end - first >= length {
            found.push(Span { first, end });
        }
        probe = if end > probe + stride { end.saturating_sub(1) / stride * stride } else { probe + stride };
        probe = probe.max(end);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plain way.
    fn every_hold(values: &[f64], length: usize) -> Vec<Span> {
        let mut found = Vec::new();
        let mut first = 0;
        for i in 1..=values.len() {
            if i == values.len() || values[i] != values[first] {
                if i - first >= length {
                    found.push(Span { first, end: i });
                }
                first = i;
            }
        }
        found
    }

    #[test]
    fn holds_are_those_of_the_plain_way() {
        for seed in 0..300_u64 {
            let mut state = seed;
            let values: Vec<f64> = (0..200)
                .scan(0.0, |value, _| {
                    state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                    if (state >> 33) % 8 == 0 {
                        *value = ((state >> 40) % 3) as f64;
                    }
                    Some(*value)
                })
                .collect();
            for length in [2, 3, 8, 25] {
                assert_eq!(holds(&values, length), every_hold(&values, length), "seed {seed}, length {length}");
            }
        }
    }

    #[test]
    fn quantiles_of_many_samples_are_near_the_true_ones() {
        let values: Vec<f64> = (0..1_000_000).map(|i| f64::from(i) * 1e-6).collect();
        let profile = Profile::of(&values);
        assert!((profile.quantile(0.5) - 0.5).abs() < 1e-3 && (profile.spread() - 0.9).abs() < 2e-3);
        assert!(profile.sorted.len() <= SORTED && Profile::of(&[]).quantile(0.5) == 0.0);
    }
}
