//! Timing statistics without allocation: logarithmic histograms and their percentiles.

use super::rate::RateReport;

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

    /// Number of durations.
    pub fn len(&self) -> u64 {
        self.total
    }

    /// True when nothing was counted.
    pub fn is_empty(&self) -> bool {
        self.total == 0
    }
}

/// The usual four numbers of a distribution of durations, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
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

/// A tick that starts so late, or works so long, is a stall of its own and named, s.
pub const STALL_S: f64 = 1e-3;

/// What the servo knows about its own timing.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Timing {
    /// Ticks since the start, or since the rate changed.
    pub ticks: u64,
    /// Wanted period, s.
    pub period_s: f64,
    /// The rate and why it is that.
    pub rate: RateReport,
    /// Time from the start of one tick to the start of the next.
    pub period: Percentiles,
    /// How late the ticks start after their deadline.
    pub lateness: Percentiles,
    /// How long reading, stepping and writing take.
    pub compute: Percentiles,
    /// How old the sample is that a force was computed from, at the moment when the device gets the force. While the force is
    /// zero because no fresh sample came there is none.
    pub force_age: Percentiles,
    /// Deadlines missed by more than a period: the schedule was re-anchored, no tick was made up for.
    pub missed: u64,
    /// Single ticks that came or took longer than [`STALL_S`].
    pub stalls: u64,
    /// The longest of them, s.
    pub longest_stall_s: f64,
    /// Age of the newest device sample, s.
    pub sample_age_s: f64,
}

impl Timing {
    /// Before the first tick at a rate.
    pub fn starting(rate: RateReport) -> Self {
        Self { period_s: 1.0 / rate.rate_hz, rate, ..Self::default() }
    }

    /// One sentence about the stalls; `None` without any.
    pub fn stall_sentence(&self) -> Option<String> {
        if self.stalls == 0 {
            return None;
        }
        let longest_ms = 1e3 * self.longest_stall_s;
        // One in a thousand is a habit.
        let often = self.stalls * 1000 > self.ticks;
        let which = if often {
            format!("{} stalls of up to {longest_ms:.1} ms", self.stalls)
        } else if self.stalls == 1 {
            format!("A single stall of {longest_ms:.1} ms")
        } else {
            format!("{} single stalls of up to {longest_ms:.1} ms", self.stalls)
        };
        let why = if self.compute.p50_s > 0.5 * self.period_s {
            "this world needs more than half of every period"
        } else if often {
            "the machine is busy with other work"
        } else {
            "the machine took the processor away"
        };
        Some(format!("{which}: {why}."))
    }
}

/// What one tick took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TickTiming {
    /// Start after the deadline, s.
    pub lateness_s: f64,
    /// Time since the start of the tick before, s; absent for the first.
    pub interval_s: Option<f64>,
    /// Reading, stepping, writing, s.
    pub compute_s: f64,
    /// Whether the deadline was missed by more than a period.
    pub missed: bool,
    /// Age of the newest sample when the force was computed, s; before the first the time since the start.
    pub sample_age_s: f64,
    /// Whether a force was computed from that sample. Not before the first sample, and not while the force is zero because the
    /// samples are stale: who waits for a device has no old force.
    pub has_force: bool,
}

/// Collects the timing; summaries are made a few times a second, not at every tick.
#[derive(Clone, Debug, Default)]
pub struct TimingCollector {
    period: Histogram,
    lateness: Histogram,
    compute: Histogram,
    force_age: Histogram,
    missed: u64,
    stalls: u64,
    longest_stall_s: f64,
    sample_age_s: f64,
    has_force: bool,
}

