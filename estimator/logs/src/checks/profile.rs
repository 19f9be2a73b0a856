//! Properties of a channel that several checks need, computed once.

use foundation::signal::thinned::thinned;
use haptics::recording::Span;

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
        let (low, high, unchanged) = extremes(values);
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

/// Smallest and largest value, and how many are equal to the one before: in lanes, so that the compiler can use wide registers.
pub(crate) fn extremes(values: &[f64]) -> (f64, f64, usize) {
    const LANES: usize = 8;
    let less = |a: f64, b: f64| if a < b { a } else { b };
    let more = |a: f64, b: f64| if a > b { a } else { b };
    let (mut lows, mut highs, mut same) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES], [0_u64; LANES]);
    let later = values.get(1..).unwrap_or_default();
    let (blocks, _) = later.as_chunks::<LANES>();
    for (now, next) in values.as_chunks::<LANES>().0.iter().zip(blocks) {
        for k in 0..LANES {
            lows[k] = less(now[k], lows[k]);
            highs[k] = more(now[k], highs[k]);
            same[k] += u64::from(now[k] == next[k]);
        }
    }
    let done = blocks.len() * LANES;
    let rest = &values[done..];
    let low = lows.iter().chain(rest).fold(f64::INFINITY, |low, &v| less(v, low));
    let high = highs.iter().chain(rest).fold(f64::NEG_INFINITY, |high, &v| more(v, high));
    let unchanged = same.iter().sum::<u64>() as usize + rest.windows(2).filter(|w| w[0] == w[1]).count();
    (low, high, unchanged)
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
    use foundation::signal::thinned::MOST;

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
    fn extremes_are_those_of_the_plain_way() {
        for n in 0..60 {
            let values: Vec<f64> = (0..n).map(|i| f64::from((i * i * 7) % 11 / 2) - 2.0).collect();
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let unchanged = values.windows(2).filter(|w| w[0] == w[1]).count();
            assert_eq!(extremes(&values), (low, high, unchanged), "{n}");
        }
    }

    #[test]
    fn quantiles_of_many_samples_are_near_the_true_ones() {
        let values: Vec<f64> = (0..1_000_000).map(|i| f64::from(i) * 1e-6).collect();
        let profile = Profile::of(&values);
        assert!((profile.quantile(0.5) - 0.5).abs() < 1e-3 && (profile.spread() - 0.9).abs() < 2e-3);
        assert!(profile.sorted.len() <= MOST && Profile::of(&[]).quantile(0.5) == 0.0);
    }
}
