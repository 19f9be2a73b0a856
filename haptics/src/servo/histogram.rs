//! A logarithmic histogram of durations, and its percentiles.

/// Buckets per factor of ten.
const PER_DECADE: usize = 40;
/// 10 ns … 1 s.
const DECADES: usize = 8;
const BUCKETS: usize = PER_DECADE * DECADES;
const LOWEST_S: f64 = 1e-8;

/// A histogram of durations with 6 % resolution; durations below 10 ns count as 10 ns, above 1 s as 1 s (the maximum is exact).
#[derive(Clone, Debug)]
pub struct Histogram {
    counts: [u32; BUCKETS],
    total: u64,
    max_s: f64,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: [0; BUCKETS], total: 0, max_s: 0.0 }
    }
}

impl Histogram {
    /// Counts one duration, s.
    pub fn add(&mut self, duration_s: f64) {
        let position = (duration_s.max(LOWEST_S) / LOWEST_S).log10() * PER_DECADE as f64;
        let bucket = (position as usize).min(BUCKETS - 1);
        self.counts[bucket] = self.counts[bucket].saturating_add(1);
        self.total += 1;
        self.max_s = self.max_s.max(duration_s);
    }

    /// The duration that a share of the samples stays below, s; zero when empty. The upper edge of its bucket, never above
    /// the maximum.
    pub fn percentile_s(&self, share: f64) -> f64 {
        if self.total == 0 {
            return 0.0;
        }
        let wanted = (share * self.total as f64).ceil().max(1.0) as u64;
        let mut seen = 0_u64;
        for (bucket, count) in self.counts.iter().enumerate() {
            seen += u64::from(*count);
            if seen >= wanted {
                let edge = LOWEST_S * 10_f64.powf((bucket + 1) as f64 / PER_DECADE as f64);
                return edge.min(self.max_s);
            }
        }
        self.max_s
    }

    /// p50, p99, p99.9 and the maximum, s.
    pub fn summary(&self) -> Percentiles {
        Percentiles {
            p50_s: self.percentile_s(0.5),
            p99_s: self.percentile_s(0.99),
            p999_s: self.percentile_s(0.999),
            max_s: self.max_s,
        }
    }

    /// Adds everything that another one has counted.
    pub fn merge(&mut self, other: &Self) {
        for (count, more) in self.counts.iter_mut().zip(&other.counts) {
            *count = count.saturating_add(*more);
        }
        self.total += other.total;
        self.max_s = self.max_s.max(other.max_s);
    }

    /// Number of durations.
    pub fn len(&self) -> u64 {
        self.total
    }
}

/// The usual four numbers of a distribution of durations, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, schemars::JsonSchema, serde::Serialize)]
pub struct Percentiles {
    /// Median.
    pub p50_s: f64,
    /// 99th percentile.
    pub p99_s: f64,
    /// 99.9th percentile.
    pub p999_s: f64,
    /// Largest.
    pub max_s: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_of_a_known_distribution() {
        let mut histogram = Histogram::default();
        for i in 1..=1000 {
            histogram.add(f64::from(i) * 1e-6);
        }
        for (share, expected) in [(0.5, 500e-6), (0.99, 990e-6), (0.999, 999e-6)] {
            let found = histogram.percentile_s(share);
            assert!((found / expected - 1.0).abs() < 0.06, "{share}: {found}");
        }
        assert_eq!(histogram.summary().max_s, 1e-3);
    }

    #[test]
    fn extremes_do_not_fall_out() {
        let mut histogram = Histogram::default();
        for duration in [0.0, -1.0, 1e-12, 5.0] {
            histogram.add(duration);
        }
        assert_eq!(histogram.len(), 4);
        assert_eq!(histogram.summary().max_s, 5.0);
    }

    #[test]
    fn two_histograms_together_are_one_of_all() {
        let (mut all, mut one, mut other) = (Histogram::default(), Histogram::default(), Histogram::default());
        for i in 1..=1000 {
            let duration_s = f64::from(i) * 1e-6;
            all.add(duration_s);
            if i % 3 == 0 { one.add(duration_s) } else { other.add(duration_s) }
        }
        one.merge(&other);
        assert_eq!((one.summary(), one.len()), (all.summary(), all.len()));
    }
}
