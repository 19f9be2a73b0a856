//! Counts the timings of ticks: one second a part, the last ten parts are "recent", older parts are kept as a sum.

use super::figures::{Figures, STALL_S, TickTiming, Timing};
use crate::servo::histogram::Histogram;
use crate::servo::rate::RateReport;

/// Length of a part, s.
const PART_S: f64 = 1.0;
/// Parts that are recent; the newest is being filled.
const PARTS: usize = 10;

/// Counts within a period of time.
#[derive(Clone, Debug, Default)]
struct Part {
    period: Histogram,
    lateness: Histogram,
    compute: Histogram,
    force_age: Histogram,
    missed: u64,
    stalls: u64,
    longest_stall_s: f64,
}

impl Part {
    fn add(&mut self, tick: &TickTiming, force_age_s: Option<f64>) {
        self.lateness.add(tick.lateness_s);
        self.compute.add(tick.compute_s);
        if let Some(interval_s) = tick.interval_s {
            self.period.add(interval_s);
        }
        if let Some(age_s) = force_age_s {
            self.force_age.add(age_s);
        }
        self.missed += u64::from(tick.missed);
        let longest = tick.lateness_s.max(tick.compute_s);
        if longest > STALL_S {
            self.stalls += 1;
            self.longest_stall_s = self.longest_stall_s.max(longest);
        }
    }

    fn merge(&mut self, other: &Self) {
        self.period.merge(&other.period);
        self.lateness.merge(&other.lateness);
        self.compute.merge(&other.compute);
        self.force_age.merge(&other.force_age);
        self.missed += other.missed;
        self.stalls += other.stalls;
        self.longest_stall_s = self.longest_stall_s.max(other.longest_stall_s);
    }

    fn figures(&self, seconds: f64) -> Figures {
        Figures {
            seconds,
            ticks: self.lateness.len(),
            period: self.period.summary(),
            lateness: self.lateness.summary(),
            compute: self.compute.summary(),
            force_age: self.force_age.summary(),
            missed: self.missed,
            stalls: self.stalls,
            longest_stall_s: self.longest_stall_s,
        }
    }
}

/// Collects the timing; summaries are made a few times a second, not at every tick.
#[derive(Clone, Debug, Default)]
pub struct TimingCollector {
    /// Counts before the recent past.
    past: Part,
    recent: [Part; PARTS],
    /// The part that is being filled.
    newest: usize,
    /// Time since its start, s.
    filled_s: f64,
    /// Whole parts before it that are recent.
    full: usize,
    sample_age_s: f64,
    has_force: bool,
}

impl TimingCollector {
    /// Counts one tick.
    pub fn add(&mut self, tick: &TickTiming) {
        // The force of the tick before goes out in this one.
        let force_age_s = tick.interval_s.filter(|_| self.has_force).map(|interval_s| interval_s + self.sample_age_s);
        self.pass(tick.interval_s.unwrap_or(0.0));
        self.recent[self.newest].add(tick, force_age_s);
        self.has_force = tick.has_force;
        self.sample_age_s = tick.sample_age_s;
    }

    /// Lets time pass: parts that are old become past.
    fn pass(&mut self, interval_s: f64) {
        self.filled_s += interval_s;
        // After a standstill longer than everything recent, nothing before it is.
        for _ in 0..PARTS {
            if self.filled_s < PART_S {
                return;
            }
            self.filled_s -= PART_S;
            self.full = (self.full + 1).min(PARTS - 1);
            self.newest = (self.newest + 1) % PARTS;
            self.past.merge(&self.recent[self.newest]);
            self.recent[self.newest] = Part::default();
        }
        self.filled_s %= PART_S;
    }

    /// The figures so far.
    pub fn summary(&self, rate: RateReport) -> Timing {
        let mut sum = Part::default();
        for part in &self.recent {
            sum.merge(part);
        }
        let recent = sum.figures(self.full as f64 * PART_S + self.filled_s);
        sum.merge(&self.past);
        let all = sum.figures(0.0);
        Timing {
            ticks: all.ticks,
            period: all.period,
            lateness: all.lateness,
            compute: all.compute,
            force_age: all.force_age,
            missed: all.missed,
            stalls: all.stalls,
            longest_stall_s: all.longest_stall_s,
            sample_age_s: self.sample_age_s,
            recent,
            ..Timing::starting(rate)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::RECENT_S;
    use super::*;

    /// A punctual tick with a force from a fresh sample.
    fn usual() -> TickTiming {
        let (lateness_s, compute_s) = (5e-6, 4e-6);
        TickTiming { lateness_s, compute_s, interval_s: Some(1e-3), has_force: true, ..TickTiming::default() }
    }

    #[test]
    fn waiting_for_a_device_makes_no_force_old() {
        let mut collector = TimingCollector::default();
        let rate = RateReport { rate_hz: 1000.0, ..RateReport::default() };
        // Two seconds without a device, then one comes, goes for a second, and is back.
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

    #[test]
    fn a_stall_is_recent_for_ten_seconds_and_counted_since_the_start_for_ever() {
        let mut collector = TimingCollector::default();
        let rate = RateReport { rate_hz: 1000.0, ..RateReport::default() };
        collector.add(&TickTiming { interval_s: None, ..usual() });
        // A stall of 80 ms while the window opens.
        let stall = TickTiming { lateness_s: 0.08, interval_s: Some(0.081), missed: true, ..usual() };
        collector.add(&stall);
        let mut seconds = |seconds: u32| {
            (0..1_000 * seconds).for_each(|_| collector.add(&usual()));
            collector.summary(rate)
        };
        let early = seconds(8);
        assert_eq!((early.recent.stalls, early.recent.missed, early.recent.lateness.max_s), (1, 1, 0.08));
        assert_eq!((early.recent.ticks, early.recent.period), (early.ticks, early.period), "all of it is recent");
        assert!((early.recent.seconds - 8.081).abs() < 1e-6, "{}", early.recent.seconds);
        let later = seconds(3_600);
        assert_eq!((later.recent.stalls, later.recent.missed, later.recent.longest_stall_s), (0, 0, 0.0));
        assert!(later.recent.lateness.max_s < 1e-4 && later.recent.force_age.max_s < 2e-3, "{:?}", later.recent);
        assert!((9_000..=10_000).contains(&later.recent.ticks), "{} ticks", later.recent.ticks);
        assert!(later.recent.seconds > 9.0 && later.recent.seconds <= RECENT_S);
        assert_eq!((later.stalls, later.missed, later.lateness.max_s), (1, 1, 0.08), "and nothing is lost");
        assert_eq!((later.ticks, later.longest_stall_s), (3_608_002, 0.08));
        assert!(later.force_age.max_s > 0.08);
    }

    #[test]
    fn after_a_long_standstill_only_what_follows_is_recent() {
        let mut collector = TimingCollector::default();
        let rate = RateReport { rate_hz: 1000.0, ..RateReport::default() };
        (0..5_000).for_each(|_| collector.add(&TickTiming { lateness_s: 1e-4, ..usual() }));
        collector.add(&TickTiming { lateness_s: 30.0, interval_s: Some(30.0), ..usual() });
        let timing = collector.summary(rate);
        assert_eq!((timing.ticks, timing.recent.ticks, timing.recent.stalls), (5_001, 1, 1));
        assert!(timing.recent.seconds <= RECENT_S);
    }
}