impl TimingCollector {
    /// Counts one tick.
    pub fn add(&mut self, tick: &TickTiming) {
        self.lateness.add(tick.lateness_s);
        self.compute.add(tick.compute_s);
        if let Some(interval_s) = tick.interval_s {
            self.period.add(interval_s);
            if self.has_force {
                // The force of the tick before goes out in this one.
                self.force_age.add(interval_s + self.sample_age_s);
            }
        }
        self.has_force = tick.has_force;
        self.sample_age_s = tick.sample_age_s;
        self.missed += u64::from(tick.missed);
        let longest = tick.lateness_s.max(tick.compute_s);
        if longest > STALL_S {
            self.stalls += 1;
            self.longest_stall_s = self.longest_stall_s.max(longest);
        }
    }

    /// The figures so far.
    pub fn summary(&self, rate: RateReport) -> Timing {
        Timing {
            ticks: self.lateness.len(),
            period: self.period.summary(),
            lateness: self.lateness.summary(),
            compute: self.compute.summary(),
            force_age: self.force_age.summary(),
            missed: self.missed,
            stalls: self.stalls,
            longest_stall_s: self.longest_stall_s,
            sample_age_s: self.sample_age_s,
            ..Timing::starting(rate)
        }
    }
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

    /// A punctual tick with a force from a fresh sample.
    fn usual() -> TickTiming {
        let (lateness_s, compute_s) = (5e-6, 4e-6);
        TickTiming { lateness_s, compute_s, interval_s: Some(1e-3), has_force: true, ..TickTiming::default() }
    }

    #[test]
    fn waiting_for_a_device_makes_no_force_old() {
        let mut collector = TimingCollector::default();
        let rate = RateReport { rate_hz: 1000.0, ..RateReport::default() };
        // Two seconds nobody is there, then a device comes, goes for a second, and is back.
        for (ticks, has_force) in [(2_000_i32, false), (1_000, true), (1_000, false), (1_000, true)] {
            for tick in 0..ticks {
                let sample_age_s = if has_force { 0.0 } else { f64::from(tick) * 1e-3 };
                collector.add(&TickTiming { sample_age_s, has_force, ..usual() });
            }
        }
        let timing = collector.summary(rate);
        assert!((timing.force_age.max_s - 1e-3).abs() < 1e-9, "{:?}", timing.force_age);
        assert_eq!(timing.ticks, 5_000);
        // A sample that is 15 ms old, and still counts, makes an old force.
        collector.add(&TickTiming { sample_age_s: 0.015, ..usual() });
        collector.add(&usual());
        assert!((collector.summary(rate).force_age.max_s - 0.016).abs() < 1e-9);
    }

    #[test]
    fn stalls_are_named_and_the_age_of_a_force_counts_from_its_sample() {
        let mut collector = TimingCollector::default();
        let usual = usual();
        collector.add(&TickTiming { interval_s: None, ..usual });
        for _ in 0..2_000 {
            collector.add(&usual);
        }
        let rate = RateReport { rate_hz: 1000.0, ..RateReport::default() };
        let calm = collector.summary(rate);
        assert_eq!((calm.ticks, calm.stalls, calm.stall_sentence()), (2_001, 0, None));
        assert!((calm.force_age.p50_s - 1e-3).abs() < 1e-9 && (calm.period.max_s - 1e-3).abs() < 1e-12);

        let late = TickTiming { lateness_s: 0.012, missed: true, interval_s: Some(0.013), ..usual };
        collector.add(&late);
        let stalled = collector.summary(rate);
        assert_eq!(
            stalled.stall_sentence().as_deref(),
            Some("A single stall of 12.0 ms: the machine took the processor away.")
        );
        assert_eq!(stalled.missed, 1);
        collector.add(&TickTiming { sample_age_s: 0.004, ..usual });
        collector.add(&usual);
        assert!(collector.summary(rate).force_age.max_s > 0.0129);
        collector.add(&late);
        collector.add(&late);
        let busy = collector.summary(rate).stall_sentence().expect("three stalls");
        assert_eq!(busy, "3 stalls of up to 12.0 ms: the machine is busy with other work.");
    }
}
